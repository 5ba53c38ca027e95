// SPDX-License-Identifier: Apache-2.0
#include "cli/picture_output.h"

#include <fmt/ranges.h>

#include <filesystem>

#include "base/error.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

// NAME.exr, NAME-1.exr ... in the folder for temporary files: the first that doesn't exist. What has no extension, as
// a device, gets one there.
fs::path free_rescue_path(const fs::path& path) {
    const fs::path folder = fs::temp_directory_path();
    const std::string stem = path.stem().string();
    const std::string extension = path.has_extension() ? path.extension().string() : ".exr";
    fs::path rescue = folder / (stem + extension);
    for (int i = 1; fs::exists(rescue); ++i)
        rescue = folder / fmt::format("{}-{}{}", stem, i, extension);
    return rescue;
}

}  // namespace

void save_picture(const Image& image, const std::string& path, bool half_color) {
    std::string message;
    try {
        return write_exr(image, path, half_color);
    } catch (const InputError& error) {
        message = error.what();
    }
    try {
        const fs::path rescue = free_rescue_path(path);
        write_exr(image, rescue, half_color);
        message += fmt::format("; the picture was saved as {} instead", rescue.string());
    } catch (const std::exception& error) {
        message += fmt::format("; the picture could not be saved elsewhere either: {}", error.what());
    }
    throw InputError("{}", message);
}

void write_all(const std::vector<std::function<void()>>& outputs) {
    std::vector<std::string> failures;
    for (const auto& output : outputs) {
        try {
            output();
        } catch (const InputError& error) {
            failures.emplace_back(error.what());
        }
    }
    if (!failures.empty()) throw InputError("{}", fmt::join(failures, "\n"));
}

}  // namespace obscura
