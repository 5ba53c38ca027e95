// SPDX-License-Identifier: Apache-2.0
// A small room with one of everything that obscura models: colours, a texture, glossy and mirroring spheres, a
// smooth-shaded one, a clear pane, an unlit picture, an area light, a point, a spot and a directional light. Open at the front.
#pragma once

#include "support/scene_builder.h"

namespace obscura::test {

// 2 x 2 squares of light and dark red, repeated by the sampler.
inline Texture checker_texture() {
    Texture texture;
    texture.name = "checker";
    texture.width = 2;
    texture.height = 2;
    texture.rgba = {220, 180, 170, 255, 90, 40, 30, 255, 90, 40, 30, 255, 220, 180, 170, 255};
    return texture;
}

inline Material clear_pane() {
    Material pane = matte(Rgb(0.9f, 0.95f, 1.0f));
    pane.name = "pane";
    pane.transmission = 1;
    pane.double_sided = true;
    return pane;
}

// Opaque, for all its transmission: that is a property of lit surfaces.
inline Material unlit_picture() {
    Material picture = matte(Rgb(0.2f, 0.4f, 0.9f));
    picture.name = "picture";
    picture.transmission = 0.5f;
    picture.unlit = true;
    return picture;
}

inline PunctualLight point_light(const V3f& position, const Rgb& intensity) {
    PunctualLight light;
    light.name = "point";
    light.intensity = intensity;
    light.position = position;
    return light;
}

// Full intensity within inner, nothing beyond outer: radians from the axis.
inline PunctualLight spot_light(const V3f& position, const V3f& direction, const Rgb& intensity, float inner,
                                float outer) {
    PunctualLight light = point_light(position, intensity);
    light.name = "spot";
    light.type = LightType::spot;
    light.direction = direction.normalized();
    light.cos_inner = std::cos(inner);
    light.cos_outer = std::cos(outer);
    return light;
}

inline PunctualLight directional_light(const V3f& direction, const Rgb& irradiance) {
    PunctualLight light;
    light.name = "sun";
    light.type = LightType::directional;
    light.intensity = irradiance;
    light.direction = direction.normalized();
    return light;
}

// 4 x 3 x 4 m, the floor at y = 0, the opening at z = 2.
inline Scene busy_room() {
    SceneBuilder builder;
    Material checker = matte(Rgb(1));
    checker.base_color_texture = builder.texture(checker_texture());
    Material glossy = matte(Rgb(0.2f, 0.5f, 0.3f));
    glossy.specular = 1;
    glossy.roughness = 0.3f;
    const uint32_t white = builder.material(matte(Rgb(0.7f)));
    builder.quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, builder.material(checker));
    builder.quad({-2, 3, -2}, {4, 0, 0}, {0, 0, 4}, white);
    builder.quad({-2, 0, -2}, {4, 0, 0}, {0, 3, 0}, white);
    builder.quad({-2, 0, 2}, {0, 0, -4}, {0, 3, 0}, builder.material(matte(Rgb(0.7f, 0.1f, 0.1f))));
    builder.quad({2, 0, -2}, {0, 0, 4}, {0, 3, 0}, builder.material(matte(Rgb(0.1f, 0.6f, 0.2f))));
    builder.quad({-0.5f, 2.9f, -0.5f}, {1, 0, 0}, {0, 0, 1},
                 builder.material(matte(Rgb(0.3f), Rgb(9, 8, 6))));
    builder.box({-1.6f, 0, -1.5f}, {-0.8f, 1.2f, -0.7f}, builder.material(glossy));
    builder.sphere({-1.0f, 0.4f, 0.6f}, 0.4f, 2, builder.material(metal(Rgb(0.9f, 0.7f, 0.3f), 0.4f)), false,
                   true);
    builder.sphere({1.0f, 0.6f, -0.8f}, 0.6f, 2, builder.material(metal(Rgb(0.95f), 0)), false, true);
    builder.sphere({0, 0.3f, 0.2f}, 0.3f, 1, white, false, true);
    builder.quad({0.4f, 0, 0.9f}, {1.2f, 0, 0.3f}, {0, 1.5f, 0}, builder.material(clear_pane()));
    builder.quad({1.4f, 1.2f, -1.9f}, {0.4f, 0, 0}, {0, 0.6f, 0.1f}, builder.material(unlit_picture()));
    builder.light(point_light({-1.5f, 2.2f, 1}, Rgb(1.5f, 1.2f, 1)));
    builder.light(spot_light({1.5f, 2.6f, 1.5f}, {-1, -2, -1.5f}, Rgb(4, 5, 6), 0.3f, 0.5f));
    builder.light(directional_light({0.3f, -0.6f, -1}, Rgb(0.8f, 0.7f, 0.5f)));
    builder.camera({0, 1.5, 5.5}, {0, 1.3, 0}, 0.75);
    return builder.finish();
}

}  // namespace obscura::test
