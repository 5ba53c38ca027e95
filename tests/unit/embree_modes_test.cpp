// SPDX-License-Identifier: Apache-2.0
// Every mode in which `obscura bench` runs Embree finds what the reference tracer finds: a mode that traced fewer rays, or
// others, would be a peer of no worth.
#include "reference/embree_modes.h"

#include "reference/hard_rays.h"
#include "reference/meshes.h"
#include "support/busy_room.h"
#include "support/errors.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

namespace obscura {
namespace {

class EmbreeModes : public testing::TestWithParam<size_t> {};

// Rays in numbers that fill blocks, streams and tasks, or don't. Random rays meet no edge, so that the fast modes agree.
TEST_P(EmbreeModes, FindWhatTheReferenceFinds) {
    const Scene scene = triangle_soup(1500, 0.1f, 1, 1);
    const ReferenceTracer reference(scene);
    const EmbreeRunner runner(scene, 2);
    std::vector<TraceRay> given = random_rays(scene, GetParam(), 3);
    for (size_t i = 0; i < given.size(); i += 3)
        given[i].t_max = 0.5f;  // some end before their hit
    std::vector<TraceHit> closest(given.size());
    reference.closest(given, closest);
    for (const EmbreeMode& mode : embree_modes()) {
        SCOPED_TRACE(call_text(mode) + (mode.robust ? ", robust" : ", fast"));
        EmbreeRays rays(given);
        EXPECT_GT(runner.trace(mode, RayQuery::closest, rays), 0);
        const std::vector<TraceHit> hits = rays.arranged(mode).hits_in_order();
        ASSERT_EQ(hits.size(), given.size());
        for (size_t i = 0; i < hits.size(); ++i) {
            ASSERT_EQ(hits[i].primitive, closest[i].primitive) << "ray " << i;
            if (hits[i].primitive == NO_PRIMITIVE) continue;
            EXPECT_NEAR(hits[i].t, closest[i].t, 1e-4f) << "ray " << i;
            EXPECT_NEAR(hits[i].u, closest[i].u, 1e-3f) << "ray " << i;
            EXPECT_NEAR(hits[i].v, closest[i].v, 1e-3f) << "ray " << i;
        }
        EmbreeRays again(given);
        runner.trace(mode, RayQuery::any, again);
        const std::vector<TraceHit> any = again.arranged(mode).hits_in_order();
        for (size_t i = 0; i < any.size(); ++i)
            ASSERT_EQ(any[i].primitive != NO_PRIMITIVE, closest[i].primitive != NO_PRIMITIVE) << "ray " << i;
    }
}

INSTANTIATE_TEST_SUITE_P(RayCounts, EmbreeModes, testing::Values(1, 8, 16, 17, 257, 10001));

// A run leaves the rays as they were.
TEST(EmbreeRunner, RepeatsItself) {
    const Scene scene = icosphere(3);
    const EmbreeRunner runner(scene, 2);
    EmbreeRays rays(random_rays(scene, 1000, 1));
    for (const EmbreeMode& mode : embree_modes()) {
        runner.trace(mode, RayQuery::closest, rays);
        const std::vector<TraceHit> first = rays.arranged(mode).hits_in_order();
        runner.trace(mode, RayQuery::closest, rays);
        const std::vector<TraceHit> second = rays.arranged(mode).hits_in_order();
        for (size_t i = 0; i < first.size(); ++i)
            ASSERT_EQ(first[i].t, second[i].t) << call_text(mode);
    }
}

// Every third triangle lets light pass: those rays are stopped that the other triangles alone would stop.
TEST(EmbreeRunner, OpaqueMeansAllButPanes) {
    Scene scene = triangle_soup(1500, 0.1f, 1, 1);
    scene.materials.push_back(test::clear_pane());
    Scene without_panes = scene;
    without_panes.triangles.clear();
    for (size_t i = 0; i < scene.triangles.size(); ++i) {
        if (i % 3 == 0) {
            scene.triangles[i].material = static_cast<uint32_t>(scene.materials.size() - 1);
        } else {
            without_panes.triangles.push_back(scene.triangles[i]);
        }
    }
    const EmbreeRunner runner(scene, 2), expected(without_panes, 2);
    const std::vector<TraceRay> given = random_rays(scene, 10001, 3);
    for (const EmbreeMode& mode : embree_modes()) {
        SCOPED_TRACE(call_text(mode) + (mode.robust ? ", robust" : ", fast"));
        EmbreeRays rays(given), same(given), all(given);
        runner.trace(mode, RayQuery::opaque, rays);
        expected.trace(mode, RayQuery::any, same);
        runner.trace(mode, RayQuery::any, all);
        const std::vector<TraceHit> opaque = rays.arranged(mode).hits_in_order();
        const std::vector<TraceHit> others = same.arranged(mode).hits_in_order();
        const std::vector<TraceHit> any = all.arranged(mode).hits_in_order();
        size_t passed = 0;
        for (size_t i = 0; i < given.size(); ++i) {
            ASSERT_EQ(opaque[i].primitive != NO_PRIMITIVE, others[i].primitive != NO_PRIMITIVE)
                << "ray " << i;
            if (opaque[i].primitive != any[i].primitive) ++passed;
        }
        EXPECT_GT(passed, 50u);
    }
}

TEST(EmbreeRunner, RefusesRaysBeyondEmbreesLimit) {
    const std::vector<TraceRay> rays{{{0, 0, 0}, {0, 1e19f, 0}, 1}};
    EXPECT_INPUT_ERROR(EmbreeRays{rays}, "light");
}

TEST(EmbreeRunner, CountsTheBytesOfItsHierarchy) {
    const Scene small = icosphere(3), large = icosphere(5);  // 16 times the triangles
    for (const bool robust : {true, false}) {
        const EmbreeCost few = EmbreeRunner(small, 1).cost(robust);
        const EmbreeCost many = EmbreeRunner(large, 1).cost(robust);
        EXPECT_GT(few.bytes, 20 * small.triangles.size());
        EXPECT_GT(many.bytes, 8 * few.bytes);
        EXPECT_LT(many.bytes, 400 * large.triangles.size());
        EXPECT_GT(many.build_seconds, 0);
    }
}

TEST(EmbreeModesList, HasEveryCallRobustAndFastInTheSameOrder) {
    std::set<std::string> texts;
    const std::vector<EmbreeMode>& modes = embree_modes();
    const size_t half = modes.size() / 2;
    for (size_t i = 0; i < half; ++i) {
        EXPECT_TRUE(modes[i].robust);
        EXPECT_FALSE(modes[half + i].robust);
        EXPECT_EQ(call_text(modes[i]), call_text(modes[half + i]));
        texts.insert(call_text(modes[i]));
    }
    EXPECT_EQ(texts.size(), half);
}

}  // namespace
}  // namespace obscura
