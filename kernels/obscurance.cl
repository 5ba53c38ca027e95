// SPDX-License-Identifier: Apache-2.0
// Stage obscurance: K cosine-distributed rays of each obscurance point (Zhukov, Iones, Kronin 1998; with colour
// bleeding: Mendez, Sbert, Neumann 2003, equation 6).
//   Reads    point i, guarded by the device's own count; its K directions from the sampler
//   Writes   results[slot * K + k]: R(Q) rho(d) or, for an open direction, R_ave; w: the same without colours
// d is measured from the point itself, not from the ray's offset origin, and a hit counts only if d < d_max.
#include "lib/falloff.clh"
#include "lib/obscurance_ray.clh"
#include "lib/pane.clh"
#include "lib/status.clh"
#include "lib/stream.clh"

// What the ray from position + start brings back, whose nearest hit is known: rgb with colours, w without.
inline float4 trace_obscurance(global const Frame* frame, global const BvhNode* nodes,
                               global const TriangleBlock* blocks, global const SceneTriangle* triangles,
                               global const SceneMaterial* materials, global const uchar4* texels,
                               global const float* tables, float3 position, float3 start, float3 direction,
                               Hit hit, bool* overflow) {
    const float d_max = frame->obscurance.x;
    const bool bleeding = (frame->seed.w & FRAME_BLEEDING) != 0u;
    const bool any_hit = !NEED_NEAREST_OCCLUDER;
    float3 through = (float3)(1.0f);  // share of light that the panes met so far let pass
    float3 w = (float3)(0.0f);
    float w_colourless = 0.0f;
    bool open = true;
    for (int segment = 0; open && segment < MAX_SEGMENTS; ++segment) {
        if (isnan(hit.t)) *overflow = true;
        if (hit.primitive == NO_PRIMITIVE) break;
        const float t = length(start + hit.t * direction) * frame->obscurance.y;
        const float rho = falloff(frame->lights.z, t, frame->obscurance.z, frame->obscurance.w);
        float3 blocked = through;
        float3 reflectivity = (float3)(1.0f);
        open = false;
        if (NEED_BLEEDING || NEED_TRANSMISSION) {
            global const SceneTriangle* triangle = triangles + hit.primitive;
            global const SceneMaterial* material = materials + triangle->ids.x;
            const float3 base = base_color(triangle, material, texels, tables, hit.u, hit.v);
            if (bleeding) reflectivity = base * material->mean_scale.xyz;
            if (NEED_TRANSMISSION && is_pane(material) && segment < MAX_PANES) {
                const Surface pane = make_surface(triangle, hit.u, hit.v, direction);
                const float3 passed = pane_transmittance(material, base, -dot(direction, pane.n_geo));
                blocked = through * (1.0f - passed);
                through *= passed;
                start = (pane.position - pane.offset * pane.n_geo) - position;
                hit = traverse(nodes, blocks, position + start, direction,
                               distance_limit(start, direction, d_max), any_hit);
                open = true;
            }
        }
        w += rho * blocked * reflectivity;
        w_colourless += rho * mean_component(blocked);
    }
    if (open) {
        w += through * frame->miss.xyz;
        w_colourless += mean_component(through);
    }
    return (float4)(w, w_colourless);
}

kernel void obscurance(global const Frame* frame, global const BvhNode* nodes,
                       global const TriangleBlock* blocks, global const SceneTriangle* triangles,
                       global const SceneMaterial* materials, global const uchar4* texels,
                       global const float* tables, global const float4* points, global const float4* paths,
                       global float4* results, global uint* counters, uint depth) {
    const Share share = share_of_group(counters[COUNT_POINTS]);
    RayStream stream;
    RayOwners owners;
    for (uint next = 0u; next < direction_batches(frame, share);) {
        next = gather_obscurance_rays(frame, points, paths, counters, share, next, depth, &stream, &owners);
        trace_stream(nodes, blocks, &stream, !NEED_NEAREST_OCCLUDER);
        for (uint ray = 0u; ray < stream.count; ++ray) {
            const uint i = owners.point[ray];
            bool overflow = false;
            results[owners.result[ray]] =
                trace_obscurance(frame, nodes, blocks, triangles, materials, texels, tables,
                                 points[POINT_POSITION * frame->crop.w + i].xyz, ray_start(frame, points, i),
                                 stream.directions[ray], stream.hits[ray], &overflow);
            if (overflow) report_failure(counters, STATUS_STACK_OVERFLOW, STAGE_OBSCURANCE, i);
        }
    }
}
