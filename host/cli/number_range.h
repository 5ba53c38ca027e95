// SPDX-License-Identifier: Apache-2.0
// The range check of options with real values.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>

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

// Stops of a preview: beyond these every picture is black or white.
inline CLI::Validator exposure_range() {
    return number_between(-64, 64);
}

}  // namespace obscura
