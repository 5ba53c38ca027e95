// SPDX-License-Identifier: Apache-2.0
// Messages to the person at the terminal: warnings and status lines on standard error, so that standard
// output stays free for tables and JSON.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

namespace obscura {

// Only warnings and errors are printed from now on (--quiet).
void set_quiet(bool quiet);
bool is_quiet();

void log_info(const std::string& message);
void log_warning(const std::string& message);
void log_error(const std::string& message);

// While it lives no warning is printed: for work that is done again, and has been warned of.
class MutedWarnings {
  public:
    MutedWarnings();
    ~MutedWarnings();
    MutedWarnings(const MutedWarnings&) = delete;
    MutedWarnings& operator=(const MutedWarnings&) = delete;
};

template <typename... Args>
void log_info(fmt::format_string<Args...> format, Args&&... args) {
    log_info(fmt::format(format, std::forward<Args>(args)...));
}

template <typename... Args>
void log_warning(fmt::format_string<Args...> format, Args&&... args) {
    log_warning(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace obscura
