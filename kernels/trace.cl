// SPDX-License-Identifier: Apache-2.0
// Stage trace: closest hits of camera and glossy rays.
//   Reads    ray i
//   Writes   hit i, in the ray's own lane
#include "lib/status.clh"
#include "lib/traverse.clh"
#include "shared/frame.h"

kernel void trace(global const Frame* frame, global const BvhNode* nodes, global const TriangleBlock* blocks,
                  global float4* rays, global uint* counters, uint count) {
    const uint i = (uint)get_global_id(0);
    if (i >= count) return;
    const uint capacity = frame->crop.w;
    const float3 origin = rays[RAY_ORIGIN * capacity + i].xyz;
    const float3 direction = rays[RAY_DIRECTION * capacity + i].xyz;
    const Hit hit = traverse(nodes, blocks, origin, direction, INFINITY, false);
    if (isnan(hit.t)) report_failure(counters, STATUS_STACK_OVERFLOW, STAGE_TRACE, i);
    rays[RAY_HIT * capacity + i] = (float4)(hit.t, hit.u, hit.v, as_float(hit.primitive));
}
