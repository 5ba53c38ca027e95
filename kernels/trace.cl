// SPDX-License-Identifier: Apache-2.0
// Stage trace: closest hits of camera and glossy rays.
//   Reads    ray i
//   Writes   hit i, in the ray's own lane
#include "lib/queued_rays.clh"
#include "lib/status.clh"
#include "shared/frame.h"

SHARE_FUNCTION trace_rays(global const BvhNode* nodes, global const TriangleBlock* blocks,
                          global float4* rays, uint capacity, global uint* counters, Share share) {
    RayStream stream;
    for (uint first = share.first; first < share.last; first += stream.count) {
        read_rays(rays, capacity, first, share.last, &stream);
        trace_stream(nodes, blocks, &stream, false);
        for (uint i = first; i < first + stream.count; ++i) {
            const Hit hit = stream_hit(&stream, i - first);
            if (isnan(hit.t)) report_failure(counters, STATUS_STACK_OVERFLOW, STAGE_TRACE, i);
            rays[RAY_HIT * capacity + i] = hit_lane(hit);
        }
    }
}

kernel void trace(global const Frame* frame, global const BvhNode* nodes, global const TriangleBlock* blocks,
                  global float4* rays, global uint* counters, uint count) {
    const Share share = share_of(count, STREAM_RAYS);
    if (share.first < share.last) trace_rays(nodes, blocks, rays, frame->crop.w, counters, share);
}
