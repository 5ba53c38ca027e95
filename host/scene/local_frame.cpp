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

// Products of three lengths between these are normal floats, with room for those of a triangle's height and of the way
// to it.
constexpr double SHORTEST_USUAL = 0x1p-40;
constexpr double LONGEST_USUAL = 0x1p40;
// A triangle's height over its longest side below which nothing is left of it in floats.
constexpr double FLATTEST = 0x1p-40;

}  // namespace

void LengthRange::add(const Scene& scene, const std::array<uint32_t, 3>& vertices) {
    std::array<V3d, 3> corner;
    for (size_t k = 0; k < 3; ++k)
        corner[k] = V3d(scene.vertices[vertices[k]].position);
    const V3d a = corner[1] - corner[0], b = corner[2] - corner[0];
    const double area = a.cross(b).length();
    const double longest2 = std::max({a.length2(), b.length2(), (b - a).length2()});
    if (!(area > FLATTEST * longest2)) return;
    smallest = std::min(smallest, std::sqrt(area));
    for (const V3d& position : corner)
        for (int axis = 0; axis < 3; ++axis)
            largest = std::max(largest, std::abs(position[axis]));
}

double scene_unit(const LengthRange& lengths) {
    const auto [smallest, largest] = lengths;
    if (largest == 0 || (smallest >= SHORTEST_USUAL && largest <= LONGEST_USUAL)) return 1;
    const double middle = std::max(std::sqrt(smallest) * std::sqrt(largest), largest / LONGEST_USUAL);
    return std::exp2(std::round(std::log2(middle)));
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
