// SPDX-License-Identifier: Apache-2.0
// Moved subtrees: the tree holds what it held, in the layout that the collapse reads, with smaller boxes, and no deeper than it
// may become.
#include "bvh/reinsertion.h"

#include "reference/meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace obscura {
namespace {

constexpr uint32_t ANY_DEPTH = 1000;

// But for small sets, which stay as they are.
double sum_of_areas(const BinaryTree& tree) {
    double sum = 0;
    for (const BinaryNode& node : tree.nodes)
        if (node.count >= 2 * BLOCK_WIDTH) sum += half_area(node.bounds);
    return sum;
}

std::vector<uint32_t> triangles_of(const BinaryTree& tree) {
    std::vector<uint32_t> triangles;
    triangles.reserve(tree.references.size());
    for (const Reference& reference : tree.references)
        triangles.push_back(reference.triangle);
    std::ranges::sort(triangles);
    return triangles;
}

// Nodes below this one; expects runs of nodes and references depth first, and the boxes of what they hold.
uint32_t expect_sound(const BinaryTree& tree, uint32_t i, uint32_t first) {
    const BinaryNode& node = tree.nodes[i];
    EXPECT_EQ(node.first, first);
    Box3f bounds;
    if (node.second_child == 0) {
        EXPECT_EQ(node.count, 1U);
        EXPECT_EQ(node.bounds, tree.references[first].bounds);
        return 0;
    }
    const uint32_t first_count = tree.nodes[i + 1].count;
    EXPECT_EQ(node.second_child, i + 1 + node_count(first_count));
    EXPECT_EQ(node.count, first_count + tree.nodes[node.second_child].count);
    const uint32_t depth = std::max(expect_sound(tree, i + 1, first),
                                    expect_sound(tree, node.second_child, first + first_count));
    bounds.extendBy(tree.nodes[i + 1].bounds);
    bounds.extendBy(tree.nodes[node.second_child].bounds);
    EXPECT_EQ(node.bounds, bounds);
    return depth + 1;
}

TEST(Reinsertion, TreeHoldsTheSameInSmallerBoxes) {
    for (const Scene& scene :
         {triangle_soup(3000, 0.1F, 1, 1), triangle_soup(3000, 1, 1e-4F, 2), icosphere(4)}) {
        const BinaryTree before = build_median_tree(scene);
        BinaryTree tree = before;
        reinsert_subtrees(tree, ANY_DEPTH);
        ASSERT_EQ(tree.nodes.size(), before.nodes.size());
        expect_sound(tree, 0, 0);
        EXPECT_EQ(triangles_of(tree), triangles_of(before));
        EXPECT_LT(sum_of_areas(tree), 0.999 * sum_of_areas(before));
    }
}

TEST(Reinsertion, SmallTreesStay) {
    for (const uint32_t count : {0U, 1U, 2U, 3U, 7U, 8U, 9U, 20U}) {
        const Scene scene = identical_triangles(count);
        BinaryTree tree = build_median_tree(scene);
        reinsert_subtrees(tree, ANY_DEPTH);
        ASSERT_EQ(tree.references.size(), count);
        if (count > 0) expect_sound(tree, 0, 0);
    }
}

TEST(Reinsertion, DepthIsKept) {
    const Scene scene = nested_scales(600, 0.9F);
    const BinaryTree before = build_median_tree(scene);
    const uint32_t depth = expect_sound(before, 0, 0);
    BinaryTree tree = before;
    reinsert_subtrees(tree, ANY_DEPTH);
    ASSERT_GT(expect_sound(tree, 0, 0), depth);
    tree = before;
    reinsert_subtrees(tree, depth);
    EXPECT_LE(expect_sound(tree, 0, 0), depth);
}

}  // namespace
}  // namespace obscura
