// SPDX-License-Identifier: Apache-2.0
// obscura merge A.exr B.exr ... -o X.exr: the parts of one picture, rendered with --cropwindow, into the
// whole. Every bit of a pixel is kept.
#pragma once

#include <CLI/App.hpp>

#include "base/error.h"

namespace obscura {

// Registers the subcommand; its callback sets exit_code, which must outlive app.
void add_merge_command(CLI::App& app, ExitCode& exit_code);

}  // namespace obscura
