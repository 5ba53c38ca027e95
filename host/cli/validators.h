// SPDX-License-Identifier: Apache-2.0
// Checks of option values that CLI11 lacks.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdint>
#include <limits>
#include <string>
#include <system_error>

namespace obscura {

// CLI::Range compares with < and >, which lets NaN through.
inline CLI::Validator number_between(double low, double high) {
    const std::string range = fmt::format("{} to {}", low, high);
    return {[=](const std::string& text) -> std::string {
                double value = 0;
                const bool is_number = CLI::detail::lexical_cast(text, value);
                if (is_number && value >= low && value <= high) return {};
                return fmt::format("{} is not a number from {}", text, range);
            },
            fmt::format("FLOAT in [{} - {}]", low, high)};
}

inline CLI::Validator not_empty() {
    return {[](const std::string& text) {
                return text.empty() ? std::string("a name is needed") : std::string();
            },
            ""};
}

// CLI11 reads what is too large for 64 bits as the largest number, and CLI::Range tells of a range where the text is no
// whole number at all.
inline CLI::Validator whole_number(uint64_t low = 0, uint64_t high = std::numeric_limits<uint64_t>::max()) {
    const bool unlimited = high == std::numeric_limits<uint64_t>::max();
    const std::string last = unlimited ? "2^64 - 1" : fmt::format("{}", high);
    return {[=](const std::string& text) -> std::string {
                uint64_t value = 0;
                const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
                const bool whole = error == std::errc() && end == text.data() + text.size();
                if (whole && value >= low && value <= high) return {};
                return fmt::format("{} is not a whole number from {} to {}", text, low, last);
            },
            unlimited ? "" : fmt::format("UINT in [{} - {}]", low, last)};
}

// Stops of a preview: beyond these every picture is black or white.
inline CLI::Validator exposure_range() {
    return number_between(-64, 64);
}

}  // namespace obscura
