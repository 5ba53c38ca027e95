// SPDX-License-Identifier: Apache-2.0
#include "scene/local_frame.h"

#include <algorithm>
#include <cmath>

namespace obscura {
namespace {

// The middle of [low, high] as a float that every float in it is exactly subtracted from: none is more than twice another.
float subtractable_middle(float low, float high) {
    const float nearest = std::min(std::abs(low), std::abs(high));
    const float farthest = std::max(std::abs(low), std::abs(high));
    const bool same_side = (low > 0) == (high > 0);
    return same_side && farthest <= 2 * nearest ? low + (high - low) / 2 : 0;
}

}  // namespace

void move_near_origin(Scene& scene) {
    if (scene.bounds.isEmpty()) return;
    V3f middle;
    for (int axis = 0; axis < 3; ++axis)
        middle[axis] = subtractable_middle(scene.bounds.min[axis], scene.bounds.max[axis]);
    if (middle == V3f(0)) return;
    scene.origin += V3d(middle);
    for (Vertex& vertex : scene.vertices)
        vertex.position -= middle;
    scene.bounds.min -= middle;
    scene.bounds.max -= middle;
    for (PunctualLight& light : scene.lights)
        light.position = V3f(V3d(light.position) - V3d(middle));
    for (Camera& camera : scene.cameras)
        for (int axis = 0; axis < 3; ++axis)
            camera.camera_to_world[3][axis] -= static_cast<double>(middle[axis]);
}

Camera world_camera(const Scene& scene, const Camera& camera) {
    Camera moved = camera;
    for (int axis = 0; axis < 3; ++axis)
        moved.camera_to_world[3][axis] += scene.origin[axis];
    return moved;
}

}  // namespace obscura
