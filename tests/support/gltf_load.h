// SPDX-License-Identifier: Apache-2.0
// Loading of small glTF files in tests, with what the reader said.
#pragma once

#include "base/error.h"
#include "scene/gltf.h"
#include "support/gltf_builder.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <string>

namespace obscura::test {

struct Loaded {
    Scene scene;
    std::string said;  // warnings
};

inline Loaded load(const GltfBuilder& file) {
    const TemporaryFolder folder;
    testing::internal::CaptureStderr();
    Loaded loaded;
    try {
        loaded.scene = load_gltf(file.write_glb(folder.file("test.glb")));
    } catch (const InputError& error) {
        ADD_FAILURE() << error.what();
    }
    loaded.said = testing::internal::GetCapturedStderr();
    return loaded;
}

// Where a corner is in the world: the reader moves scenes that are far from its origin.
inline V3f world_position(const Scene& scene, uint32_t triangle, int corner) {
    return V3f(V3d(scene.corner(triangle, corner).position) + scene.origin);
}

inline void expect_near(const V3f& found, const V3f& expected, float tolerance = 1e-6f) {
    EXPECT_NEAR((found - expected).length(), 0, tolerance) << found << " instead of " << expected;
}

// Adds a PNG in the buffer as an image and a texture with the given sampler. Returns the texture's index.
inline int add_image_texture(GltfBuilder& file, const std::vector<uint8_t>& png,
                             const nlohmann::json& sampler = nullptr) {
    const int view = file.view(png.data(), png.size());
    nlohmann::json texture = {
        {"source", file.append("images", {{"bufferView", view}, {"mimeType", "image/png"}})}};
    if (sampler.is_object()) texture["sampler"] = file.append("samplers", sampler);
    return file.append("textures", texture);
}

}  // namespace obscura::test
