// SPDX-License-Identifier: Apache-2.0
// Stage obscurance: K cosine-distributed rays of each obscurance point (Zhukov, Iones, Kronin 1998; with colour
// bleeding: Mendez, Sbert, Neumann 2003, equation 6).
//   Reads    point i, guarded by the device's own count; its K directions from the sampler
//   Writes   results[slot * K + k]: R(Q) rho(d) or, for an open direction, R_ave; w: the same without colours
#include "lib/obscurance_ray.clh"
#include "lib/obscurance_result.clh"
#include "lib/status.clh"
#include "lib/stream.clh"

SHARE_FUNCTION trace_points(global const Frame* frame, global const BvhNode* nodes,
                            global const TriangleBlock* blocks, global const SceneTriangle* triangles,
                            global const SceneMaterial* materials, global const uchar4* texels,
                            global const float* tables, global const float4* points,
                            global const float4* paths, global float4* results, global uint* counters,
                            uint depth, Share share) {
    RayStream stream;
    RayOwners owners;
    for (uint next = 0u; next < direction_batches(frame, share);) {
        next = gather_obscurance_rays(frame, points, paths, counters, share, next, depth, &stream, &owners);
        trace_stream(nodes, blocks, &stream, any_occluder_will_do(frame));
        float rho[STREAM_RAYS];
        falloff_of_hits(frame, &stream, &owners, rho);
        for (uint ray = 0u; ray < stream.count; ++ray) {
            const Hit hit = stream_hit(&stream, ray);
            bool overflow = isnan(hit.t);
            float4 result;
            if (!result_without_panes(frame, triangles, materials, texels, tables, hit, rho[ray], &result)) {
                const uint i = owners.point[ray];
                const float3 position = points[POINT_POSITION * frame->crop.w + i].xyz;
                result = result_through_panes(frame, nodes, blocks, triangles, materials, texels, tables,
                                              position, ray_start(frame, points, i),
                                              stream.direction[ray].xyz, hit, rho[ray], &overflow);
            }
            results[owners.result[ray]] = result;
            if (overflow)
                report_failure(counters, STATUS_STACK_OVERFLOW, STAGE_OBSCURANCE, owners.point[ray]);
        }
    }
}

kernel void obscurance(global const Frame* frame, global const BvhNode* nodes,
                       global const TriangleBlock* blocks, global const SceneTriangle* triangles,
                       global const SceneMaterial* materials, global const uchar4* texels,
                       global const float* tables, global const float4* points, global const float4* paths,
                       global float4* results, global uint* counters, uint depth) {
    const Share share = share_of(counters[COUNT_POINTS], 1024u);
    if (share.first < share.last) {
        trace_points(frame, nodes, blocks, triangles, materials, texels, tables, points, paths, results,
                     counters, depth, share);
    }
}
