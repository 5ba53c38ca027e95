// SPDX-License-Identifier: Apache-2.0
// What `obscura check` asks the device: the stages' own functions, with their results where the host can see them.
#include "lib/obscurance_ray.clh"
#include "lib/obscurance_result.clh"

// The K rays of the first point_count points, and the nearest hits that count: lanes of K * point_count items, direction k
// of point i being item K i + k.
//   0  origin; w: the t at which it is d_max away from its point
//   1  direction; w: index of its result
//   2  t, u, v, primitive of the hit
//   3  origin - point
SHARE_FUNCTION trace_points(global const Frame* frame, global const BvhNode* nodes,
                            global const TriangleBlock* blocks, global const float4* points,
                            global const float4* paths, global uint* counters, global float4* out,
                            uint point_count, uint depth, Share share) {
    const uint k_count = frame->sampling.y;
    const uint count = point_count * k_count;
    RayStream stream;
    RayOwners owners;
    for (uint next = 0u; next < direction_batches(frame, share);) {
        next = gather_obscurance_rays(frame, points, paths, counters, share, next, depth, &stream, &owners);
        trace_stream(nodes, blocks, &stream, false);
        for (uint ray = 0u; ray < stream.count; ++ray) {
            const uint i = owners.point[ray];
            const uint item = i * k_count + owners.result[ray] % k_count;
            out[item] = stream.origin[ray];
            out[count + item] = (float4)(stream.direction[ray].xyz, as_float(owners.result[ray]));
            out[2u * count + item] = hit_lane(stream_hit(&stream, ray));
            out[3u * count + item] = (float4)(ray_start(frame, points, i), 0.0f);
        }
    }
}

kernel void obscurance_rays(global const Frame* frame, global const BvhNode* nodes,
                            global const TriangleBlock* blocks, global const float4* points,
                            global const float4* paths, global uint* counters, global float4* out,
                            uint point_count, uint depth) {
    const Share share = share_of(point_count, 256u);
    if (share.first < share.last)
        trace_points(frame, nodes, blocks, points, paths, counters, out, point_count, depth, share);
}

// rays: origin with t_max, direction. query: RAY_QUERY_*
SHARE_FUNCTION trace_share(global const BvhNode* nodes, global const TriangleBlock* blocks,
                           global const float4* rays, global float4* hits, uint query, Share share) {
    if (query == RAY_QUERY_ALONE) {
        for (uint i = share.first; i < share.last; ++i)
            hits[i] = hit_lane(
                traverse(nodes, blocks, rays[2u * i].xyz, rays[2u * i + 1u].xyz, rays[2u * i].w, false));
        return;
    }
    RayStream stream;
    for (uint first = share.first; first < share.last; first += stream.count) {
        trace_packed_rays(nodes, blocks, rays, first, share.last, query == RAY_QUERY_ANY, &stream);
        for (uint ray = 0u; ray < stream.count; ++ray) {
            hits[first + ray] = hit_lane(stream_hit(&stream, ray));
        }
    }
}

kernel void trace_rays(global const BvhNode* nodes, global const TriangleBlock* blocks,
                       global const float4* rays, global float4* hits, uint count, uint query) {
    const Share share = share_of(count, STREAM_RAYS);
    if (share.first < share.last) trace_share(nodes, blocks, rays, hits, query, share);
}

// What obscurance rays bring back. rays: as above; starts: each origin - point; out, lanes of count: the hits as above; the
// t at which they are d_max away from their points, up to which hits count; rgb and the same without colours.
SHARE_FUNCTION result_share(global const Frame* frame, global const BvhNode* nodes,
                            global const TriangleBlock* blocks, global const SceneTriangle* triangles,
                            global const SceneMaterial* materials, global const uchar4* texels,
                            global const float* tables, global const float4* rays,
                            global const float4* starts, global float4* out, uint count, Share share) {
    RayStream stream;
    RayOwners owners;
    for (uint first = share.first; first < share.last; first += stream.count) {
        stream.count = 0u;
        for (uint i = first; i < min(first + STREAM_RAYS, share.last); ++i) {
            const float3 direction = rays[2u * i + 1u].xyz;
            const float along = start_along(starts[i].xyz, direction.x, direction.y, direction.z);
            const float across2 = start_across_squared(starts[i].xyz, along);
            owners.along[stream.count] = along;
            owners.across2[stream.count] = across2;
            add_ray(&stream, rays[2u * i].xyz, direction,
                    distance_limit(along, across2, frame->obscurance.x));
        }
        trace_stream(nodes, blocks, &stream, any_occluder_will_do(frame));
        float rho[STREAM_RAYS];
        falloff_of_hits(frame, &stream, &owners, rho);
        for (uint ray = 0u; ray < stream.count; ++ray) {
            const uint i = first + ray;
            const Hit hit = stream_hit(&stream, ray);
            bool overflow = isnan(hit.t);
            float4 result;
            if (!result_without_panes(frame, triangles, materials, texels, tables, hit, rho[ray], &result)) {
                const float3 start = starts[i].xyz;
                result = result_through_panes(frame, nodes, blocks, triangles, materials, texels, tables,
                                              rays[2u * i].xyz - start, start, stream.direction[ray].xyz, hit,
                                              rho[ray], &overflow);
            }
            out[i] = hit_lane(hit);
            out[count + i] = (float4)(stream.origin[ray].w, 0.0f, 0.0f, 0.0f);
            out[2u * count + i] = overflow ? (float4)(NAN) : result;
        }
    }
}

kernel void obscurance_results(global const Frame* frame, global const BvhNode* nodes,
                               global const TriangleBlock* blocks, global const SceneTriangle* triangles,
                               global const SceneMaterial* materials, global const uchar4* texels,
                               global const float* tables, global const float4* rays,
                               global const float4* starts, global float4* out, uint count) {
    const Share share = share_of(count, STREAM_RAYS);
    if (share.first < share.last)
        result_share(frame, nodes, blocks, triangles, materials, texels, tables, rays, starts, out, count,
                     share);
}
