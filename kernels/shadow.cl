// SPDX-License-Identifier: Apache-2.0
// Stage shadow: is a light sample seen?
//   Reads    shadow ray i, guarded by the device's own count
//   Writes   visibility[result index of ray i]: rgb transmittance, 0 when something opaque is in the way
#include "lib/layers.clh"
#include "lib/pane.clh"
#include "lib/status.clh"
#include "lib/stream.clh"

// Share of light that passes the panes between the origin and the light, per channel: their product, 0 at the first opaque
// surface.
inline float3 transmittance(global const BvhNode* nodes, global const TriangleBlock* blocks,
                            global const SceneTriangle* triangles, global const SceneMaterial* materials,
                            global const uchar4* texels, global const float* tables, float3 origin,
                            float3 direction, float t_light, bool* overflow) {
    const float3 unit = normalize(direction);
    const float3 target = origin + direction;
    float3 result = (float3)(1.0f);
    for (int segment = 0; segment < MAX_SEGMENTS; ++segment) {
        const Hit hit = traverse(nodes, blocks, origin, direction, t_light, false);
        if (isnan(hit.t)) *overflow = true;
        if (hit.primitive == NO_PRIMITIVE) return result;
        global const SceneTriangle* triangle = triangles + hit.primitive;
        global const SceneMaterial* material = materials + triangle->ids.x;
        if (!is_pane(material) || segment == MAX_PANES) return (float3)(0.0f);
        const Surface s = make_surface(triangle, hit.u, hit.v, direction);
        result *= pane_transmittance(material, base_color(triangle, material, texels, tables, hit.u, hit.v),
                                     -dot(unit, s.n_geo));
        origin = s.position - s.offset * s.n_geo;
        if (t_light == 1.0f) direction = target - origin;
    }
    return (float3)(0.0f);
}

kernel void shadow(global const Frame* frame, global const BvhNode* nodes, global const TriangleBlock* blocks,
                   global const SceneTriangle* triangles, global const SceneMaterial* materials,
                   global const uchar4* texels, global const float* tables, global const float4* shadow_rays,
                   global float4* visibility, global uint* counters) {
    const Share share = share_of(counters[COUNT_SHADOWS], STREAM_RAYS);
    const uint capacity = frame->crop.w * light_sample_count(frame);
    RayStream stream;
    for (uint first = share.first; first < share.last; first += stream.count) {
        stream.count = 0u;
        const uint last = min(first + STREAM_RAYS, share.last);
        for (uint i = first; i < last; ++i) {
            const float4 direction = shadow_rays[SHADOW_DIRECTION * capacity + i];
            add_ray(&stream, shadow_rays[SHADOW_ORIGIN * capacity + i].xyz, direction.xyz, direction.w);
        }
        trace_stream(nodes, blocks, &stream, true);
        for (uint i = first; i < last; ++i) {
            const float4 origin = shadow_rays[SHADOW_ORIGIN * capacity + i];
            const uint result = as_uint(origin.w);
            if (!check_slot(counters, result, capacity, STAGE_SHADOW, i)) continue;
            const uint ray = i - first;
            const Hit hit = stream_hit(&stream, ray);
            bool overflow = isnan(hit.t);
            float3 passed = (float3)(hit.t < stream.t_max[ray] ? 0.0f : 1.0f);
            if (NEED_TRANSMISSION && passed.x > 0.0f && hit.primitive != NO_PRIMITIVE) {
                passed = transmittance(nodes, blocks, triangles, materials, texels, tables, origin.xyz,
                                       stream_direction(&stream, ray), stream.t_max[ray], &overflow);
            }
            if (overflow) report_failure(counters, STATUS_STACK_OVERFLOW, STAGE_SHADOW, i);
            visibility[result] = (float4)(passed, 0.0f);
        }
    }
}
