// SPDX-License-Identifier: Apache-2.0
// Numbers as people read them: counts with their nouns, durations, bytes.
#pragma once

#include <cstdint>
#include <string>

namespace obscura {

// The noun for so many of them: "ray", "rays".
std::string plural(uint64_t count, const std::string& noun);
// "1 ray", "2 rays".
std::string counted(uint64_t count, const std::string& noun);
// 1234567 -> "1.23 M": a count for people, four significant characters and an SI prefix.
std::string si_count(double value);
// 75.3 -> "1:15", 4.217 -> "4.22 s".
std::string duration_text(double seconds);
// 1536 -> "1.5 KiB".
std::string bytes_text(uint64_t bytes);

}  // namespace obscura
