// SPDX-License-Identifier: Apache-2.0
// obscura compare A.exr B.exr: error metrics of A against the reference B, layer by layer, and a heat map.
// Exit code 0 if both have the same layers and each is within the bound, 1 if not.
#pragma once

#include <CLI/App.hpp>

#include "base/error.h"

namespace obscura {

// Registers the subcommand; its callback sets exit_code, which must outlive app.
void add_compare_command(CLI::App& app, ExitCode& exit_code);

}  // namespace obscura
