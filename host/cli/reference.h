// SPDX-License-Identifier: Apache-2.0
// obscura reference SCENE -o R.exr: the picture that renders are judged by.
#pragma once

#include <CLI/App.hpp>

#include "base/error.h"

namespace obscura {

// Registers the subcommand; its callback sets exit_code, which must outlive app.
void add_reference_command(CLI::App& app, ExitCode& exit_code);

}  // namespace obscura
