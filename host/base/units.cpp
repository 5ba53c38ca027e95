// SPDX-License-Identifier: Apache-2.0
#include "base/units.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace obscura {
namespace {

// Three significant digits of a value below 1000.
std::string three_digits(double value) {
    const int decimals = value < 9.995 ? 2 : value < 99.95 ? 1 : 0;
    return fmt::format("{:.{}f}", value, decimals);
}

}  // namespace

std::string plural(uint64_t count, const std::string& noun) {
    return count == 1 ? noun : noun + "s";
}

std::string counted(uint64_t count, const std::string& noun) {
    return fmt::format("{} {}", count, plural(count, noun));
}

std::string si_count(double value) {
    constexpr std::array PREFIXES = {"", " k", " M", " G", " T", " P", " E"};
    size_t prefix = 0;
    for (; std::abs(value) >= 999.5 && prefix + 1 < PREFIXES.size(); ++prefix)
        value /= 1000;
    const bool exact = prefix == 0 && value == std::floor(value);
    return (exact ? fmt::format("{:.0f}", value) : three_digits(value)) + PREFIXES[prefix];
}

std::string duration_text(double seconds) {
    if (seconds < 0.9995) return three_digits(seconds * 1000) + " ms";
    if (seconds < 59.95) return three_digits(seconds) + " s";
    if (!std::isfinite(seconds)) return "unlimited time";
    const int64_t whole = std::llround(seconds);
    if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
    return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

std::string bytes_text(uint64_t bytes) {
    constexpr std::array PREFIXES = {"B", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB"};
    double value = static_cast<double>(bytes);
    size_t prefix = 0;
    for (; value >= 1023.95 && prefix + 1 < PREFIXES.size(); ++prefix)
        value /= 1024;
    return fmt::format("{:.4g} {}", value, PREFIXES[prefix]);
}

}  // namespace obscura
