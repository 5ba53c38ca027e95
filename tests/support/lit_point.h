// SPDX-License-Identifier: Apache-2.0
// One point of a floor under lamps: 256 pixels that see the same point are 256 independent randomisations of it.
#pragma once

#include "support/render.h"
#include "support/scene_builder.h"

namespace obscura::test {

constexpr double POINT_FOV = 1e-6;
inline const V3d EYE = V3d(0.6, 0.8, 0);  // of the camera, from the floor's point

inline RenderSettings point_settings(uint32_t spp, uint32_t light_samples) {
    RenderSettings settings = picture(16, 16, spp, 1);
    settings.light_samples = light_samples;
    settings.obscurance = false;
    settings.d_max = {50, MaxDistance::Unit::percent};
    return settings;
}

// A floor about the origin, of which the camera sees the origin alone.
inline SceneBuilder floor_scene(const Material& material) {
    SceneBuilder builder;
    builder.quad({-0.2f, 0, 0.2f}, {0.4f, 0, 0}, {0, 0, -0.4f}, builder.material(material));
    builder.camera(EYE, V3d(0, 0, 0), POINT_FOV);
    return builder;
}

}  // namespace obscura::test
