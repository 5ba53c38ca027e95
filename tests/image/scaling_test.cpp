// SPDX-License-Identifier: Apache-2.0
// A scene and its d_max times a power of two, lit as before, give the same bits in every layer: no length in the program
// is absolute. This room of 4 m does so from 2^-37 to 2^40; beyond, products of three lengths in the triangle test leave
// the range of floats, and the reader measures a scene in another unit.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "scene/gltf.h"
#include "support/busy_room.h"
#include "support/render.h"
#include "support/same_bits.h"
#include "support/temporary_folder.h"

namespace obscura::test {
namespace {

using Scaling = DeviceTest;

// Lamps keep the irradiance that they give.
Scene scaled(Scene scene, float scale) {
    for (Vertex& vertex : scene.vertices)
        vertex.position *= scale;
    scene.bounds.min *= scale;
    scene.bounds.max *= scale;
    for (PunctualLight& light : scene.lights) {
        light.position *= scale;
        light.range *= scale;
        if (light.type != LightType::directional) light.intensity *= scale * scale;
    }
    for (Camera& camera : scene.cameras)
        for (int axis = 0; axis < 3; ++axis)
            camera.camera_to_world[3][axis] *= static_cast<double>(scale);
    return scene;
}

Image render_scaled(int exponent) {
    const float scale = std::ldexp(1.0f, exponent);
    RenderSettings settings = picture(48, 36, 4, 4);
    settings.light_samples = 2;
    settings.background = Rgb(0.2f, 0.3f, 0.4f);
    settings.d_max.value = static_cast<double>(scale);
    Image image = render(scaled(busy_room(), scale), settings, every_layer()).image;
    // Positions scale with the scene.
    for (Layer& layer : image.layers)
        if (layer.name == "P" || layer.name == "Z")
            for (float& value : layer.pixels)
                value /= scale;
    return image;
}

TEST_F(Scaling, PowersOfTwoKeepEveryBit) {
    const Image original = render_scaled(0);
    for (int exponent = -20; exponent <= 20; ++exponent) {
        SCOPED_TRACE(exponent);
        expect_same_bits(render_scaled(exponent), original);
    }
}

// A Cornell box of 5.5 m * 2^exponent with a lamp in it, written to a file and read.
Image render_read(int exponent) {
    const double scale = std::ldexp(1.0, exponent);
    nlohmann::json file =
        nlohmann::json::parse(std::ifstream(OBSCURA_SOURCE_DIR "/scenes/cornell/cornell.gltf"));
    file["extensionsUsed"].push_back("KHR_lights_punctual");
    file["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"intensity", 10 * scale * scale}, {"range", 4 * scale}}};
    file["nodes"].push_back(
        {{"translation", {1.5, 3.5, -1}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    auto& roots = file["scenes"][0]["nodes"];
    roots.push_back(file["nodes"].size() - 1);
    file["nodes"].push_back({{"scale", {scale, scale, scale}}, {"children", roots}});
    roots = {file["nodes"].size() - 1};
    const TemporaryFolder folder;
    const std::string path = folder.file("scaled.gltf");
    std::ofstream(path) << file;

    RenderSettings settings = picture(40, 40, 4, 4);
    settings.d_max.value = scale;
    Image image = render(load_gltf(path), settings, every_layer()).image;
    for (Layer& layer : image.layers)
        if (layer.name == "P" || layer.name == "Z")
            for (float& value : layer.pixels)
                value = static_cast<float>(static_cast<double>(value) / scale);
    return image;
}

// Single lengths stay in the range of floats: the farthest are positions in the picture.
TEST_F(Scaling, ReaderKeepsEveryBitOfTinyAndHugeScenes) {
    const Image original = render_read(0);
    for (const int exponent : {-110, -60, -44, 44, 60, 110}) {
        SCOPED_TRACE(exponent);
        expect_same_bits(render_read(exponent), original);
    }
}

}  // namespace
}  // namespace obscura::test
