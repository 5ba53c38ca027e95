// SPDX-License-Identifier: Apache-2.0
// Writing what a long render gave: nothing is lost to a full disk or to a mistake in another output.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "film/image.h"

namespace obscura {

// Writes the picture to path or, where that fails, under a name that is free in the folder for temporary files. Throws
// InputError if it isn't at path, which says why and where the picture is now, if anywhere.
void save_picture(const Image& image, const std::string& path, bool half_color);

// Calls each, whatever becomes of the others, then throws one InputError that holds the messages of those that failed.
void write_all(const std::vector<std::function<void()>>& outputs);

}  // namespace obscura
