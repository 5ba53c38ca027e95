// SPDX-License-Identifier: Apache-2.0
// The device's traversal on rays and meshes that break careless ones: through edges and vertices, along the axes with
// both zeros, in the planes of boxes and triangles, slivers, heaps of equal triangles, far from the origin. The brute
// force in long double decides, Embree is the second opinion. The default and the portable build have to agree bit
// for bit.
#include "reference/hard_rays.h"
#include "bvh/bvh.h"
#include "reference/hit_comparison.h"
#include "reference/meshes.h"
#include "reference/ray_capture.h"
#include "reference/ray_text.h"
#include "support/device.h"
#include "support/scene_builder.h"

#include <array>
#include <cmath>

namespace obscura {
namespace {

constexpr float FAR = std::numeric_limits<float>::infinity();
constexpr float WORLD_OFFSETS[] = {0, 1000};  // m

std::string first_text(const HitTally& tally) {
    if (tally.disagreements.empty()) return {};
    const Disagreement& ray = tally.disagreements.front();
    return outcome_text(ray.outcome) + ": device " + ray.device + ", expected " + ray.expected + ", ray " +
           ray_text(Scene(), ray.ray);
}

class HardRays : public test::DeviceTest {
  protected:
    // Hits of both builds, which must be the same, those of single rays, and what any-hit says about the same rays.
    std::vector<TraceHit> trace(const Scene& scene, const std::vector<TraceRay>& rays) {
        const Bvh bvh = build_bvh(scene);
        ProgramLibrary library(device());
        std::vector<TraceHit> hits;
        for (const char* options : {"", "-D OBSCURA_PORTABLE"}) {
            const DeviceTracer tracer(device(), library, bvh, options);
            const std::vector<TraceHit> found = tracer.closest(rays);
            const std::vector<uint8_t> blocked = tracer.occluded(rays);
            if (hits.empty()) hits = found;
            const std::vector<TraceHit> alone = tracer.closest_alone(rays);
            for (size_t i = 0; i < rays.size(); ++i) {
                EXPECT_TRUE(same_bits(found[i], hits[i])) << "ray " << i << " differs in the portable build";
                EXPECT_TRUE(same_bits(alone[i], hits[i])) << "ray " << i << " differs alone";
                EXPECT_EQ(blocked[i] != 0, hits[i].primitive != NO_PRIMITIVE)
                    << "ray " << i << " with any-hit";
                if (HasFailure()) return hits;
            }
        }
        return hits;
    }

    // Every ray judged by the brute force, whether or not Embree agrees.
    HitTally judge_all(const Scene& scene, const std::vector<TraceRay>& rays) {
        const HitComparison comparison(scene);
        std::vector<TraceHit> embree(rays.size());
        comparison.embree().closest(rays, embree);
        return comparison.compare(rays, trace(scene, rays), embree, 1);
    }

