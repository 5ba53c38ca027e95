// SPDX-License-Identifier: Apache-2.0
// What `obscura check` asks the device: the stages' own functions, with their results where the host can see them.
#include "lib/obscurance_ray.clh"
#include "lib/traverse.clh"

// Ray `item`, the direction item % K of point item / K, and the nearest hit that counts: lanes of `count` items.
//   0  origin; w: the t at which it is d_max away from its point
//   1  direction; w: index of its result
//   2  t, u, v, primitive of the hit
//   3  origin - point
kernel void obscurance_rays(global const Frame* frame, global const BvhNode* nodes,
                            global const TriangleBlock* blocks, global const float4* points,
                            global const float4* paths, global float4* out, uint count, uint depth) {
    const uint item = (uint)get_global_id(0);
    if (item >= count) return;
    const uint k_count = frame->sampling.y;
    const uint k = item % k_count;
    const ObscurancePoint point = load_obscurance_point(frame, points, paths, item / k_count, depth);
    const uint lane = k % DIRECTION_BATCH;
    Directions directions;
    obscurance_directions(&point, k - lane, &directions);
    const float3 direction = (float3)(directions.x[lane], directions.y[lane], directions.z[lane]);
    const float limit = distance_limit(point.start, direction, frame->obscurance.x);
    const float3 origin = point.position + point.start;
    const Hit hit = traverse(nodes, blocks, origin, direction, limit, false);
    out[item] = (float4)(origin, limit);
    out[count + item] = (float4)(direction, as_float(point.slot * k_count + k));
    out[2u * count + item] = (float4)(hit.t, hit.u, hit.v, as_float(hit.primitive));
    out[3u * count + item] = (float4)(point.start, 0.0f);
}

// rays: origin with t_max, direction. any_hit: 1 = whether anything is hit, 0 = the nearest hit.
kernel void trace_rays(global const BvhNode* nodes, global const TriangleBlock* blocks,
                       global const float4* rays, global float4* hits, uint count, uint any_hit) {
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
    hits[i] = (float4)(hit.t, hit.u, hit.v, as_float(hit.primitive));
}
