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

// Extents in metres that products of three lengths, and of three smaller ones, leave in the range of floats.
constexpr double SMALLEST_USUAL_EXTENT = 0x1p-20;
constexpr double LARGEST_USUAL_EXTENT = 0x1p20;

}  // namespace

double scene_unit(double extent) {
    if (extent == 0 || (extent >= SMALLEST_USUAL_EXTENT && extent <= LARGEST_USUAL_EXTENT)) return 1;
    int exponent = 0;
    std::frexp(extent, &exponent);
    return std::ldexp(1.0, exponent);
}

void move_near_origin(Scene& scene) {
    if (scene.bounds.isEmpty()) return;
    V3f middle;
    for (int axis = 0; axis < 3; ++axis)
        middle[axis] = subtractable_middle(scene.bounds.min[axis], scene.bounds.max[axis]);
    if (middle == V3f(0)) return;
    scene.origin += scene.unit * V3d(middle);
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

V3d world_position(const Scene& scene, const V3f& position) {
    return scene.origin + scene.unit * V3d(position);
}

RgbD world_intensity(const Scene& scene, const PunctualLight& light) {
    const double squared = light.type == LightType::directional ? 1 : scene.unit * scene.unit;
    return squared * RgbD(light.intensity);
}

Camera world_camera(const Scene& scene, const Camera& camera) {
    Camera placed = camera;
    for (int axis = 0; axis < 3; ++axis)
        placed.camera_to_world[3][axis] = scene.origin[axis] + scene.unit * camera.camera_to_world[3][axis];
    placed.half_height *= scene.unit;
    return placed;
}

}  // namespace obscura
