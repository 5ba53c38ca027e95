// SPDX-License-Identifier: Apache-2.0
// Every OpenCL call goes through check(): a failure becomes a DeviceError that names the code, the call, the
// stage, the number of items and the device.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/error.h"

namespace obscura {

// -5 -> "CL_OUT_OF_RESOURCES"; codes unknown to OpenCL 1.2 -> "unknown OpenCL error -4711".
std::string error_name(int32_t code);

// Throws DeviceError unless code is CL_SUCCESS. stage: what was being done, "trace" or "opening the device".
void check(int32_t code, const char* call, std::string_view stage, std::string_view device = {},
           std::optional<uint64_t> item_count = {});

}  // namespace obscura
