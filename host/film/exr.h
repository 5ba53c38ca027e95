// SPDX-License-Identifier: Apache-2.0
// What reading and writing OpenEXR share. Internal to film.
#pragma once

#include <string>

namespace obscura::exr {

// Names of the attributes that describe the file itself, not the picture.
bool is_structural(const std::string& attribute_name);

// Lets OpenEXR (de)compress on all cores; the first call counts.
void start_threads();

}  // namespace obscura::exr
