// SPDX-License-Identifier: Apache-2.0
// Counted visits: those of trees whose visits can be counted by hand.
#include "bvh/bvh.h"
#include "bvh/layout.h"
#include "reference/ray_capture.h"
#include "support/device.h"

#include <limits>
#include <vector>

namespace obscura {
namespace {

constexpr float FAR = std::numeric_limits<float>::infinity();

// Three triangles one behind the other along -z, each in a leaf of its own; the farthest one under a second node.
Bvh three_leaves() {
    Bvh bvh;
    bvh.nodes = {empty_node(), empty_node()};
    for (uint32_t i = 0; i < 3; ++i) {
        const float z = -static_cast<float>(i);
        TriangleBlock block = empty_block();
        set_triangle(block, 0, i, {V3f(-1, -1, z), V3f(1, -1, z), V3f(0, 1, z)});
        bvh.blocks.push_back(block);
        const Box3f bounds(V3f(-1, -1, z), V3f(1, 1, z));
        set_child(bvh.nodes[0], i, bounds, i < 2 ? leaf_reference(i, 1) : 1);
        if (i == 2) set_child(bvh.nodes[1], 0, bounds, leaf_reference(i, 1));
    }
    return bvh;
}

class VisitCounterTest : public test::DeviceTest {
  protected:
    Visits count(const TraceRay& ray, bool any_hit) {
        ProgramLibrary library(device());
        return VisitCounter(device(), library, three_leaves()).count({&ray, 1}, any_hit);
    }
};

void expect_visits(const Visits& visits, uint64_t hits, uint64_t nodes, uint64_t blocks, uint32_t stack) {
    EXPECT_EQ(visits.rays, 1U);
    EXPECT_EQ(visits.hits, hits);
    EXPECT_EQ(visits.nodes, nodes);
    EXPECT_EQ(visits.blocks, blocks);
    EXPECT_EQ(visits.stack_entries, stack);
}

TEST_F(VisitCounterTest, MissOfTheRootVisitsItAlone) {
    expect_visits(count({{5, 5, 5}, {0, 0, -1}, FAR}, false), 0, 1, 0, 0);
}

TEST_F(VisitCounterTest, NearestHitLeavesTheRestOnTheStack) {
    expect_visits(count({{0, 0, 1}, {0, 0, -1}, FAR}, false), 1, 1, 1, 2);
}

// Through the corner of the boxes, beside all triangles.
TEST_F(VisitCounterTest, RayThroughAllBoxesVisitsEverything) {
    expect_visits(count({{0.9f, 0.9f, 1}, {0, 0, -1}, FAR}, false), 0, 2, 3, 2);
    expect_visits(count({{0.9f, 0.9f, 1}, {0, 0, -1}, FAR}, true), 0, 2, 3, 2);
}

TEST_F(VisitCounterTest, ReachCutsVisitsOff) {
    expect_visits(count({{0.9f, 0.9f, 1}, {0, 0, -1}, 1.5f}, false), 0, 1, 1, 0);
}

TEST_F(VisitCounterTest, SumsUpItsRays) {
    ProgramLibrary library(device());
    const VisitCounter counter(device(), library, three_leaves());
    const std::vector<TraceRay> rays{{{5, 5, 5}, {0, 0, -1}, FAR}, {{0, 0, 1}, {0, 0, -1}, FAR}};
    const Visits visits = counter.count(rays, false);
    EXPECT_EQ(visits.rays, 2U);
    EXPECT_EQ(visits.hits, 1U);
    EXPECT_EQ(visits.nodes, 2U);
    EXPECT_EQ(visits.stack_entries, 2U);
    EXPECT_EQ(counter.count({}, false).rays, 0U);
}

}  // namespace
}  // namespace obscura
