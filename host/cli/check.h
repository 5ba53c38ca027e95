// SPDX-License-Identifier: Apache-2.0
// `obscura check SCENE`: every ray of a render against Embree and a brute-force oracle; and the same for built-in hard
// geometry, or for one ray.
#pragma once

#include <CLI/CLI.hpp>

#include "base/error.h"

namespace obscura {

// Adds the subcommand; it sets exit_code when it runs.
void add_check_command(CLI::App& app, ExitCode& exit_code);

}  // namespace obscura
