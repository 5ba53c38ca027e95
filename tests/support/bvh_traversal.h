// SPDX-License-Identifier: Apache-2.0
// A plain traversal of the device's BVH in double: what any correct kernel must find in it. It visits
// children nearest first, pushes all others that are hit, and counts what it does.
#pragma once

#include "bvh/bvh.h"
#include "bvh/layout.h"
#include "reference/brute_force.h"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace obscura::test {

struct TraversalCounts {
    uint64_t nodes = 0;
    uint64_t blocks = 0;
    uint32_t stack_entries = 0;  // the most that were pending at once, with the one taken next
};

struct TraversalEntry {
    double t;  // where the ray enters the child's box
    uint32_t reference;
};

// Slab test in double, planes chosen by the direction's sign, widened by a few ulps of double so that a ray
// in a box's face counts as inside. Returns the entry distance, infinity for a miss.
inline double enter_box(const BruteRay& ray, const V3d& inverse, const Box3f& box, double t_max) {
    constexpr double WIDER = 1 + 1e-14;
    double enter = 0;
    double leave = t_max;
    for (int axis = 0; axis < 3; ++axis) {
        const auto lower = static_cast<double>(box.min[axis]);
        const auto upper = static_cast<double>(box.max[axis]);
        if (ray.direction[axis] == 0) {
            if (ray.origin[axis] < lower || ray.origin[axis] > upper)
                return std::numeric_limits<double>::infinity();
            continue;
        }
        const bool backwards = ray.direction[axis] < 0;
        enter = std::max(enter, ((backwards ? upper : lower) - ray.origin[axis]) * inverse[axis]);
        leave = std::min(leave, ((backwards ? lower : upper) - ray.origin[axis]) * inverse[axis] * WIDER);
    }
    return enter <= leave ? enter : std::numeric_limits<double>::infinity();
}

// The closest hit by (t, primitive); t = t_max and NO_PRIMITIVE for a miss.
inline BruteHit traverse_closest(const Bvh& bvh, const BruteRay& ray, double t_max, TraversalCounts& counts) {
    const V3d inverse(1 / ray.direction.x, 1 / ray.direction.y, 1 / ray.direction.z);
    BruteHit best;
    best.t = t_max;
    std::vector<TraversalEntry> stack{{0, 0}};
    while (!stack.empty()) {
        counts.stack_entries = std::max(counts.stack_entries, static_cast<uint32_t>(stack.size()));
        const TraversalEntry entry = stack.back();
        stack.pop_back();
        if (entry.t > best.t) continue;
        if (is_leaf_reference(entry.reference)) {
            const uint32_t first = leaf_first_block(entry.reference);
            for (uint32_t i = first; i < first + leaf_block_count(entry.reference); ++i) {
                ++counts.blocks;
                for (size_t slot = 0; slot < BLOCK_WIDTH; ++slot) {
                    const uint32_t primitive = block_primitive(bvh.blocks[i], slot);
                    if (primitive == NO_PRIMITIVE) continue;
                    const BruteHit hit = intersect(ray, block_triangle(bvh.blocks[i], slot), primitive);
                    if (hit.inside() && hit.t > 0 && hit.t <= t_max && nearer(hit, best)) best = hit;
                }
            }
            continue;
        }
        ++counts.nodes;
        const BvhNode& node = bvh.nodes[entry.reference];
        const size_t below = stack.size();
        for (size_t child = 0; child < BVH_WIDTH; ++child) {
            if (child_reference(node, child) == BVH_EMPTY_CHILD) continue;
            const double t = enter_box(ray, inverse, child_bounds(node, child), best.t);
            if (t <= best.t && t < std::numeric_limits<double>::infinity())
                stack.push_back({t, child_reference(node, child)});
        }
        std::sort(stack.begin() + static_cast<std::ptrdiff_t>(below), stack.end(),
                  [](const TraversalEntry& a, const TraversalEntry& b) { return a.t > b.t; });
    }
    return best;
}

}  // namespace obscura::test
