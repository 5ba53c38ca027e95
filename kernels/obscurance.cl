// SPDX-License-Identifier: Apache-2.0
// Stage obscurance: K cosine-distributed rays of each obscurance point (Zhukov, Iones, Kronin 1998; with colour
// bleeding: Mendez, Sbert, Neumann 2003, equation 6).
//   Reads    point i / K, guarded by the device's own count; direction i % K from the sampler
//   Writes   results[slot * K + k]: R(Q) rho(d) or, for an open direction, R_ave; w: the same without colours
// d is measured from the point itself, not from the ray's offset origin, and a hit counts only if d < d_max.
#include "lib/falloff.clh"
#include "lib/obscurance_ray.clh"
#include "lib/pane.clh"
#include "lib/status.clh"

kernel void obscurance(global const Frame* frame, global const BvhNode* nodes,
                       global const TriangleBlock* blocks, global const SceneTriangle* triangles,
                       global const SceneMaterial* materials, global const uchar4* texels,
                       global const float* tables, global const float4* points, global const float4* paths,
                       global float4* results, global uint* counters, uint depth) {
    const uint item = (uint)get_global_id(0);
    const uint k_count = frame->sampling.y;
    if (item >= counters[COUNT_POINTS] * k_count) return;
    const uint i = item / k_count;
    const uint k = item - i * k_count;
    const ObscuranceRay ray = make_obscurance_ray(frame, points, paths, i, k, depth);

    const float d_max = frame->obscurance.x;
    const bool bleeding = (frame->seed.w & FRAME_BLEEDING) != 0u;
    const bool any_hit = !NEED_NEAREST_OCCLUDER;
    float3 start = ray.start;
    float3 through = (float3)(1.0f);  // share of light that the panes met so far let pass
    float3 w = (float3)(0.0f);
    float w_colourless = 0.0f;
    bool open = true;
    for (int segment = 0; open && segment < MAX_SEGMENTS; ++segment) {
        const Hit hit = traverse(nodes, blocks, ray.position + start, ray.direction,
                                 distance_limit(start, ray.direction, d_max), any_hit);
        if (isnan(hit.t)) report_failure(counters, STATUS_STACK_OVERFLOW, STAGE_OBSCURANCE, item);
        if (hit.primitive == NO_PRIMITIVE) break;
        const float t = length(start + hit.t * ray.direction) * frame->obscurance.y;
        const float rho = falloff(frame->lights.z, t, frame->obscurance.z, frame->obscurance.w);
        float3 blocked = through;
        float3 reflectivity = (float3)(1.0f);
        open = false;
        if (NEED_BLEEDING || NEED_TRANSMISSION) {
            global const SceneTriangle* triangle = triangles + hit.primitive;
            global const SceneMaterial* material = materials + triangle->ids.x;
            const float3 base = base_color(triangle, material, texels, tables, hit.u, hit.v);
            if (bleeding) reflectivity = base * material->mean_scale.xyz;
            if (NEED_TRANSMISSION && is_pane(material)) {
                const Surface pane = make_surface(triangle, hit.u, hit.v, ray.direction);
                const float3 passed = pane_transmittance(material, base, -dot(ray.direction, pane.n_geo));
                blocked = through * (1.0f - passed);
                through *= passed;
                start = (pane.position - pane.offset * pane.n_geo) - ray.position;
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
    results[(size_t)ray.slot * k_count + k] = (float4)(w, w_colourless);
}
