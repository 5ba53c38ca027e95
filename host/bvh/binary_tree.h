// SPDX-License-Identifier: Apache-2.0
// The binary tree that the wide BVH is cut out of: one reference per leaf, nodes and references in
// depth-first order, so that every subtree owns one contiguous run of both. A reference is a triangle, or
// with spatial splits the part of one inside a box; the parts of a triangle together cover it.
#pragma once

#include "bvh/bvh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace obscura {

struct Reference {
    Box3f bounds;  // of the part; rounded outward where a split plane cut it
    uint32_t triangle;
};

struct BinaryNode {
    Box3f bounds;        // union of its references' bounds
    uint32_t first = 0;  // its references: first .. first + count - 1
    uint32_t count = 0;
    uint32_t second_child = 0;  // the first child is the next node; 0 for a leaf
};

struct BinaryTree {
    std::vector<BinaryNode> nodes;  // nodes[0] is the root; empty for an empty scene
    std::vector<Reference> references;
};

// The deepest tree that is accepted, in nodes below the root: even as a binary tree it fits the device's
// stack.
constexpr uint32_t MAX_BINARY_DEPTH = BVH_STACK_SIZE - 2;

// Through rtcBuildBVH. Deterministic: the same scene gives the same tree for any number of threads. An empty
// tree for a scene with triangles means that the builder hit its depth limit (clusters within clusters).
BinaryTree build_binary_tree(const Scene& scene, BvhQuality quality);

// Median of the centers along the widest axis, by index where they are equal: the depth is log2 of the number
// of triangles whatever the scene.
BinaryTree build_median_tree(const Scene& scene);

// The nodes of a tree over so many references, one per leaf.
inline uint32_t node_count(uint32_t references) {
    return 2 * references - 1;
}

// Orders the references first .. first + count - 1 and fills their nodes, without bounds, from the given one on. Tries
// every cut of each set: for small ones. Subtrees share nothing, so several may be filled at once.
void fill_swept_subtree(BinaryTree& tree, uint32_t node, uint32_t first, uint32_t count);
// All nodes' bounds from the references'.
void compute_bounds(BinaryTree& tree);

using Vertices = std::array<V3f, 3>;
Vertices triangle_vertices(const Scene& scene, uint32_t triangle);
std::vector<Vertices> all_vertices(const Scene& scene);
Box3f bounds_of(const Vertices& vertices);

// Half the surface: areas are only compared with each other. Double: float squares under- and overflow.
inline double half_area(const Box3f& box) {
    const V3d size = V3d(box.max) - V3d(box.min);
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

// Blocks that hold so many triangles.
inline uint32_t block_count(size_t triangles) {
    return static_cast<uint32_t>((triangles + BLOCK_WIDTH - 1) / BLOCK_WIDTH);
}

}  // namespace obscura
