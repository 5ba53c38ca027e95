// SPDX-License-Identifier: Apache-2.0
// Scenes large enough to be built in parts: the joined tree is sound, the same for any number of threads, and parts of long
// triangles still have them cut.
#include "bvh/parts.h"
#include "reference/meshes.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cstring>

namespace obscura {
namespace {

constexpr uint32_t COUNT = 3 * MAX_PART_TRIANGLES;

bool same_bits(const Bvh& a, const Bvh& b) {
    return a.nodes.size() == b.nodes.size() && a.blocks.size() == b.blocks.size() &&
           std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(BvhNode)) == 0 &&
           std::memcmp(a.blocks.data(), b.blocks.data(), a.blocks.size() * sizeof(TriangleBlock)) == 0;
}

TEST(BvhParts, JoinedTreeIsSoundAndTheSameForAnyNumberOfThreads) {
    const Scene scene = triangle_soup(COUNT, 0.01F, 1, 1);
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, 7);
    const Bvh first = tbb::task_arena(1).execute([&] { return build_bvh(scene); });
    EXPECT_EQ(check_bvh(first, scene), "");
    const Bvh again = tbb::task_arena(7).execute([&] { return build_bvh(scene); });
    EXPECT_TRUE(same_bits(first, again));
}

TEST(BvhParts, LongTrianglesAreCutSmallOnesNot) {
    const Scene slivers = triangle_soup(MAX_PART_TRIANGLES + 1000, 0.5F, 1e-3F, 5);
    const Scene sphere = icosphere(7);
    ASSERT_GT(sphere.triangles.size(), MAX_PART_TRIANGLES);
    EXPECT_GT(measure_bvh(build_bvh(slivers)).references, 5 * slivers.triangles.size() / 4);
    EXPECT_EQ(measure_bvh(build_bvh(sphere)).references, sphere.triangles.size());
}

TEST(BvhParts, PartsOfOneSpotAreHalved) {
    std::vector<RTCBuildPrimitive> primitives(COUNT);
    for (uint32_t i = 0; i < COUNT; ++i)
        primitives[i].primID = i;
    uint32_t covered = 0;
    for (const TopNode& node : cut_into_parts(primitives)) {
        if (node.second_child != 0) continue;
        EXPECT_EQ(node.first, covered);
        EXPECT_LE(node.count, MAX_PART_TRIANGLES);
        EXPECT_GE(node.count, MAX_PART_TRIANGLES / 2);
        covered += node.count;
    }
    EXPECT_EQ(covered, COUNT);
}

}  // namespace
}  // namespace obscura
