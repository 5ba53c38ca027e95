// SPDX-License-Identifier: Apache-2.0
// The only include of the OpenCL headers: version 1.2 of the interface, C++ bindings without exceptions,
// since every call goes through check() (error.h), which knows the stage.
#pragma once

#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/opencl.hpp>
