// SPDX-License-Identifier: Apache-2.0
// `obscura sweep`: the error of each method against the time and the rays it takes.
#pragma once

#include <CLI/App.hpp>

#include "base/error.h"

namespace obscura {

void add_sweep_command(CLI::App& app, ExitCode& exit_code);

}  // namespace obscura
