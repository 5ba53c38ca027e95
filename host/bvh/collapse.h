// SPDX-License-Identifier: Apache-2.0
// From the binary tree to the device's layout: which subtrees become wide nodes and which become leaves of
// whole blocks, at the least SAH cost, found by dynamic programming over the binary tree.
// After Ylitie, Karras, Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide
// BVHs", section 3; the cost of a leaf here counts blocks of four, not triangles.
#pragma once

#include "bvh/binary_tree.h"

namespace obscura {

// Costs of the surface area heuristic: testing a node's eight boxes, sorting and pushing what was hit, against
// testing a block of four triangles. On x86 the kitchen's obscurance rays take the same time for any node cost
// between 0.15 and 0.7; 1.5 is 5 % slower, 4 is 12 % (`obscura render scenes/kitchen --stats -`).
constexpr float NODE_COST = 0.7F;
constexpr float BLOCK_COST = 1.0F;

constexpr uint32_t MAX_LEAF_BLOCKS = BVH_LEAF_COUNT_MASK;
constexpr uint32_t MAX_LEAF_TRIANGLES = MAX_LEAF_BLOCKS * BLOCK_WIDTH;

// width: the most children per node, 2..BVH_WIDTH. Narrower nodes cost more and need less stack.
// Fills nodes, blocks, depth and stack_entries.
Bvh collapse(const BinaryTree& tree, const Scene& scene, uint32_t width);

}  // namespace obscura
