// SPDX-License-Identifier: Apache-2.0
// `obscura devices`: every OpenCL platform and device, usable or not and why.
#pragma once

#include <CLI/App.hpp>

#include "base/error.h"

namespace obscura {

// Adds the subcommand; it sets exit_code when it runs.
void add_devices_command(CLI::App& app, ExitCode& exit_code);

}  // namespace obscura
