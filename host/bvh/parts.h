// SPDX-License-Identifier: Apache-2.0
// A large scene is cut into parts whose subtrees are built beside each other. The cut depends on the scene alone, not on the
// number of threads. Private to the builder.
#pragma once

#include "bvh/binary_tree.h"

#include <embree3/rtcore.h>

#include <span>
#include <vector>

namespace obscura {

// The most triangles in a part: few enough that the parts of a large scene keep all threads busy to the end, many enough that
// object splits cost nothing above them (three million triangles: 0.5 % of the SAH cost).
constexpr uint32_t MAX_PART_TRIANGLES = 1u << 16;

// The top of the tree, depth first: inner nodes and, as leaves, parts.
struct TopNode {
    uint32_t first = 0;  // of the primitives
    uint32_t count = 0;
    uint32_t depth = 0;         // nodes above it
    uint32_t second_child = 0;  // the first child is the next node; 0 for a part
};

// Orders the primitives so that each part owns a run of them.
std::vector<TopNode> cut_into_parts(std::span<RTCBuildPrimitive> primitives);

// Whether cutting triangles can make the subtree of a part better: it has triangles that are large beside it.
bool has_large_triangles(std::span<const RTCBuildPrimitive> part);

// One tree of the parts' own trees, which are in the order of top; nodes and references of each are contiguous in it.
BinaryTree join(const std::vector<TopNode>& top, std::span<const BinaryTree> parts);

}  // namespace obscura
