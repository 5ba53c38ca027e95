// SPDX-License-Identifier: Apache-2.0
// Scenes far from the world's origin, where floats are coarse, are moved near it; scenes so small or so large that
// products of three lengths would leave the range of floats get a unit of their own. Neither changes a bit of a
// coordinate's significand.
#pragma once

#include "scene/scene.h"

#include <array>
#include <cstdint>
#include <limits>

namespace obscura {

// The lengths of which triangle tests make products: how far triangles lie from the origin, and how wide they are.
struct LengthRange {
    double smallest =
        std::numeric_limits<double>::infinity();  // side of a square of the least triangle's double area
    double largest = 0;                           // coordinate

    // Triangles without area don't count: they are dropped.
    void add(const Scene& scene, const std::array<uint32_t, 3>& vertices);
};

// The unit that a scene with these lengths in metres is measured in: 1 if they lie between 2^-40 and 2^40, else the power
// of two in their middle, so that as many as can keep their products of three in the range of floats. Above a ratio of
// 2^80 it's the smallest that don't.
double scene_unit(const LengthRange& lengths);

// Subtracts, axis by axis, the middle of the bounds where the scene is farther from zero than it is wide. There the
// difference of two floats is exact (Sterbenz 1974), so that the geometry stays what the file says, to the bit; what rays
// lose to rounding shrinks to what the scene's own size takes. Scene::origin tells where the zero has gone.
void move_near_origin(Scene& scene);

// The same in the world's coordinates, metres.
V3d world_position(const Scene& scene, const V3f& position);
RgbD world_intensity(const Scene& scene, const PunctualLight& light);  // W/sr, directional: W/m^2
Camera world_camera(const Scene& scene, const Camera& camera);

}  // namespace obscura
