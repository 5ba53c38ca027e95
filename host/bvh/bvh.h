// SPDX-License-Identifier: Apache-2.0
// Builds the device's wide BVH through Embree's builder (rtcBuildBVH: binned SAH), merges leaves into full
// blocks of four triangles, and checks the result.
#pragma once

#include "scene/scene.h"
#include "shared/bvh.h"

#include <cstdint>
#include <string>
#include <vector>

namespace obscura {

struct Bvh {
    std::vector<BvhNode> nodes;  // nodes[0] is the root; never empty (an empty scene has one empty node)
    std::vector<TriangleBlock> blocks;
    uint32_t depth = 0;          // nodes on the longest path
    uint32_t stack_entries = 0;  // the most a traversal can have pending; <= BVH_STACK_SIZE
    double build_seconds = 0;

    size_t bytes() const { return nodes.size() * sizeof(BvhNode) + blocks.size() * sizeof(TriangleBlock); }
};

// Morton; binned SAH; SAH with spatial splits, then subtrees moved to where they fit better.
enum class BvhQuality { low, medium, high };

// The same scene gives the same bits, whatever the number of threads.
Bvh build_bvh(const Scene& scene, BvhQuality quality = BvhQuality::high);

struct BvhStatistics {
    double sah_cost = 0;    // expected cost of a line through the root's box, in blocks of four triangles
    double block_fill = 0;  // triangles per block, 0..4
    double node_fill = 0;   // children per node, 0..8
    size_t leaves = 0;
    size_t references = 0;  // triangles in blocks; above the scene's number where spatial splits cut some
};
BvhStatistics measure_bvh(const Bvh& bvh);

// Structural check, for tests: every triangle of the scene in some block with its exact vertices, every box
// holding what is below it (the boxes of a triangle in several leaves cover it together), every node and
// block reached exactly once, blocks filled from the front, the depth and stack bound measured again. Returns
// the first violation as text, empty if there is none.
std::string check_bvh(const Bvh& bvh, const Scene& scene);

}  // namespace obscura
