// SPDX-License-Identifier: Apache-2.0
// Stage shadow: is a light sample seen?
//   Reads    shadow ray i, guarded by the device's own count
//   Writes   visibility[result index of ray i]: rgb transmittance, 0 when something opaque is in the way
#include "lib/layers.clh"
#include "lib/pane.clh"
#include "lib/queued_rays.clh"
#include "lib/status.clh"

// Of each ray of a stream.
typedef struct ShadowRays {
    uint item[STREAM_RAYS];      // in the queue
    float3 passed[STREAM_RAYS];  // share of light that the panes met so far let pass
} ShadowRays;

// The ray behind the pane that it met, and the share of light that gets there.
inline void pass_pane(global const SceneTriangle* triangles, global const SceneMaterial* materials,
                      global const uchar4* texels, global const float* tables, float3 first_origin,
                      float3 first_direction, float3 direction, float t_light, Hit hit, uint item,
                      float3 passed, RayStream* stream, ShadowRays* rays) {
    global const SceneTriangle* triangle = triangles + (hit.primitive & ~PRIMITIVE_PANE);
    global const SceneMaterial* material = materials + triangle->ids.x;
    const Surface s = make_surface(triangle, hit.u, hit.v, direction);
    const float3 base = base_color(triangle, material, texels, tables, hit.u, hit.v);
    const float3 origin = ray_origin(&s, -1.0f);
    const float3 to_light = first_origin + first_direction - origin;
    rays->item[stream->count] = item;
    rays->passed[stream->count] =
        passed * pane_transmittance(material, base, -dot(normalize(first_direction), s.n_geo));
    add_ray(stream, origin, t_light == 1.0f ? to_light : direction, t_light);
}

// Takes the rays from pane to pane; each ends at the first one that something opaque is behind, or behind its last.
SHARE_FUNCTION trace_shadow_rays(global const BvhNode* nodes, global const TriangleBlock* blocks,
                                 global const SceneTriangle* triangles, global const SceneMaterial* materials,
                                 global const uchar4* texels, global const float* tables,
                                 global const float4* shadow_rays, uint capacity, global float4* visibility,
                                 global uint* counters, Share share) {
    RayStream stream;
    ShadowRays rays;
    for (uint first = share.first; first < share.last; first += STREAM_RAYS) {
        read_shadow_rays(shadow_rays, capacity, first, share.last, &stream);
        for (uint ray = 0u; ray < stream.count; ++ray) {
            rays.item[ray] = first + ray;
            rays.passed[ray] = (float3)(1.0f);
        }
        for (int segment = 0; stream.count > 0u; ++segment) {
            trace_stream(nodes, blocks, &stream, true);
            const uint count = stream.count;
            stream.count = 0u;
            for (uint ray = 0u; ray < count; ++ray) {
                const uint item = rays.item[ray];
                const float4 origin = shadow_rays[SHADOW_ORIGIN * capacity + item];
                const uint result = as_uint(origin.w);
                if (!check_slot(counters, result, capacity, STAGE_SHADOW, item)) continue;
                const Hit hit = stream_hit(&stream, ray);
                if (isnan(hit.t)) report_failure(counters, STATUS_STACK_OVERFLOW, STAGE_SHADOW, item);
                const bool pane = NEED_TRANSMISSION && hit.primitive != NO_PRIMITIVE && !is_blocked(hit);
                if (pane && segment < MAX_PANES) {
                    pass_pane(triangles, materials, texels, tables, origin.xyz,
                              shadow_rays[SHADOW_DIRECTION * capacity + item].xyz, stream.direction[ray].xyz,
                              stream.origin[ray].w, hit, item, rays.passed[ray], &stream, &rays);
                } else {
                    const bool dark = pane || is_blocked(hit);
                    visibility[result] = (float4)(dark ? (float3)(0.0f) : rays.passed[ray], 0.0f);
                }
            }
        }
    }
}

kernel void shadow(global const Frame* frame, global const BvhNode* nodes, global const TriangleBlock* blocks,
                   global const SceneTriangle* triangles, global const SceneMaterial* materials,
                   global const uchar4* texels, global const float* tables, global const float4* shadow_rays,
                   global float4* visibility, global uint* counters) {
    const Share share = share_of(counters[COUNT_SHADOWS], STREAM_RAYS);
    if (share.first < share.last) {
        trace_shadow_rays(nodes, blocks, triangles, materials, texels, tables, shadow_rays,
                          frame->crop.w * light_sample_count(frame), visibility, counters, share);
    }
}
