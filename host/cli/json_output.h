// SPDX-License-Identifier: Apache-2.0
// JSON of every subcommand, in the order in which it was put together.
#pragma once

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

#include "base/file.h"

namespace obscura {

using Json = nlohmann::ordered_json;

// target: a file, or "-" for standard output. Throws InputError.
inline void write_json(const std::string& target, const Json& json) {
    // Paths and the names of devices may hold any bytes: what is not UTF-8 becomes U+FFFD.
    const std::string text = json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
    if (target == "-") {
        fmt::print("{}", text);
    } else {
        write_text(target, text);
    }
}

}  // namespace obscura
