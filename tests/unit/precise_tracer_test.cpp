// SPDX-License-Identifier: Apache-2.0
// The reference renderer's tracer against every triangle in long double: it finds the same hits, wherever the scene lies.
#include "reference/precise_tracer.h"

#include <gtest/gtest.h>

#include <random>

#include "reference/brute_force.h"
#include "support/errors.h"
#include "support/scene_builder.h"

namespace obscura::reference {
namespace {

using obscura::BruteHit;
using test::SceneBuilder;

V3d random_direction(std::mt19937& random) {
    std::normal_distribution<double> normal;
    return V3d(normal(random), normal(random), normal(random)).normalized();
}

// Three spheres and a box, about a point.
Scene clutter(const V3f& place) {
    SceneBuilder builder;
    const uint32_t material = builder.material(test::matte(Rgb(0.5f)));
    builder.sphere(place + V3f(0, 0, 0), 1, 2, material);
    builder.sphere(place + V3f(1.5f, 0.2f, 0), 0.5f, 2, material);
    builder.sphere(place + V3f(0, 1.2f, 0.6f), 0.4f, 2, material);
    builder.box(place + V3f(-3, -3, -3), place + V3f(3, 3, 3), material, true);
    return builder.finish();
}

BruteHit nearest_of_all(const Scene& scene, const Ray& ray) {
    BruteHit nearest;
    for (uint32_t i = 0; i < scene.triangles.size(); ++i) {
        const std::array<V3f, 3> corners{scene.corner(i, 0).position, scene.corner(i, 1).position,
                                         scene.corner(i, 2).position};
        const BruteHit hit = obscura::intersect({ray.origin, ray.direction}, corners, i);
        if (hit.inside() && hit.t > 0 && hit.t < ray.t_max && nearer(hit, nearest)) nearest = hit;
    }
    return nearest;
}

TEST(PreciseTracer, FindsWhatBruteForceFinds) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> place(-2.9, 2.9), reach(0, 4);
    for (const float offset : {0.0f, 1e3f, 1e5f}) {
        const Scene scene = clutter(V3f(offset));
        const PreciseTracer tracer(scene);
        for (int i = 0; i < 2000; ++i) {
            const V3d origin =
                V3d(static_cast<double>(offset)) + V3d(place(random), place(random), place(random));
            const Ray ray{origin, random_direction(random),
                          i % 2 == 0 ? std::numeric_limits<double>::infinity() : reach(random)};
            const BruteHit expected = nearest_of_all(scene, ray);
            const Hit hit = tracer.nearest(ray);
            ASSERT_EQ(hit.primitive, expected.primitive) << "ray " << i << ", offset " << offset;
            EXPECT_EQ(tracer.is_blocked(ray), expected.hit());
            if (!expected.hit()) continue;
            const double rounding = 1e-13 * (1 + static_cast<double>(offset)) / expected.cosine;
            EXPECT_NEAR(hit.t, expected.t, rounding);
            EXPECT_NEAR(hit.u, expected.u, 100 * rounding);
            EXPECT_NEAR(hit.v, expected.v, 100 * rounding);
        }
    }
}

// Rays from within a closed sphere at the edges and corners of its mesh, which float tracers find hardest.
TEST(PreciseTracer, ClosedMeshHasNoHoles) {
    SceneBuilder builder;
    builder.sphere(V3f(0), 1, 3, builder.material(test::matte(Rgb(0.5f))));
    const Scene scene = builder.finish();
    const PreciseTracer tracer(scene);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> inside(-0.5, 0.5), along(0, 1);
    for (uint32_t i = 0; i < scene.triangles.size(); ++i) {
        for (const double weight : {0.0, along(random)}) {
            const V3d origin(inside(random), inside(random), inside(random));
            const V3d a(scene.corner(i, 0).position), b(scene.corner(i, 1).position);
            const Ray ray{origin, (a + weight * (b - a) - origin).normalized()};
            EXPECT_TRUE(tracer.nearest(ray).found()) << "triangle " << i << ", weight " << weight;
        }
    }
}

TEST(PreciseTracer, HitsLieStrictlyBetweenTheEnds) {
    SceneBuilder builder;
    builder.quad({-1, -1, 2}, {2, 0, 0}, {0, 2, 0}, builder.material(test::matte(Rgb(0.5f))));
    const PreciseTracer tracer(builder.finish());
    const V3d direction(0, 0, 1);
    EXPECT_TRUE(tracer.nearest({V3d(0.1, 0.2, 0), direction, std::nextafter(2, 3)}).found());
    EXPECT_FALSE(tracer.nearest({V3d(0.1, 0.2, 0), direction, 2}).found());
    EXPECT_FALSE(tracer.nearest({V3d(0.1, 0.2, 2), direction}).found());
    EXPECT_TRUE(tracer.nearest({V3d(0.1, 0.2, 2 - 1e-15), direction}).found())
        << "closer than floats can tell";
}

TEST(PreciseTracer, SmallerIndexWinsATie) {
    SceneBuilder builder;
    const uint32_t material = builder.material(test::matte(Rgb(0.5f)));
    for (int i = 0; i < 3; ++i)
        builder.triangle({-1, -1, 2}, {1, -1, 2}, {0, 1, 2}, material);
    const PreciseTracer tracer(builder.finish());
    EXPECT_EQ(tracer.nearest({V3d(0, 0, 0), V3d(0, 0, 1)}).primitive, 0u);
}

// A camera beyond the limit has no rays, and leaves those of another what they are.
TEST(PreciseTracer, RefusesRaysBeyondEmbreesLimit) {
    Scene scene = clutter(V3f(0));
    const V3d direction(0, 0, -1);
    const Hit hit = PreciseTracer(scene).nearest({V3d(0, 0, 50), direction});
    ASSERT_TRUE(hit.found());
    scene.cameras.emplace_back().camera_to_world.setTranslation(V3d(0, 0, 1e25));
    const PreciseTracer tracer(scene);
    EXPECT_EQ(tracer.nearest({V3d(0, 0, 50), direction}).primitive, hit.primitive);
    EXPECT_INPUT_ERROR(tracer.nearest({V3d(0, 0, 1e25), direction}), "camera");
    EXPECT_INPUT_ERROR(tracer.is_blocked({V3d(0, 0, 1e25), direction}), "camera");
}

TEST(PreciseTracer, EmptySceneHasNoHits) {
    const PreciseTracer tracer(SceneBuilder().finish());
    EXPECT_FALSE(tracer.nearest({V3d(0), V3d(0, 0, 1)}).found());
    EXPECT_FALSE(tracer.is_blocked({V3d(0), V3d(0, 0, 1)}));
}

}  // namespace
}  // namespace obscura::reference
