// SPDX-License-Identifier: Apache-2.0
// What a ray costs: the production traversal, built so that it counts its visits. For `obscura bench` and `obscura render
// --profile`, which never time these kernels. Behind panes nothing is counted.
#define COUNT_VISITS
#include "lib/layers.clh"
#include "lib/obscurance_ray.clh"
#include "lib/queued_rays.clh"

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

// The rays that a render has in its queues, once more. Of each ray
//   counts  nodes, blocks, the most entries on its stack, its pixel's index in the crop

inline uint4 visits_of(Hit hit, global const Frame* frame, global const float4* paths, uint slot) {
    const uint pixel = as_uint(paths[path_index(frame, PATH_SAMPLE, slot)].z);
    return (uint4)(hit.nodes, hit.blocks, hit.entries, pixel);
}

SHARE_FUNCTION trace_share(global const Frame* frame, global const BvhNode* nodes,
                           global const TriangleBlock* blocks, global const float4* rays,
                           global const float4* paths, global uint4* counts, Share share) {
    const uint capacity = frame->crop.w;
    RayStream stream;
    for (uint first = share.first; first < share.last; first += stream.count) {
        read_rays(rays, capacity, first, share.last, &stream);
        trace_stream(nodes, blocks, &stream, false);
        for (uint ray = 0u; ray < stream.count; ++ray) {
            const uint slot = as_uint(rays[RAY_ORIGIN * capacity + first + ray].w);
            counts[first + ray] = visits_of(stream_hit(&stream, ray), frame, paths, slot);
        }
    }
}

kernel void trace_visits(global const Frame* frame, global const BvhNode* nodes,
                         global const TriangleBlock* blocks, global const float4* rays,
                         global const float4* paths, global uint4* counts, uint count) {
    const Share share = share_of(count, STREAM_RAYS);
    if (share.first < share.last) trace_share(frame, nodes, blocks, rays, paths, counts, share);
}

SHARE_FUNCTION shadow_share(global const Frame* frame, global const BvhNode* nodes,
                            global const TriangleBlock* blocks, global const float4* shadow_rays,
                            global const float4* paths, global uint4* counts, Share share) {
    const uint capacity = frame->crop.w * light_sample_count(frame);
    RayStream stream;
    for (uint first = share.first; first < share.last; first += stream.count) {
        read_shadow_rays(shadow_rays, capacity, first, share.last, &stream);
        trace_stream(nodes, blocks, &stream, true);
        for (uint ray = 0u; ray < stream.count; ++ray) {
            const uint result = as_uint(shadow_rays[SHADOW_ORIGIN * capacity + first + ray].w);
            counts[first + ray] = visits_of(stream_hit(&stream, ray), frame, paths, result % frame->crop.w);
        }
    }
}

kernel void shadow_visits(global const Frame* frame, global const BvhNode* nodes,
                          global const TriangleBlock* blocks, global const float4* shadow_rays,
                          global const float4* paths, global uint4* counts, uint count) {
    const Share share = share_of(count, STREAM_RAYS);
    if (share.first < share.last) shadow_share(frame, nodes, blocks, shadow_rays, paths, counts, share);
}

// Ray k of point i is item K i + k.
SHARE_FUNCTION obscurance_share(global const Frame* frame, global const BvhNode* nodes,
                                global const TriangleBlock* blocks, global const float4* points,
                                global const float4* paths, global uint* counters, global uint4* counts,
                                uint depth, Share share) {
    const uint k_count = frame->sampling.y;
    RayStream stream;
    RayOwners owners;
    for (uint next = 0u; next < direction_batches(frame, share);) {
        next = gather_obscurance_rays(frame, points, paths, counters, share, next, depth, &stream, &owners);
        trace_stream(nodes, blocks, &stream, any_occluder_will_do(frame));
        for (uint ray = 0u; ray < stream.count; ++ray) {
            const uint slot = owners.result[ray] / k_count;
            const uint item = owners.point[ray] * k_count + owners.result[ray] % k_count;
            counts[item] = visits_of(stream_hit(&stream, ray), frame, paths, slot);
        }
    }
}

kernel void obscurance_visits(global const Frame* frame, global const BvhNode* nodes,
                              global const TriangleBlock* blocks, global const float4* points,
                              global const float4* paths, global uint* counters, global uint4* counts,
                              uint count, uint depth) {
    const Share share = share_of(count, 256u);
    if (share.first < share.last)
        obscurance_share(frame, nodes, blocks, points, paths, counters, counts, depth, share);
}
