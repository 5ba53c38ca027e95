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
        for (uint ray = 0u; ray < stream.count; ++ray) {
            rho[ray] = hit_distance(frame, ray_start(frame, points, owners.point[ray]),
                                    stream.direction[ray].xyz, stream.hit[ray].x);
        }
        apply_falloff(frame, rho, stream.count);
        for (uint ray = 0u; ray < stream.count; ++ray) {
            const uint i = owners.point[ray];
            bool overflow = false;
            results[owners.result[ray]] =
                trace_obscurance(frame, nodes, blocks, triangles, materials, texels, tables,
                                 points[POINT_POSITION * frame->crop.w + i].xyz, ray_start(frame, points, i),
                                 stream.direction[ray].xyz, stream_hit(&stream, ray), rho[ray], &overflow);
            if (overflow) report_failure(counters, STATUS_STACK_OVERFLOW, STAGE_OBSCURANCE, i);
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
