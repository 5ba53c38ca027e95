// SPDX-License-Identifier: Apache-2.0
// build_bvh: binary tree, then wide tree. A tree that needs more stack than the device has is cut out of the
// same binary tree again with narrower nodes, where fewer siblings wait on each level.
#include "base/error.h"
#include "bvh/bvh.h"
#include "bvh/collapse.h"
#include "bvh/layout.h"

#include <chrono>

namespace obscura {
namespace {

Bvh widest_that_fits(const BinaryTree& tree, const Scene& scene) {
    for (uint32_t width = BVH_WIDTH; width > 2; --width) {
        Bvh bvh = collapse(tree, scene, width);
        if (bvh.stack_entries <= BVH_STACK_SIZE) return bvh;
    }
    return collapse(tree, scene, 2);
}

}  // namespace

Bvh build_bvh(const Scene& scene, BvhQuality quality) {
    const auto start = std::chrono::steady_clock::now();
    if (scene.triangles.size() >= BVH_LEAF_INDEX_MASK)
        throw InputError("{}: {} triangles are more than the {} that the renderer can address.", scene.name,
                         scene.triangles.size(), BVH_LEAF_INDEX_MASK);
    BinaryTree tree = build_binary_tree(scene, quality);
    if (tree.nodes.empty()) tree = build_median_tree(scene);
    Bvh bvh = widest_that_fits(tree, scene);
    OBSCURA_CHECK(bvh.stack_entries <= BVH_STACK_SIZE, "the tree needs {} stack entries, there are {}",
                  bvh.stack_entries, BVH_STACK_SIZE);
    OBSCURA_CHECK(bvh.blocks.size() < BVH_LEAF_INDEX_MASK, "{} blocks are too many for a leaf reference",
                  bvh.blocks.size());
    bvh.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return bvh;
}

BvhStatistics measure_bvh(const Bvh& bvh) {
    BvhStatistics result;
    Box3f root;
    for (size_t child = 0; child < BVH_WIDTH; ++child)
        if (child_reference(bvh.nodes[0], child) != BVH_EMPTY_CHILD)
            root.extendBy(child_bounds(bvh.nodes[0], child));
    if (root.isEmpty()) return result;

    size_t child_count = 0;
    double weighted = half_area(root) * static_cast<double>(NODE_COST);
    for (const BvhNode& node : bvh.nodes) {
        for (size_t child = 0; child < BVH_WIDTH; ++child) {
            const uint32_t reference = child_reference(node, child);
            if (reference == BVH_EMPTY_CHILD) continue;
            const bool leaf = is_leaf_reference(reference);
            const double cost = leaf ? static_cast<double>(BLOCK_COST) * leaf_block_count(reference)
                                     : static_cast<double>(NODE_COST);
            weighted += half_area(child_bounds(node, child)) * cost;
            result.leaves += leaf ? 1 : 0;
            ++child_count;
        }
    }
    for (const TriangleBlock& block : bvh.blocks)
        for (size_t slot = 0; slot < BLOCK_WIDTH; ++slot)
            result.references += block_primitive(block, slot) != NO_PRIMITIVE ? 1 : 0;
    result.sah_cost = weighted / half_area(root);
    result.block_fill = static_cast<double>(result.references) / static_cast<double>(bvh.blocks.size());
    result.node_fill = static_cast<double>(child_count) / static_cast<double>(bvh.nodes.size());
    return result;
}

}  // namespace obscura
