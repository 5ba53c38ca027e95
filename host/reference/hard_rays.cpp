// SPDX-License-Identifier: Apache-2.0
#include "reference/hard_rays.h"

#include <algorithm>
#include <limits>
#include <random>

namespace obscura {
namespace {

Box3f bounds_or_unit(const Scene& scene) {
    return scene.triangles.empty() ? Box3f(V3f(0, 0, 0), V3f(1, 1, 1)) : scene.bounds;
}

class RayRandom {
  public:
    explicit RayRandom(uint32_t seed) : random_(seed) {}

    uint32_t index(size_t count) {
        return std::uniform_int_distribution<uint32_t>(0, static_cast<uint32_t>(count) - 1)(random_);
    }
    float unit() { return std::uniform_real_distribution<float>(0, 1)(random_); }
    V3f direction() {
        std::normal_distribution<float> normal;
        return V3f{normal(random_), normal(random_), normal(random_)}.normalized();
    }
    // In the box enlarged by half its diagonal on all sides.
    V3f around(const Box3f& box) {
        const float margin = 0.5F * box.size().length();
        const V3f size = box.size() + V3f(2 * margin);
        return box.min - V3f(margin) + size * V3f{unit(), unit(), unit()};
    }

  private:
    std::mt19937 random_;
};

// along(random): 0 is the edge's first vertex, 1 its second.
template <typename Along>
std::vector<TraceRay> aimed_rays(const Scene& scene, size_t count, uint32_t seed, const Along& along) {
    RayRandom random(seed);
    std::vector<TraceRay> rays;
    for (size_t i = 0; i < count && !scene.triangles.empty(); ++i) {
        const uint32_t triangle = random.index(scene.triangles.size());
        const auto corner = static_cast<int>(random.index(3));
        const V3f a = scene.corner(triangle, corner).position;
        const V3f b = scene.corner(triangle, (corner + 1) % 3).position;
        const V3f origin = random.around(scene.bounds);
        const V3f direction = a + (b - a) * along(random) - origin;
        if (direction.length() > 0)
            rays.push_back({origin, direction, std::numeric_limits<float>::infinity()});
    }
    return rays;
}

}  // namespace

std::vector<TraceRay> random_rays(const Scene& scene, size_t count, uint32_t seed) {
    RayRandom random(seed);
    const Box3f box = bounds_or_unit(scene);
    std::vector<TraceRay> rays;
    for (size_t i = 0; i < count; ++i) {
        const float reach = random.unit() * box.size().length();
        const V3f origin = random.around(box);
        const V3f direction = random.direction();
        rays.push_back({origin, direction, i % 2 == 0 ? std::numeric_limits<float>::infinity() : reach});
    }
    return rays;
}

std::vector<TraceRay> edge_rays(const Scene& scene, size_t count, uint32_t seed) {
    return aimed_rays(scene, count, seed, [](RayRandom& random) { return 0.01F + 0.98F * random.unit(); });
}

std::vector<TraceRay> vertex_rays(const Scene& scene, size_t count, uint32_t seed) {
    return aimed_rays(scene, count, seed, [](RayRandom&) { return 0.0F; });
}

std::vector<TraceRay> axis_rays(const Scene& scene, size_t count, uint32_t seed) {
    RayRandom random(seed);
    const Box3f box = bounds_or_unit(scene);
    std::vector<TraceRay> rays;
    for (size_t i = 0; i < count; ++i) {
        V3f origin = random.around(box);
        for (int axis = 0; axis < 3; ++axis)
            if (!scene.vertices.empty() && random.unit() < 0.5F)
                origin[axis] = scene.vertices[random.index(scene.vertices.size())].position[axis];
        V3f direction;
        for (int axis = 0; axis < 3; ++axis)
            direction[axis] = random.unit() < 0.5F ? 0.0F : -0.0F;
        direction[static_cast<int>(i % 3)] = random.unit() < 0.5F ? 1.0F : -1.0F;
        rays.push_back({origin, direction, std::numeric_limits<float>::infinity()});
    }
    return rays;
}

}  // namespace obscura
