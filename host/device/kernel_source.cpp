// SPDX-License-Identifier: Apache-2.0
// Finding and expanding kernel sources. Headers are inserted wherever they are included, and their include
// guards do the rest: that stays right when an include stands inside an #if.
#include "device/kernel_source.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/file.h"

namespace obscura {

namespace {

// The folder that replaces the embedded files, if one is named.
std::optional<std::filesystem::path> kernel_folder() {
    const char* const folder = std::getenv("OBSCURA_KERNEL_DIR");
    if (folder == nullptr || *folder == '\0') return std::nullopt;
    return folder;
}

bool kernel_exists(std::string_view path) {
    if (const auto folder = kernel_folder()) return std::filesystem::is_regular_file(*folder / path);
    return std::ranges::binary_search(embedded_kernel_files(), path, {}, &EmbeddedFile::path);
}

// `#include "x"` -> x. Includes in angle brackets are the host's (shared headers, under __cplusplus).
std::optional<std::string_view> included_path(std::string_view line) {
    const auto skip_blanks = [&] {
        line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    };
    const auto skip = [&](std::string_view token) {
        skip_blanks();
        const bool found = line.starts_with(token);
        if (found) line.remove_prefix(token.size());
        return found;
    };
    if (!skip("#") || !skip("include") || !skip("\"")) return std::nullopt;
    return line.substr(0, line.find('"'));
}

class Expander {
  public:
    std::string result;

    void append(const std::string& name, std::string_view text) {
        open_.push_back(name);
        append_line_directive(1, name);
        for (int number = 1; !text.empty(); ++number) {
            const size_t end = text.find('\n');
            const std::string_view line = text.substr(0, end);
            text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
            if (const auto path = included_path(line)) {
                append_include(*path, name, number);
                append_line_directive(number + 1, name);
            } else {
                result.append(line);
                result += '\n';
            }
        }
        open_.pop_back();
    }

  private:
    void append_include(std::string_view path, const std::string& parent, int line) {
        const std::string name = fmt::format("kernels/{}", path);
        if (std::ranges::find(open_, name) != open_.end())
            throw InputError("{}:{}: \"{}\" includes itself.", parent, line, path);
        if (!kernel_exists(path))
            throw InputError("{}:{}: there is no \"{}\" to include.", parent, line, path);
        append(name, kernel_text(path));
    }

    void append_line_directive(int line, const std::string& name) {
        result += fmt::format("#line {} \"{}\"\n", line, name);
    }

    std::vector<std::string> open_;  // the files being expanded, outermost first
};

}  // namespace

std::string kernel_text(std::string_view path) {
    if (const auto folder = kernel_folder()) return read_text(*folder / path);
    const auto files = embedded_kernel_files();
    const auto found = std::ranges::lower_bound(files, path, {}, &EmbeddedFile::path);
    if (found == files.end() || found->path != path)
        throw InputError("kernels/{}: there is no such kernel source in this program.", path);
    return std::string(found->text);
}

std::string expand_kernel_file(std::string_view path) {
    return expand_kernel_text(fmt::format("kernels/{}", path), kernel_text(path));
}

std::string expand_kernel_text(std::string_view name, std::string_view text) {
    Expander expander;
    expander.append(std::string(name), text);
    return std::move(expander.result);
}

}  // namespace obscura
