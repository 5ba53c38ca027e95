// SPDX-License-Identifier: Apache-2.0
// Reading and writing single children and triangles of the device's nodes and blocks, whose members are rows
// of four lanes. For the builder, the checker and tests; kernels read whole rows.
#pragma once

#include "base/math.h"
#include "shared/bvh.h"

#include <array>
#include <cstddef>
#include <limits>

namespace obscura {

inline constexpr float f32x4::*F32_LANES[4] = {&f32x4::x, &f32x4::y, &f32x4::z, &f32x4::w};
inline constexpr uint32_t u32x4::*U32_LANES[4] = {&u32x4::x, &u32x4::y, &u32x4::z, &u32x4::w};

// Plane 0..5 (lower x, y, z, upper x, y, z) of child 0..7.
inline float& plane(BvhNode& node, size_t plane_index, size_t child) {
    return node.bounds[2 * plane_index + child / 4].*F32_LANES[child % 4];
}
inline float plane(const BvhNode& node, size_t plane_index, size_t child) {
    return node.bounds[2 * plane_index + child / 4].*F32_LANES[child % 4];
}

inline uint32_t& child_reference(BvhNode& node, size_t child) {
    return node.child[child / 4].*U32_LANES[child % 4];
}
inline uint32_t child_reference(const BvhNode& node, size_t child) {
    return node.child[child / 4].*U32_LANES[child % 4];
}

inline Box3f child_bounds(const BvhNode& node, size_t child) {
    return {V3f(plane(node, 0, child), plane(node, 1, child), plane(node, 2, child)),
            V3f(plane(node, 3, child), plane(node, 4, child), plane(node, 5, child))};
}

inline void set_child(BvhNode& node, size_t child, const Box3f& bounds, uint32_t reference) {
    for (int axis = 0; axis < 3; ++axis) {
        plane(node, static_cast<size_t>(axis), child) = bounds.min[axis];
        plane(node, static_cast<size_t>(axis) + 3, child) = bounds.max[axis];
    }
    child_reference(node, child) = reference;
}

// A node without children: no ray hits bounds that are inside out.
inline BvhNode empty_node() {
    constexpr float INFINITE = std::numeric_limits<float>::infinity();
    const Box3f nothing(V3f(INFINITE, INFINITE, INFINITE), V3f(-INFINITE, -INFINITE, -INFINITE));
    BvhNode node;
    for (size_t child = 0; child < BVH_WIDTH; ++child)
        set_child(node, child, nothing, BVH_EMPTY_CHILD);
    return node;
}

// The empty child has the leaf bit too: test for it first.
inline bool is_leaf_reference(uint32_t reference) {
    return (reference & BVH_LEAF_BIT) != 0;
}
inline uint32_t leaf_first_block(uint32_t reference) {
    return reference & BVH_LEAF_INDEX_MASK;
}
inline uint32_t leaf_block_count(uint32_t reference) {
    return (reference >> BVH_LEAF_COUNT_SHIFT) & BVH_LEAF_COUNT_MASK;
}
inline uint32_t leaf_reference(uint32_t first_block, uint32_t block_count) {
    return BVH_LEAF_BIT | block_count << BVH_LEAF_COUNT_SHIFT | first_block;
}

inline TriangleBlock empty_block() {
    TriangleBlock block{};
    for (const auto lane : U32_LANES)
        block.primitive.*lane = NO_PRIMITIVE;
    return block;
}

// NO_PRIMITIVE where the slot is empty.
inline uint32_t block_primitive(const TriangleBlock& block, size_t slot) {
    const uint32_t primitive = block.primitive.*U32_LANES[slot];
    return primitive == NO_PRIMITIVE ? NO_PRIMITIVE : primitive & ~PRIMITIVE_PANE;
}
inline bool is_pane_slot(const TriangleBlock& block, size_t slot) {
    const uint32_t primitive = block.primitive.*U32_LANES[slot];
    return primitive != NO_PRIMITIVE && (primitive & PRIMITIVE_PANE) != 0;
}

inline void set_triangle(TriangleBlock& block, size_t slot, uint32_t primitive,
                         const std::array<V3f, 3>& vertices, bool pane = false) {
    block.primitive.*U32_LANES[slot] = primitive | (pane ? PRIMITIVE_PANE : 0);
    for (size_t vertex = 0; vertex < 3; ++vertex)
        for (size_t axis = 0; axis < 3; ++axis)
            block.vertex[3 * vertex + axis].*F32_LANES[slot] = vertices[vertex][static_cast<int>(axis)];
}

inline std::array<V3f, 3> block_triangle(const TriangleBlock& block, size_t slot) {
    std::array<V3f, 3> vertices;
    for (size_t vertex = 0; vertex < 3; ++vertex)
        for (size_t axis = 0; axis < 3; ++axis)
            vertices[vertex][static_cast<int>(axis)] = block.vertex[3 * vertex + axis].*F32_LANES[slot];
    return vertices;
}

}  // namespace obscura
