// SPDX-License-Identifier: Apache-2.0
// Scenes far from the world's origin, where floats are coarse, are moved near it; scenes so small or so large that
// products of three lengths would leave the range of floats get a unit of their own. Neither changes a bit of a
// coordinate's significand.
#pragma once

#include "scene/scene.h"

namespace obscura {

// The unit, in metres, of a scene whose coordinates reach `extent` metres from the origin: 1, but below 2^-20 m and above
// 2^20 m the power of two that brings the extent into [0.5, 1).
double scene_unit(double extent);

// Subtracts, axis by axis, the middle of the bounds where the scene is farther from zero than it is wide. There the
// difference of two floats is exact (Sterbenz 1974), so that the geometry stays what the file says, to the bit; what rays
// lose to rounding shrinks to what the scene's own size takes. Scene::origin tells where the zero has gone.
void move_near_origin(Scene& scene);

// The same in the world's coordinates, metres.
V3d world_position(const Scene& scene, const V3f& position);
RgbD world_intensity(const Scene& scene, const PunctualLight& light);  // W/sr, directional: W/m^2
Camera world_camera(const Scene& scene, const Camera& camera);

}  // namespace obscura
