// SPDX-License-Identifier: Apache-2.0
// What a ray costs: the production traversal, built so that it counts its visits. For `obscura bench`, which never times
// this kernel.
#define COUNT_VISITS
#include "lib/traverse.clh"

// rays: origin with t_max, direction. any_hit: 1 = whether anything is hit, 0 = the nearest hit. Of each ray
//   counts  nodes, blocks, the most entries on its stack, 1 if it hit something
kernel void visits(global const BvhNode* nodes, global const TriangleBlock* blocks, global const float4* rays,
                   global uint4* counts, uint count, uint any_hit) {
    const uint i = (uint)get_global_id(0);
    if (i >= count) return;
    const float4 origin = rays[2u * i];
    const float3 direction = rays[2u * i + 1u].xyz;
    Hit hit;
    if (any_hit != 0u) {
        hit = traverse(nodes, blocks, origin.xyz, direction, origin.w, true);
    } else {
        hit = traverse(nodes, blocks, origin.xyz, direction, origin.w, false);
    }
    counts[i] = (uint4)(hit.nodes, hit.blocks, hit.entries, hit.primitive != NO_PRIMITIVE ? 1u : 0u);
}
