// SPDX-License-Identifier: Apache-2.0
// `obscura bench SCENE`: how many rays per second the kernels trace, queue by queue, beside Embree on the same rays.
#pragma once

#include <CLI/CLI.hpp>

#include "base/error.h"

namespace obscura {

// Adds the subcommand; it sets exit_code when it runs.
void add_bench_command(CLI::App& app, ExitCode& exit_code);

}  // namespace obscura
