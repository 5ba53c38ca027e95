// SPDX-License-Identifier: Apache-2.0
// A finished binary tree made better: subtrees are taken out and put back where all boxes together grow least (Bittner, Hapala,
// Havran 2013, "Fast Insertion-Based Optimization of Bounding Volume Hierarchies"). A builder cuts from the top and never sees
// what its first cuts cost further down.
#pragma once

#include "bvh/binary_tree.h"

namespace obscura {

// The order of the moves depends on the tree alone. The tree stays as it was where it would become more than max_depth nodes
// deep below its root.
void reinsert_subtrees(BinaryTree& tree, uint32_t max_depth);

}  // namespace obscura
