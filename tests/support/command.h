// SPDX-License-Identifier: Apache-2.0
// A subcommand run in this process as main.cpp runs it, with its standard output kept.
#pragma once

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <vector>

#include "base/error.h"

namespace obscura::test {

struct CommandResult {
    ExitCode exit_code = ExitCode::ok;
    std::string out;
    std::string err;  // warnings and status lines
};

// arguments: the words after the program's name. Lets CLI::ParseError and InputError through.
inline CommandResult run_command(void (*add_command)(CLI::App&, ExitCode&),
                                 std::vector<std::string> arguments) {
    CLI::App app("test", "obscura");
    CommandResult result;
    add_command(app, result.exit_code);
    std::reverse(arguments.begin(), arguments.end());  // CLI11 takes a vector from the back
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    try {
        app.parse(std::move(arguments));
    } catch (...) {
        testing::internal::GetCapturedStdout();
        testing::internal::GetCapturedStderr();
        throw;
    }
    result.out = testing::internal::GetCapturedStdout();
    result.err = testing::internal::GetCapturedStderr();
    return result;
}

}  // namespace obscura::test
