// SPDX-License-Identifier: Apache-2.0
// What a ray costs: the production traversal, built so that it counts its visits. For `obscura bench`, which never times
// this kernel.
#define COUNT_VISITS
#include "lib/stream.clh"

// rays: origin with t_max, direction. any_hit: 1 = whether anything is hit, 0 = the nearest hit. Of each ray
//   counts  nodes, blocks, the most entries on its stack, 1 if it hit something
SHARE_FUNCTION visit_share(global const BvhNode* nodes, global const TriangleBlock* blocks,
                           global const float4* rays, global uint4* counts, uint any_hit, Share share) {
    RayStream stream;
    for (uint first = share.first; first < share.last; first += stream.count) {
        trace_packed_rays(nodes, blocks, rays, first, share.last, any_hit != 0u, &stream);
        for (uint ray = 0u; ray < stream.count; ++ray) {
            const Hit hit = stream_hit(&stream, ray);
            const uint found = hit.primitive != NO_PRIMITIVE ? 1u : 0u;
            counts[first + ray] = (uint4)(hit.nodes, hit.blocks, hit.entries, found);
        }
    }
}

kernel void visits(global const BvhNode* nodes, global const TriangleBlock* blocks, global const float4* rays,
                   global uint4* counts, uint count, uint any_hit) {
    const Share share = share_of(count, STREAM_RAYS);
    if (share.first < share.last) visit_share(nodes, blocks, rays, counts, any_hit, share);
}
