// SPDX-License-Identifier: Apache-2.0
// `obscura info SCENE`: what a scene holds, its averages (areas, R_ave, I_A), and what it needs modelled.
#pragma once

#include <CLI/CLI.hpp>

#include "base/error.h"

namespace obscura {

// Adds the subcommand; it sets exit_code when it runs.
void add_info_command(CLI::App& app, ExitCode& exit_code);

}  // namespace obscura
