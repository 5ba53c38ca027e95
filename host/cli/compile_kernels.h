// SPDX-License-Identifier: Apache-2.0
// `obscura compile-kernels`, which obscura starts itself (device/compile_processes.h): compiles kernels into the cache.
#pragma once

#include <CLI/App.hpp>

namespace obscura {

// Adds the subcommand, which help doesn't list.
void add_compile_kernels_command(CLI::App& app);

}  // namespace obscura
