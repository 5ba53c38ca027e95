// SPDX-License-Identifier: Apache-2.0
// Stage trace: closest hits of camera and glossy rays.
//   Reads    ray i
//   Writes   hit i, in the ray's own lane
//   Camera rays go down the tree in packets, glossy ones in streams.
#include "lib/packet.clh"
#include "lib/status.clh"
#include "lib/stream.clh"
#include "shared/frame.h"

inline void store_hit(global float4* rays, global uint* counters, uint capacity, uint i, Hit hit) {
    if (isnan(hit.t)) report_failure(counters, STATUS_STACK_OVERFLOW, STAGE_TRACE, i);
    rays[RAY_HIT * capacity + i] = hit_lane(hit);
}

kernel void trace(global const Frame* frame, global const BvhNode* nodes, global const TriangleBlock* blocks,
                  global float4* rays, global uint* counters, uint count, uint depth) {
    const Share share = share_of_group(count);
    const uint capacity = frame->crop.w;
#ifdef OBSCURA_PORTABLE
    (void)depth;
#else
    if (depth == 0u) {
        RayPacket packet;
        for (uint first = share.first; first < share.last; first += packet.count) {
            clear_packet(&packet);
            for (uint i = first; i < share.last; ++i) {
                if (!join_packet(&packet, rays[RAY_ORIGIN * capacity + i].xyz,
                                 rays[RAY_DIRECTION * capacity + i].xyz, INFINITY))
                    break;
            }
            trace_packet(nodes, blocks, &packet);
            for (uint lane = 0u; lane < packet.count; ++lane)
                store_hit(rays, counters, capacity, first + lane, packet.hits[lane]);
        }
        return;
    }
#endif
    RayStream stream;
    for (uint first = share.first; first < share.last; first += stream.count) {
        stream.count = 0u;
        const uint last = min(first + STREAM_RAYS, share.last);
        for (uint i = first; i < last; ++i) {
            add_ray(&stream, rays[RAY_ORIGIN * capacity + i].xyz, rays[RAY_DIRECTION * capacity + i].xyz,
                    INFINITY);
        }
        trace_stream(nodes, blocks, &stream, false);
        for (uint i = first; i < last; ++i)
            store_hit(rays, counters, capacity, i, stream.hits[i - first]);
    }
}
