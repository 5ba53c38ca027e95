// SPDX-License-Identifier: Apache-2.0
// Checks the files that a command will write before it begins its work.
#pragma once

#include <string>
#include <vector>

namespace obscura {

// What an option names: a file, "-" for standard output, or nothing. Pictures have an extension and go to files only.
struct NamedPath {
    std::string option;
    std::string path;
    std::string extension = "";  // ".exr", of a picture
};

// Throws InputError if an output can't be written, if two are the same file, if one is an input, or if a picture's name
// has the extension of something else.
void check_outputs(const std::vector<NamedPath>& outputs, const std::vector<std::string>& inputs);

}  // namespace obscura
