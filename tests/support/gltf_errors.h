// SPDX-License-Identifier: Apache-2.0
// What the reader says of broken glTF files.
#pragma once

#include "scene/gltf.h"
#include "support/errors.h"
#include "support/gltf_builder.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace obscura::test {

// The message for a file, without the folder's name.
inline std::string error_of_bytes(const std::vector<uint8_t>& bytes, const std::string& name = "test.glb") {
    const TemporaryFolder folder;
    write_file(folder.file(name), bytes);
    std::string message = input_error([&] { load_gltf(folder.file(name)); });
    EXPECT_TRUE(message.starts_with(folder.file(name) + ": ")) << message;
    return message.substr(std::min(message.size(), folder.path().string().size() + 1));
}

inline std::string error_of(const GltfBuilder& file) {
    return error_of_bytes(file.glb_bytes());
}

// A sound file to break.
inline GltfBuilder triangle() {
    GltfBuilder file;
    file.add_triangle();
    return file;
}

}  // namespace obscura::test

#define EXPECT_CONTAINS(text, part)                                                              \
    do {                                                                                         \
        const std::string text_ = (text);                                                        \
        EXPECT_NE(text_.find(part), std::string::npos) << "'" << (part) << "' not in " << text_; \
    } while (false)
