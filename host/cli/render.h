// SPDX-License-Identifier: Apache-2.0
// obscura render SCENE -o X.exr: the main job.
#pragma once

#include <CLI/App.hpp>

#include "base/error.h"

namespace obscura {

// Registers the subcommand; its callback sets exit_code, which must outlive app.
void add_render_command(CLI::App& app, ExitCode& exit_code);

}  // namespace obscura
