// SPDX-License-Identifier: Apache-2.0
// The kitchen has no triangle that nobody could see from within the room: hidden ones would only pad its count.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "reference/tracer.h"
#include "scene/gltf.h"
#include "scene/material.h"

namespace obscura {
namespace {

constexpr float LIFT = 1e-5f;  // m: rays start so far above a triangle
constexpr uint8_t FRONT = 1, BACK = 2;

// Which sides of the triangles can be reached from the camera by a chain of straight lines through free space.
class Reach {
  public:
    explicit Reach(const Scene& scene) : scene_(scene), tracer_(scene), sides_(scene.triangles.size(), 0) {}

    // Random walks in all directions; panes let half of them through.
    void walk(const V3f& start, size_t walkers, int steps) {
        std::vector<TraceRay> rays(walkers, TraceRay{start, V3f(0), FAR});
        std::vector<TraceHit> hits(walkers);
        for (TraceRay& ray : rays)
            ray.direction = direction_above(random_unit());
        for (int step = 0; step < steps; ++step) {
            tracer_.closest(rays, hits);
            for (size_t i = 0; i < walkers; ++i) {
                if (hits[i].primitive == NO_PRIMITIVE) {
                    rays[i] = {start, direction_above(random_unit()), FAR};
                    continue;
                }
                sides_[hits[i].primitive] |= side_of(hits[i].primitive, rays[i].direction);
                const bool through =
                    is_pane(scene_.materials[scene_.triangles[hits[i].primitive].material]) &&
                    coin_(random_) == 1;
                const V3f towards = facing(hits[i].primitive, rays[i].direction) * (through ? -1.0f : 1.0f);
                const V3f point = rays[i].origin + hits[i].t * rays[i].direction;
                rays[i] = {point + LIFT * towards, through ? rays[i].direction : direction_above(towards),
                           FAR};
            }
        }
    }

    // Looks from the triangle itself for a side that was reached: what it sees sees it.
    bool sees_what_was_reached(uint32_t triangle, size_t ray_count) {
        std::vector<TraceRay> rays;
        std::vector<TraceHit> hits(ray_count);
        for (size_t i = 0; i < ray_count; ++i) {
            const V3f towards = normal(triangle) * (coin_(random_) == 1 ? 1.0f : -1.0f);
            rays.push_back({random_point(triangle) + LIFT * towards, direction_above(towards), FAR});
        }
        tracer_.closest(rays, hits);
        for (size_t i = 0; i < ray_count; ++i) {
            const uint32_t seen = hits[i].primitive;
            if (seen == NO_PRIMITIVE || seen == triangle) continue;
            if ((sides_[seen] & side_of(seen, rays[i].direction)) == 0) continue;
            sides_[triangle] |= side_of(triangle, -rays[i].direction);
            return true;
        }
        return false;
    }

    std::vector<uint32_t> unreached() const {
        std::vector<uint32_t> triangles;
        for (uint32_t i = 0; i < sides_.size(); ++i)
            if (sides_[i] == 0) triangles.push_back(i);
        return triangles;
    }

  private:
    static constexpr float FAR = 1e6f;

    V3f corner(uint32_t triangle, int i) const { return scene_.corner(triangle, i).position; }
    V3f normal(uint32_t triangle) const {
        const V3f a = corner(triangle, 0);
        return (corner(triangle, 1) - a).cross(corner(triangle, 2) - a).normalized();
    }
    uint8_t side_of(uint32_t triangle, const V3f& direction) const {
        return normal(triangle).dot(direction) < 0 ? FRONT : BACK;
    }
    V3f facing(uint32_t triangle, const V3f& direction) const {
        return side_of(triangle, direction) == FRONT ? normal(triangle) : -normal(triangle);
    }
    V3f random_unit() {
        std::normal_distribution<float> gauss;
        return V3f(gauss(random_), gauss(random_), gauss(random_)).normalized();
    }
    V3f direction_above(const V3f& n) {
        const V3f direction = random_unit();
        return direction.dot(n) < 0 ? -direction : direction;
    }
    V3f random_point(uint32_t triangle) {
        std::uniform_real_distribution<float> unit;
        float u = unit(random_), v = unit(random_);
        if (u + v > 1) {
            u = 1 - u;
            v = 1 - v;
        }
        return (1 - u - v) * corner(triangle, 0) + u * corner(triangle, 1) + v * corner(triangle, 2);
    }

    const Scene& scene_;
    ReferenceTracer tracer_;
    std::vector<uint8_t> sides_;
    std::mt19937_64 random_{1};
    std::uniform_int_distribution<int> coin_{0, 1};
};

TEST(Kitchen, EveryTriangleCanBeSeen) {
    const Scene scene = load_gltf(find_scene_file(OBSCURA_SOURCE_DIR "/scenes/kitchen"));
    Reach reach(scene);
    reach.walk(V3f(scene.cameras.front().camera_to_world.translation()), 100000, 100);
    EXPECT_LT(reach.unreached().size(), scene.triangles.size() / 20) << "the walks alone find most of them";
    // A triangle that only others of this list can see is found in a later round.
    std::vector<uint32_t> hidden = reach.unreached();
    for (size_t before = hidden.size() + 1; hidden.size() < before;) {
        before = hidden.size();
        std::erase_if(hidden,
                      [&](uint32_t triangle) { return reach.sees_what_was_reached(triangle, 20000); });
    }
    for (const uint32_t triangle : hidden)
        ADD_FAILURE() << "nobody sees triangle " << triangle << " of "
                      << scene.objects[scene.triangles[triangle].object].name;
}

}  // namespace
}  // namespace obscura
