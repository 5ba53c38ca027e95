// SPDX-License-Identifier: Apache-2.0
// The wide BVH: its structure on ordinary and on hostile meshes, its determinism, and that a plain
// traversal of it finds what testing every triangle finds.
#include "bvh/bvh.h"

#include "bvh/binary_tree.h"
#include "bvh/clip.h"
#include "bvh/collapse.h"
#include "bvh/layout.h"
#include "bvh/split_bounds.h"
#include "reference/brute_force.h"
#include "reference/hard_rays.h"
#include "reference/meshes.h"
#include "support/bvh_traversal.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cstring>
#include <random>

namespace obscura {
namespace {

using test::TraversalCounts;

constexpr BvhQuality QUALITIES[] = {BvhQuality::low, BvhQuality::medium, BvhQuality::high};

struct NamedScene {
    const char* name;
    Scene scene;
};

std::vector<NamedScene> all_scenes() {
    std::vector<NamedScene> scenes;
    scenes.push_back({"icosphere", icosphere(4)});
    scenes.push_back({"far from the origin", icosphere(3, 1, V3f(1e5F, -1e5F, 1e5F))});
    scenes.push_back({"soup", triangle_soup(1500, 0.1F, 1, 1)});
    scenes.push_back({"slivers", triangle_soup(1500, 1, 1e-4F, 2)});
    scenes.push_back({"grid", flat_grid(40)});
    scenes.push_back({"one triangle", identical_triangles(1)});
    scenes.push_back({"two triangles", identical_triangles(2)});
    scenes.push_back({"125 identical triangles", identical_triangles(125)});
    scenes.push_back({"nested scales", nested_scales(100)});
    scenes.push_back({"slowly nested scales", nested_scales(600, 0.9F)});
    scenes.push_back({"no triangles", Scene()});
    return scenes;
}

bool same_bits(const Bvh& a, const Bvh& b) {
    return a.nodes.size() == b.nodes.size() && a.blocks.size() == b.blocks.size() &&
           std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(BvhNode)) == 0 &&
           std::memcmp(a.blocks.data(), b.blocks.data(), a.blocks.size() * sizeof(TriangleBlock)) == 0;
}

// Every ray's closest hit in the tree equals the oracle's to the last bit: both intersect in the same way.
void expect_same_hits(const Bvh& bvh, const Scene& scene, const std::vector<TraceRay>& rays) {
    const BruteForce oracle(scene);
    const std::vector<BruteHit> expected = oracle.closest(rays);
    for (size_t i = 0; i < rays.size(); ++i) {
        TraversalCounts counts;
        const BruteHit found =
            test::traverse_closest(bvh, brute_ray(rays[i]), static_cast<double>(rays[i].t_max), counts);
        ASSERT_EQ(found.primitive, expected[i].primitive) << "ray " << i;
        ASSERT_EQ(found.t, expected[i].t) << "ray " << i;
        ASSERT_LE(counts.stack_entries, bvh.stack_entries) << "ray " << i;
    }
}

TEST(Bvh, StructureHoldsForEveryMeshAndQuality) {
    for (const NamedScene& named : all_scenes())
        for (const BvhQuality quality : QUALITIES)
            EXPECT_EQ(check_bvh(build_bvh(named.scene, quality), named.scene), "")
                << named.name << ", quality " << static_cast<int>(quality);
}

TEST(Bvh, FindsWhatBruteForceFinds) {
    for (const NamedScene& named : all_scenes()) {
        for (const BvhQuality quality : QUALITIES) {
            SCOPED_TRACE(named.name);
            const Bvh bvh = build_bvh(named.scene, quality);
            expect_same_hits(bvh, named.scene, random_rays(named.scene, 300, 1));
            expect_same_hits(bvh, named.scene, edge_rays(named.scene, 300, 2));
            expect_same_hits(bvh, named.scene, vertex_rays(named.scene, 100, 3));
            expect_same_hits(bvh, named.scene, axis_rays(named.scene, 300, 4));
        }
    }
}

TEST(Bvh, EmptySceneHasOneEmptyNode) {
    const Bvh bvh = build_bvh(Scene());
    ASSERT_EQ(bvh.nodes.size(), 1U);
    EXPECT_TRUE(bvh.blocks.empty());
    EXPECT_LE(bvh.stack_entries, static_cast<uint32_t>(BVH_STACK_SIZE));
    for (size_t child = 0; child < BVH_WIDTH; ++child)
        EXPECT_EQ(child_reference(bvh.nodes[0], child), BVH_EMPTY_CHILD);
}

TEST(Bvh, HundredThousandIdenticalTrianglesFit) {
    const Scene scene = identical_triangles(100000);
    for (const BvhQuality quality : QUALITIES) {
        const Bvh bvh = build_bvh(scene, quality);
        EXPECT_EQ(check_bvh(bvh, scene), "");
        TraversalCounts counts;
        const TraceRay ray{V3f(0.25F, 0.25F, 5), V3f(0, 0, -1), 10};
        EXPECT_EQ(test::traverse_closest(bvh, brute_ray(ray), 10, counts).primitive, 0U);
    }
}

TEST(Bvh, SameBitsForAnyNumberOfThreads) {
    for (const Scene& scene : {icosphere(5), triangle_soup(5000, 0.3F, 1e-3F, 3)}) {
        for (const BvhQuality quality : QUALITIES) {
            const Bvh first = build_bvh(scene, quality);
            const tbb::global_control control(tbb::global_control::max_allowed_parallelism, 7);
            for (const int threads : {1, 7}) {
                tbb::task_arena arena(threads);
                const Bvh again = arena.execute([&] { return build_bvh(scene, quality); });
                EXPECT_TRUE(same_bits(first, again)) << threads << " threads";
            }
        }
    }
}

TEST(Bvh, BlocksOfMeshesAreMoreThanThreeQuartersFull) {
    for (const Scene& scene : {icosphere(5), flat_grid(80)})
        for (const BvhQuality quality : QUALITIES)
            EXPECT_GT(measure_bvh(build_bvh(scene, quality)).block_fill, 3.0);
}

TEST(Bvh, BetterQualityCostsLess) {
    const Scene scene = triangle_soup(10000, 0.5F, 1e-3F, 5);
    const double low = measure_bvh(build_bvh(scene, BvhQuality::low)).sah_cost;
    const double medium = measure_bvh(build_bvh(scene, BvhQuality::medium)).sah_cost;
    const double high = measure_bvh(build_bvh(scene, BvhQuality::high)).sah_cost;
    EXPECT_LT(medium, low);
    EXPECT_LT(high, 0.9 * medium);  // long slivers are what spatial splits are for
}

TEST(Bvh, FourTrianglesAreOneFullBlock) {
    const Bvh bvh = build_bvh(identical_triangles(4));
    ASSERT_EQ(bvh.blocks.size(), 1U);
    for (size_t slot = 0; slot < BLOCK_WIDTH; ++slot)
        EXPECT_EQ(block_primitive(bvh.blocks[0], slot), slot);
}

TEST(Bvh, PanesAreMarked) {
    Scene scene = identical_triangles(4);
    scene.materials.emplace_back().transmission = 0.5f;
    scene.triangles[2].material = 1;
    Bvh bvh = build_bvh(scene);
    for (size_t slot = 0; slot < BLOCK_WIDTH; ++slot) {
        EXPECT_EQ(block_primitive(bvh.blocks[0], slot), slot);
        EXPECT_EQ(is_pane_slot(bvh.blocks[0], slot), slot == 2);
    }
    EXPECT_TRUE(check_bvh(bvh, scene).empty());
    scene.triangles[1].material = 1;
    EXPECT_FALSE(check_bvh(bvh, scene).empty());
}

TEST(Bvh, PowerOfTwoScaleGivesTheSameTree) {
    Scene scene = triangle_soup(2000, 0.2F, 0.1F, 6);
    const Bvh original = build_bvh(scene);
    for (Vertex& vertex : scene.vertices)
        vertex.position *= 0x1p-20F;
    const Bvh scaled = build_bvh(scene);
    ASSERT_EQ(scaled.nodes.size(), original.nodes.size());
    for (size_t i = 0; i < original.nodes.size(); ++i) {
        for (size_t child = 0; child < BVH_WIDTH; ++child) {
            ASSERT_EQ(child_reference(scaled.nodes[i], child), child_reference(original.nodes[i], child));
            if (child_reference(original.nodes[i], child) == BVH_EMPTY_CHILD) continue;
            ASSERT_EQ(child_bounds(scaled.nodes[i], child).min,
                      child_bounds(original.nodes[i], child).min * 0x1p-20F);
        }
    }
}

TEST(Collapse, NarrowerNodesNeedLessStack) {
    const Scene scene = triangle_soup(5000, 0.1F, 1, 7);
    const BinaryTree tree = build_binary_tree(scene, BvhQuality::medium);
    uint32_t needed = collapse(tree, scene, BVH_WIDTH).stack_entries;
    for (const uint32_t width : {6U, 4U, 2U}) {
        const Bvh bvh = collapse(tree, scene, width);
        EXPECT_EQ(check_bvh(bvh, scene), "");
        EXPECT_LT(bvh.stack_entries, needed);
        needed = bvh.stack_entries;
    }
}

// Both ways out of trees that are too deep: narrower nodes, and the median where Embree's builder gives up.
TEST(Bvh, ClustersWithinClustersFitTheStack) {
    const Scene scene = nested_clusters(300);
    EXPECT_TRUE(build_binary_tree(scene, BvhQuality::low).nodes.empty());
    const BinaryTree deep = build_binary_tree(scene, BvhQuality::medium);
    EXPECT_GT(collapse(deep, scene, BVH_WIDTH).stack_entries, static_cast<uint32_t>(BVH_STACK_SIZE));
    for (const BvhQuality quality : QUALITIES)
        EXPECT_EQ(check_bvh(build_bvh(scene, quality), scene), "");
}

TEST(Collapse, MedianTreeHoldsForEveryMesh) {
    for (const NamedScene& named : all_scenes())
        EXPECT_EQ(check_bvh(collapse(build_median_tree(named.scene), named.scene, BVH_WIDTH), named.scene),
                  "")
            << named.name;
}

// Each corruption of a good tree is found.
TEST(CheckBvh, FindsEachKindOfDamage) {
    const Scene scene = icosphere(3);
    const Bvh good = build_bvh(scene);
    const auto damaged = [&](const auto& damage) {
        Bvh bvh = good;
        damage(bvh);
        return check_bvh(bvh, scene);
    };
    EXPECT_EQ(damaged([](Bvh&) {}), "");
    EXPECT_NE(damaged([](Bvh& bvh) { plane(bvh.nodes.back(), 3, 0) -= 1e-6F; }), "");
    EXPECT_NE(damaged([](Bvh& bvh) { plane(bvh.nodes.back(), 0, 0) -= 10; }), "");
    EXPECT_NE(damaged([](Bvh& bvh) {
                  child_reference(bvh.nodes.back(), 1) = child_reference(bvh.nodes.back(), 0);
              }),
              "");
    EXPECT_NE(damaged([](Bvh& bvh) { child_reference(bvh.nodes[0], 0) = BVH_EMPTY_CHILD; }), "");
    EXPECT_NE(damaged([](Bvh& bvh) { bvh.blocks[0].primitive.x = bvh.blocks[1].primitive.x; }), "");
    EXPECT_NE(damaged([](Bvh& bvh) { bvh.blocks[0].vertex[0].x += 1e-6F; }), "");
    EXPECT_NE(damaged([](Bvh& bvh) { bvh.blocks.push_back(empty_block()); }), "");
    EXPECT_NE(damaged([](Bvh& bvh) { bvh.nodes.push_back(empty_node()); }), "");
    EXPECT_NE(damaged([](Bvh& bvh) { ++bvh.depth; }), "");
    EXPECT_NE(damaged([](Bvh& bvh) { --bvh.stack_entries; }), "");
}

TEST(CheckBvh, FindsAGapBetweenThePartsOfASplitTriangle) {
    const Scene scene = triangle_soup(2000, 1, 1e-3F, 8);
    Bvh bvh = build_bvh(scene);
    ASSERT_GT(measure_bvh(bvh).references, scene.triangles.size());
    ASSERT_EQ(check_bvh(bvh, scene), "");
    // Shrinking any leaf's box by a hundredth must uncover part of a triangle.
    for (BvhNode& node : bvh.nodes) {
        if (!is_leaf_reference(child_reference(node, 0))) continue;
        const Box3f box = child_bounds(node, 0);
        const auto axis = static_cast<size_t>(box.majorAxis());
        plane(node, axis, 0) += 0.01F * box.size()[static_cast<int>(axis)];
        break;
    }
    EXPECT_NE(check_bvh(bvh, scene), "");
}

TEST(Clip, PartsHoldExactPointsOfTheTriangle) {
    std::mt19937 random(9);
    std::uniform_real_distribution<float> both(-1, 1);
    std::uniform_real_distribution<double> unit(0, 1);
    const auto point = [&] { return V3f{both(random), both(random), both(random)}; };
    for (int repeat = 0; repeat < 2000; ++repeat) {
        const Vertices triangle{point(), point(), point()};
        const int axis = repeat % 3;
        const float position = 0.5F * both(random);
        const Box3f whole = bounds_of(triangle);
        const SplitBounds quick = split_bounds(triangle, whole, axis, position);
        Box3f cell = whole;
        cell.max[axis] = std::min(cell.max[axis], position);
        const Box3f tight = cell.max[axis] < cell.min[axis] ? Box3f() : clipped_bounds(triangle, cell);
        for (int sample = 0; sample < 50; ++sample) {
            const double u = unit(random);
            const double v = unit(random) * (1 - u);
            const V3d p = V3d(triangle[0]) * (1 - u - v) + V3d(triangle[1]) * u + V3d(triangle[2]) * v;
            const bool below = p[axis] <= static_cast<double>(position);
            const Box3f& side = below ? quick.below : quick.above;
            ASSERT_TRUE(Box3d(V3d(side.min), V3d(side.max)).intersects(p));
            if (below) {
                ASSERT_TRUE(Box3d(V3d(tight.min), V3d(tight.max)).intersects(p));
            }
        }
    }
}

TEST(Clip, PlaneCutsPolygonNotOnlyBox) {
    // The diagonal triangle's part below x = 0.5 ends at y = 0.5, although its box reaches 1.
    const Vertices triangle{V3f(0, 0, 0), V3f(1, 1, 0), V3f(1, 0.999F, 0)};
    const SplitBounds parts = split_bounds(triangle, bounds_of(triangle), 0, 0.5F);
    EXPECT_NEAR(parts.below.max.y, 0.5F, 1e-6F);
    EXPECT_GE(parts.below.max.y, 0.5F);
    EXPECT_EQ(parts.below.max.x, 0.5F);
    EXPECT_EQ(parts.above.min.x, 0.5F);
    EXPECT_NEAR(parts.above.min.y, 0.4995F, 1e-6F);
}

// Corners below, in and above the plane in every combination, beside the polygon that the plane cuts exactly.
TEST(Clip, QuickBoundsAreThoseOfThePolygonWhereverTheCornersLie) {
    const auto near = [](const Box3f& found, const Polygon& part) {
        Box3f exact;
        for (int i = 0; i < part.count; ++i)
            exact.extendBy(V3f(part.corner[static_cast<size_t>(i)]));
        if (exact.isEmpty() || found.isEmpty()) return exact.isEmpty() == found.isEmpty();
        return found.min.equalWithAbsError(exact.min, 1e-6F) && found.max.equalWithAbsError(exact.max, 1e-6F);
    };
    for (int combination = 0; combination < 81; ++combination) {
        const int axis = combination % 3;
        Vertices triangle{V3f(0.3F, 0.1F, 0.9F), V3f(0.7F, 0.8F, 0.2F), V3f(0.5F, 0.4F, 0.6F)};
        for (int i = 0, rest = combination / 3; i < 3; ++i, rest /= 3)
            triangle[static_cast<size_t>(i)][axis] = 0.25F * static_cast<float>(rest % 3 - 1) + 0.5F;
        const SplitBounds found = split_bounds(triangle, bounds_of(triangle), axis, 0.5F);
        const Polygon whole(triangle);
        EXPECT_TRUE(near(found.below, clip(whole, axis, 0.5, Side::below))) << combination;
        EXPECT_TRUE(near(found.above, clip(whole, axis, 0.5, Side::above))) << combination;
    }
}

TEST(Clip, CellWithoutTriangleIsEmpty) {
    const Vertices triangle{V3f(0, 0, 0), V3f(1, 0, 0), V3f(0, 1, 0)};
    EXPECT_TRUE(clipped_bounds(triangle, Box3f(V3f(0.9F, 0.9F, 0), V3f(1, 1, 0))).isEmpty());
    EXPECT_TRUE(split_bounds(triangle, bounds_of(triangle), 0, 2).above.isEmpty());
}

}  // namespace
}  // namespace obscura
