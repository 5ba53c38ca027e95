// SPDX-License-Identifier: Apache-2.0
// An option that takes one of a few words.
#pragma once

#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <vector>

namespace obscura {

template <typename Enum>
CLI::Option* add_choice(CLI::App& command, const std::string& name, Enum& value,
                        const std::map<std::string, Enum>& choices, const std::string& help) {
    std::vector<std::string> words;
    words.reserve(choices.size());
    for (const auto& choice : choices)
        words.push_back(choice.first);
    // CLI::CheckedTransformer would show, and take, the numbers behind the words too.
    const auto choose = [&value, name, choices, words](const std::string& text) {
        const auto found = choices.find(CLI::detail::to_lower(text));
        if (found == choices.end()) {
            throw CLI::ValidationError(name, fmt::format("{}: choose from {}", text, fmt::join(words, ", ")));
        }
        value = found->second;
    };
    return command.add_option_function<std::string>(name, choose, help)
        ->type_name(fmt::format("{}", fmt::join(words, "|")));
}

}  // namespace obscura
