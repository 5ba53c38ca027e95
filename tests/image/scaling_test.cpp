// SPDX-License-Identifier: Apache-2.0
// A scene and its d_max times a power of two, lit as before, give the same bits in every layer: no length in the program
// is absolute. This room of 4 m does so from 2^-37 to 2^40; beyond, products of three lengths in the triangle test leave
// the range of floats.
#include <gtest/gtest.h>

#include <cmath>

#include "support/busy_room.h"
#include "support/render.h"
#include "support/same_bits.h"

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

}  // namespace
}  // namespace obscura::test
