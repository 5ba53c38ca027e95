// SPDX-License-Identifier: Apache-2.0
// The stage trace on hand-made rays: each ray gets its hit in its own lane, and nothing else changes.
#include "bvh/layout.h"
#include "support/device.h"
#include "support/kernel_queue.h"
#include "support/render.h"
#include "support/scene_builder.h"

#include <limits>

namespace obscura {
namespace {

// A square from (0,0,0) to (1,1,0), triangles 0 (below the diagonal) and 1, and a small one behind it.
Scene square() {
    test::SceneBuilder builder;
    const uint32_t matte = builder.material(test::matte(Rgb(0.5f)));
    builder.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, matte);
    builder.triangle({2, 0, -3}, {3, 0, -3}, {2, 1, -3}, matte);
    return builder.finish();
}

// Depth 0, camera rays in packets, and depth 1, glossy rays in streams.
class TraceStage : public test::DeviceTest, public testing::WithParamInterface<uint32_t> {
  protected:
    // The first `count` of five rays, in slots that aren't their items.
    test::StageBench traced(uint32_t capacity, uint32_t count) {
        test::StageBench bench(device(), square(), test::picture(8, 8), capacity);
        const V3f down(0, 0, -1);
        const V3f origins[] = {
            {0.75f, 0.25f, 2}, {0.25f, 0.75f, 1}, {-1, 0, 1}, {2.25f, 0.25f, 1}, {0.5f, 0.25f, 8}};
        for (uint32_t i = 0; i < 5; ++i)
            bench.set_ray(i, 4 - i, origins[i], down);
        bench.run_trace(count, GetParam());
        return bench;
    }
};

void expect_hit(test::StageBench& bench, uint32_t item, uint32_t primitive, const V3f& t_u_v) {
    const f32x4 hit = bench.rays().at(RAY_HIT, item);
    EXPECT_EQ(test::bits(hit.w), primitive) << "ray " << item;
    EXPECT_EQ(test::xyz_of(hit), t_u_v) << "ray " << item;
}

INSTANTIATE_TEST_SUITE_P(Depths, TraceStage, testing::Values(0u, 1u));

TEST_P(TraceStage, WritesHitsOfAnExactlyFullQueue) {
    test::StageBench bench = traced(5, 5);
    expect_hit(bench, 0, 0, {2, 0.5f, 0.25f});
    expect_hit(bench, 1, 1, {1, 0.25f, 0.5f});
    expect_hit(bench, 3, 2, {4, 0.25f, 0.25f});
    expect_hit(bench, 4, 0, {8, 0.25f, 0.25f});
    EXPECT_EQ(test::bits(bench.rays().at(RAY_HIT, 2).w), NO_PRIMITIVE);
    EXPECT_EQ(bench.rays().at(RAY_HIT, 2).x, std::numeric_limits<float>::infinity());
    for (uint32_t i = 0; i < 5; ++i) {
        EXPECT_EQ(test::bits(bench.rays().at(RAY_ORIGIN, i).w), 4 - i) << "the ray's slot stays";
        EXPECT_EQ(test::xyz_of(bench.rays().at(RAY_DIRECTION, i)), V3f(0, 0, -1));
    }
    EXPECT_TRUE(bench.guards_untouched());
    EXPECT_EQ(bench.counters, (std::array<uint32_t, STATUS_WORDS>{}));
}

TEST_P(TraceStage, LeavesItemsBeyondTheCountAlone) {
    test::StageBench bench = traced(7, 3);
    for (uint32_t i = 0; i < 3; ++i)
        EXPECT_FALSE(bench.rays().untouched(RAY_HIT, i));
    for (uint32_t i = 3; i < 7; ++i)
        EXPECT_TRUE(bench.rays().untouched(RAY_HIT, i)) << "item " << i;
}

// A tree in which every child of a node is the next node needs more stack than there is, in whatever order it is
// visited. The builder never makes one.
TEST_P(TraceStage, TooSmallStackIsReported) {
    Bvh bvh;
    constexpr uint32_t LEVELS = 40;
    for (uint32_t level = 0; level < LEVELS; ++level) {
        BvhNode node = empty_node();
        const uint32_t next = level + 1 < LEVELS ? level + 1 : leaf_reference(0, 1);
        for (size_t child = 0; child < BVH_WIDTH; ++child)
            set_child(node, child, {V3f(-1), V3f(1)}, next);
        bvh.nodes.push_back(node);
    }
    bvh.blocks.push_back(empty_block());
    test::StageBench bench(device(), square(), test::picture(8, 8), 2);
    bench.replace_bvh(bvh);
    bench.set_ray(0, 0, {0, 0, 3}, {1, 0, 0});
    bench.set_ray(1, 0, {0, 0, 3}, {0, 0, -1});
    bench.run_trace(1, GetParam());
    EXPECT_EQ(bench.counters[STATUS_CODE], STATUS_OK) << "the ray misses the root";
    bench.run_trace(2, GetParam());
    EXPECT_EQ(bench.counters[STATUS_CODE], STATUS_STACK_OVERFLOW);
    EXPECT_EQ(bench.counters[STATUS_ITEM], 1U);
    EXPECT_EQ(bench.counters[STATUS_STAGE], STAGE_TRACE);
}

}  // namespace
}  // namespace obscura