    void expect_none_wrong(const Scene& scene, const std::vector<TraceRay>& rays) {
        const HitTally tally = judge_all(scene, rays);
        EXPECT_EQ(tally.rays, rays.size());
        EXPECT_EQ(tally.device_wrong, 0U) << first_text(tally);
    }
};

TEST_F(HardRays, RandomRaysFindWhatTheOracleFinds) {
    for (const float offset : WORLD_OFFSETS) {
        for (const Scene& mesh : {icosphere(4), triangle_soup(5000, 0.1f, 1, 1), flat_grid(50)}) {
            const Scene scene = moved(mesh, offset);
            const HitTally tally = judge_all(scene, random_rays(scene, 10000, 1));
            EXPECT_EQ(tally.device_wrong, 0U) << first_text(tally);
            EXPECT_LE(tally.ties + tally.edges, 1U);
            EXPECT_GT(tally.hits, 300U);
        }
    }
}

TEST_F(HardRays, EdgesAndVerticesHaveOnlyExplainedDifferences) {
    for (const float offset : WORLD_OFFSETS) {
        for (const Scene& mesh : {icosphere(4), triangle_soup(5000, 0.1f, 1, 2)}) {
            const Scene scene = moved(mesh, offset);
            expect_none_wrong(scene, edge_rays(scene, 5000, 2));
            expect_none_wrong(scene, vertex_rays(scene, 5000, 3));
        }
    }
}

// From inside to outside, aimed at edges and vertices: nothing gets out.
TEST_F(HardRays, ClosedSphereHasNoLeaks) {
    constexpr size_t COUNT = 500000;
    for (const float offset : {0.0f, 1e3f, 1e5f}) {
        const Scene scene = moved(icosphere(5), offset);
        const V3f center = scene.bounds.center();
        for (std::vector<TraceRay> rays : {edge_rays(scene, COUNT, 5), vertex_rays(scene, COUNT, 6)}) {
            for (TraceRay& ray : rays) {
                const V3f target = ray.origin + ray.direction;
                ray.origin = center + 0.1f * (ray.origin - center);
                ray.direction = target - ray.origin;
            }
            size_t leaks = 0;
            for (const TraceHit& hit : trace(scene, rays))
                leaks += hit.primitive == NO_PRIMITIVE ? 1 : 0;
            EXPECT_EQ(leaks, 0U) << "of " << rays.size() << " rays, " << offset << " m from the origin";
        }
    }
}

// Along the axes, with +0 and -0, from points in the planes of boxes, triangles and vertices: 0 / 0 in the slabs.
TEST_F(HardRays, AxisRaysMissNothingThatTheOracleHits) {
    test::SceneBuilder boxes;
    const uint32_t matte = boxes.material(test::matte(Rgb(0.5f)));
    for (int i = 0; i < 27; ++i) {
        const V3f low(static_cast<float>(i % 3), static_cast<float>(i / 3 % 3), static_cast<float>(i / 9));
        boxes.box(low, low + V3f(0.5f), matte);
    }
    const Scene box_grid = boxes.finish();
    for (const float offset : WORLD_OFFSETS) {
        for (const Scene& mesh : {box_grid, flat_grid(16), triangle_soup(2000, 0.2f, 1, 3)}) {
            const Scene scene = moved(mesh, offset);
            const std::vector<TraceRay> rays = axis_rays(scene, 20000, 4);
            const std::vector<TraceHit> hits = trace(scene, rays);
            const std::vector<BruteHit> truth = BruteForce(scene).closest(rays);
            size_t oracle_hits = 0;
            for (size_t i = 0; i < rays.size(); ++i) {
                if (!truth[i].hit()) continue;
                ++oracle_hits;
                ASSERT_NE(hits[i].primitive, NO_PRIMITIVE) << ray_text(scene, {rays[i]});
            }
            EXPECT_GT(oracle_hits, 100U);
            expect_none_wrong(scene, rays);
        }
    }
}

TEST_F(HardRays, EmptySceneIsMissedEverywhere) {
    const Scene empty = MeshBuilder().finish();
    for (const TraceHit& hit : trace(empty, random_rays(empty, 1000, 1)))
        ASSERT_EQ(hit.primitive, NO_PRIMITIVE);
}

TEST_F(HardRays, SingleTriangleIsHitAsTheOracleSays) {
    MeshBuilder mesh;
    mesh.triangle(V3f(0, 0, 0), V3f(1, 0, 0.25f), V3f(0, 1, 0.5f));
    const Scene scene = mesh.finish();
    const HitTally tally = judge_all(scene, random_rays(scene, 20000, 7));
    EXPECT_EQ(tally.device_wrong, 0U);
    EXPECT_EQ(tally.ties, 0U);
    EXPECT_GT(tally.hits, 100U);
}

TEST_F(HardRays, FirstOfManyIdenticalTrianglesIsHit) {
    const Scene one = identical_triangles(1);
    const std::vector<TraceRay> rays = random_rays(one, 500, 8);
    const std::vector<TraceHit> expected = trace(one, rays);
    const std::vector<TraceHit> found = trace(identical_triangles(100000), rays);
    size_t hits = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        ASSERT_TRUE(same_bits(found[i], expected[i])) << "ray " << i << ": primitive " << found[i].primitive;
        hits += found[i].primitive != NO_PRIMITIVE ? 1 : 0;
    }
    EXPECT_GT(hits, 10U);
}

TEST_F(HardRays, SliversAreHitWithinTheirRounding) {
    for (const float thinness : {1e-2f, 1e-4f, 1e-6f}) {
        for (const float offset : WORLD_OFFSETS) {
            const Scene scene = moved(triangle_soup(2000, 1, thinness, 9), offset);
            expect_none_wrong(scene, random_rays(scene, 5000, 10));
            expect_none_wrong(scene, edge_rays(scene, 2000, 11));
        }
    }
}

// Readers drop triangles without area. One in ten here has none: points, needles and corners that coincide.
TEST_F(HardRays, TrianglesWithoutAreaAreNeverHit) {
    Scene scene = triangle_soup(2000, 0.3f, 1, 14);
    const std::vector<TraceRay> rays = edge_rays(scene, 10000, 15);
    std::vector<TraceHit> expected = trace(scene, rays);
    std::vector<uint32_t> moved_to;
    std::vector<Triangle> triangles;
    for (const Triangle& triangle : scene.triangles) {
        if (moved_to.size() % 9 == 0) {
            const auto [a, b, c] = triangle.vertex;
            const std::array<uint32_t, 3> flat[] = {{a, a, a}, {a, b, b}, {c, a, c}};
            triangles.push_back(triangle);
            triangles.back().vertex = flat[moved_to.size() / 9 % 3];
        }
        moved_to.push_back(static_cast<uint32_t>(triangles.size()));
        triangles.push_back(triangle);
    }
    scene.triangles = triangles;
    const std::vector<TraceHit> found = trace(scene, rays);
    size_t hits = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        if (expected[i].primitive != NO_PRIMITIVE) {
            expected[i].primitive = moved_to[expected[i].primitive];
            ++hits;
        }
        ASSERT_TRUE(same_bits(found[i], expected[i])) << "ray " << i << ": primitive " << found[i].primitive;
    }
    EXPECT_GT(hits, 5000U);
}

