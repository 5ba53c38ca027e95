// SPDX-License-Identifier: Apache-2.0
// Scenes far from the world's origin, where floats are coarse, are moved near it.
#pragma once

#include "scene/scene.h"

namespace obscura {

// Subtracts, axis by axis, the middle of the bounds where the scene is farther from zero than it is wide. There the
// difference of two floats is exact (Sterbenz 1974), so that the geometry stays what the file says, to the bit; what rays
// lose to rounding shrinks to what the scene's own size takes. Scene::origin tells where the zero has gone.
void move_near_origin(Scene& scene);

// The camera in the world's coordinates.
Camera world_camera(const Scene& scene, const Camera& camera);

}  // namespace obscura
