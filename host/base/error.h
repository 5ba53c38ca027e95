// SPDX-License-Identifier: Apache-2.0
// The three ways to fail, and the exit codes they end in. Exceptions carry the whole message that the
// user sees; main.cpp is the only place that catches them.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace obscura {

// Exit codes of every subcommand.
enum class ExitCode : int {
    ok = 0,
    check_failed = 1,  // a comparison or check found a difference
    bad_input = 2,     // usage, scene or file errors
    device_failure = 3,
    interrupted = 4,  // stopped early, the work so far is saved
};

// A scene, file or usage error. The message names the file and the place in it.
class InputError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;

    template <typename... Args>
    explicit InputError(fmt::format_string<Args...> format, Args&&... args)
        : std::runtime_error(fmt::format(format, std::forward<Args>(args)...)) {}
};

// An OpenCL failure: code's name, call, stage, item count and device.
class DeviceError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;

    template <typename... Args>
    explicit DeviceError(fmt::format_string<Args...> format, Args&&... args)
        : std::runtime_error(fmt::format(format, std::forward<Args>(args)...)) {}
};

// Prints the broken invariant with its place and aborts. Never returns.
[[noreturn]] void fail_invariant(const char* expression, const char* file, int line,
                                 const std::string& detail);

}  // namespace obscura

// A broken invariant is a bug in obscura, not in its input: it aborts in every build type.
// The remaining arguments are a fmt format string and its values.
#define OBSCURA_CHECK(expression, ...)                                                              \
    do {                                                                                            \
        if (!(expression))                                                                          \
            ::obscura::fail_invariant(#expression, __FILE__, __LINE__, ::fmt::format(__VA_ARGS__)); \
    } while (false)
