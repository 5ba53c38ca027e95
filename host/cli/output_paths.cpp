// SPDX-License-Identifier: Apache-2.0
#include "cli/output_paths.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "base/error.h"
#include "base/file.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

// Whether writing to a would replace b. Devices and pipes take any number of outputs.
bool is_same_file(const fs::path& a, const fs::path& b) {
    std::error_code ignored;
    if (fs::exists(a, ignored) && fs::exists(b, ignored)) {
        return fs::is_regular_file(a, ignored) && fs::equivalent(a, b, ignored);
    }
    return fs::weakly_canonical(fs::absolute(a, ignored), ignored) ==
           fs::weakly_canonical(fs::absolute(b, ignored), ignored);
}

// A name without an extension is the user's choice: /dev/stdout, a pipe.
void check_extension(const NamedPath& output) {
    const auto& [option, path, wanted] = output;
    std::string found = fs::path(path).extension().string();
    std::ranges::transform(found, found.begin(), [](unsigned char c) { return std::tolower(c); });
    if (found.empty() || found == wanted) return;
    throw InputError("{} {}: this file is written as {}; name it so", option, path, wanted);
}

}  // namespace

void check_outputs(const std::vector<NamedPath>& outputs, const std::vector<std::string>& inputs) {
    for (size_t i = 0; i < outputs.size(); ++i) {
        const auto& [option, path, extension] = outputs[i];
        if (path.empty()) continue;
        if (path == "-") {
            if (extension.empty()) continue;
            throw InputError("{} -: pictures are written to files only", option);
        }
        for (const std::string& input : inputs) {
            if (is_same_file(path, input)) {
                throw InputError("{} {}: it is the input {}, which would be lost", option, path, input);
            }
        }
        for (size_t j = 0; j < i; ++j) {
            const auto& [other_option, other, unused] = outputs[j];
            if (other.empty() || other == "-" || !is_same_file(path, other)) continue;
            throw InputError("{} {}: it is the same file as that of {}", option, path, other_option);
        }
        if (!extension.empty()) check_extension(outputs[i]);
        require_writable(path);
    }
}

}  // namespace obscura