// Triangles of all sizes down to 2^-40 around one corner, seen from everywhere.
TEST_F(HardRays, NestedScalesAreHitWithinTheirRounding) {
    const Scene scene = nested_scales(40);
    expect_none_wrong(scene, random_rays(scene, 10000, 12));
    expect_none_wrong(scene, edge_rays(scene, 5000, 13));
}

// t counts over (0, t_max), both ends open.
TEST_F(HardRays, EndsOfTheRayAreOpen) {
    MeshBuilder mesh;
    mesh.triangle(V3f(0, 0, 0), V3f(1, 0, 0), V3f(0, 1, 0));
    const V3f above(0.25f, 0.25f, 2);
    const V3f on(0.25f, 0.25f, 0);
    const V3f down(0, 0, -1);
    const float just_above = std::nextafter(2.0f, 3.0f);
    const std::vector<TraceRay> rays{{above, down, FAR}, {above, 4.0f * down, FAR}, {above, down, just_above},
                                     {above, down, 2},   {on, down, FAR},           {above, -down, FAR}};
    const std::vector<TraceHit> hits = trace(mesh.finish(), rays);
    const std::vector<uint32_t> expected{0, 0, 0, NO_PRIMITIVE, NO_PRIMITIVE, NO_PRIMITIVE};
    for (size_t i = 0; i < rays.size(); ++i)
        EXPECT_EQ(hits[i].primitive, expected[i]) << "ray " << i;
    EXPECT_EQ(hits[0].t, 2);
    EXPECT_EQ(hits[1].t, 0.5f);
    EXPECT_EQ(hits[0].u, 0.25f);
    EXPECT_EQ(hits[0].v, 0.25f);
}

}  // namespace
}  // namespace obscura
