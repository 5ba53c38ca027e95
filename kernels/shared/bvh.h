// SPDX-License-Identifier: Apache-2.0
// The wide BVH as the device reads it: nodes of eight children, leaves of whole blocks of four triangles.
// Included by C++20 and OpenCL C.
#ifndef OBSCURA_SHARED_BVH_H
#define OBSCURA_SHARED_BVH_H

#include "shared/types.h"

#define BVH_WIDTH 8        // children per node
#define BLOCK_WIDTH 4      // triangles per leaf block
#define BVH_STACK_SIZE 96  // entries; the builder measures what a tree needs and refuses more

// A child reference: the node's index, or a leaf's first block with its number of blocks, or nothing.
#define BVH_LEAF_BIT 0x80000000u
#define BVH_LEAF_COUNT_SHIFT 26  // bits 26..30: blocks in the leaf, 1..31
#define BVH_LEAF_COUNT_MASK 31u
#define BVH_LEAF_INDEX_MASK 0x03ffffffu  // bits 0..25: index of the first block
#define BVH_EMPTY_CHILD 0xffffffffu  // also marked by bounds that no ray hits (lower = +inf, upper = -inf)

#define NO_PRIMITIVE 0xffffffffu  // an empty slot of a block; also the hit record of a miss
// Set beside a triangle's index, in a block and in what any-hit traversal finds, where light passes through it: shadow rays
// don't end there.
#define PRIMITIVE_PANE 0x80000000u

// What the kernel trace_rays (check.cl) is asked for: the nearest hit, what any-hit traversal finds, or the nearest hit of each
// ray alone, as behind panes.
#define RAY_QUERY_NEAREST 0u
#define RAY_QUERY_ANY 1u
#define RAY_QUERY_ALONE 2u

#ifdef __cplusplus
namespace obscura {
#endif

// 224 bytes. Planes of the children's boxes, scene units; one row of eight floats per plane, so that one
// eight-wide instruction handles one plane of all children.
typedef struct BvhNode {
    f32x4 bounds[12];  // rows of two: lower x, lower y, lower z, upper x, upper y, upper z
    u32x4 child[2];    // references of children 0..7
} BvhNode;

// 160 bytes. Four triangles, structure of arrays: row 3 * vertex + axis.
typedef struct TriangleBlock {
    f32x4 vertex[9];
    // Triangle indices in the scene, with PRIMITIVE_PANE; NO_PRIMITIVE = empty slot (vertices all zero).
    u32x4 primitive;
} TriangleBlock;

#ifdef __cplusplus
static_assert(sizeof(BvhNode) == 224 && sizeof(TriangleBlock) == 160, "device layout");
}  // namespace obscura
#endif

#endif
