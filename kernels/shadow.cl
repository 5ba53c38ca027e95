// SPDX-License-Identifier: Apache-2.0
// Stage shadow: is a light sample seen?
//   Reads    shadow ray i, guarded by the device's own count
//   Writes   visibility[result index of ray i]: rgb transmittance, 0 when something opaque is in the way
#include "lib/layers.clh"
#include "lib/pane.clh"
#include "lib/queued_rays.clh"
#include "lib/status.clh"

// Of each ray of a stream that sees its light through panes.
typedef struct PassingRays {
    uint item[STREAM_RAYS];      // in the queue
    float3 passed[STREAM_RAYS];  // share of light that the panes met so far let pass
} PassingRays;

inline void add_passing_ray(RayStream* stream, PassingRays* passing, uint item, float3 passed, float3 origin,
                            float3 direction, float t_light) {
    passing->item[stream->count] = item;
    passing->passed[stream->count] = passed;
    add_ray(stream, origin, direction, t_light);
}

// Takes the rays from pane to pane; each ends behind its last, or at the first opaque surface.
inline void pass_panes(global const BvhNode* nodes, global const TriangleBlock* blocks,
                       global const SceneTriangle* triangles, global const SceneMaterial* materials,
                       global const uchar4* texels, global const float* tables,
                       global const float4* shadow_rays, uint capacity, RayStream* stream,
                       PassingRays* passing, global float4* visibility, global uint* counters) {
    for (int segment = 0; stream->count > 0u; ++segment) {
        trace_stream(nodes, blocks, stream, false);
        const uint count = stream->count;
        stream->count = 0u;
        for (uint ray = 0u; ray < count; ++ray) {
            const uint item = passing->item[ray];
            const float4 first_origin = shadow_rays[SHADOW_ORIGIN * capacity + item];
            const Hit hit = stream_hit(stream, ray);
            if (isnan(hit.t)) report_failure(counters, STATUS_STACK_OVERFLOW, STAGE_SHADOW, item);
            float3 passed = passing->passed[ray];
            if (hit.primitive != NO_PRIMITIVE) {
                global const SceneTriangle* triangle = triangles + hit.primitive;
                global const SceneMaterial* material = materials + triangle->ids.x;
                if (is_pane(material) && segment < MAX_PANES) {
                    const float3 first_direction = shadow_rays[SHADOW_DIRECTION * capacity + item].xyz;
                    const float3 direction = stream->direction[ray].xyz;
                    const float t_light = stream->origin[ray].w;
                    const Surface s = make_surface(triangle, hit.u, hit.v, direction);
                    const float3 base = base_color(triangle, material, texels, tables, hit.u, hit.v);
                    passed *= pane_transmittance(material, base, -dot(normalize(first_direction), s.n_geo));
                    const float3 origin = ray_origin(&s, -1.0f);
                    const float3 to_light = first_origin.xyz + first_direction - origin;
                    add_passing_ray(stream, passing, item, passed, origin,
                                    t_light == 1.0f ? to_light : direction, t_light);
                    continue;
                }
                passed = (float3)(0.0f);
            }
            visibility[as_uint(first_origin.w)] = (float4)(passed, 0.0f);
        }
    }
}

SHARE_FUNCTION trace_shadow_rays(global const BvhNode* nodes, global const TriangleBlock* blocks,
                                 global const SceneTriangle* triangles, global const SceneMaterial* materials,
                                 global const uchar4* texels, global const float* tables,
                                 global const float4* shadow_rays, uint capacity, global float4* visibility,
                                 global uint* counters, Share share) {
    RayStream stream;
    PassingRays passing;
    for (uint first = share.first; first < share.last; first += STREAM_RAYS) {
        read_shadow_rays(shadow_rays, capacity, first, share.last, &stream);
        const uint count = stream.count;
        trace_stream(nodes, blocks, &stream, true);
        stream.count = 0u;
        for (uint ray = 0u; ray < count; ++ray) {
            const uint i = first + ray;
            const float4 origin = shadow_rays[SHADOW_ORIGIN * capacity + i];
            const uint result = as_uint(origin.w);
            if (!check_slot(counters, result, capacity, STAGE_SHADOW, i)) continue;
            const Hit hit = stream_hit(&stream, ray);
            if (isnan(hit.t)) report_failure(counters, STATUS_STACK_OVERFLOW, STAGE_SHADOW, i);
            const bool blocked = hit.t < stream.origin[ray].w;
            if (NEED_TRANSMISSION && !blocked && hit.primitive != NO_PRIMITIVE) {
                add_passing_ray(&stream, &passing, i, (float3)(1.0f), origin.xyz, stream.direction[ray].xyz,
                                stream.origin[ray].w);
            } else {
                visibility[result] = (float4)((float3)(blocked ? 0.0f : 1.0f), 0.0f);
            }
        }
        if (NEED_TRANSMISSION) {
            pass_panes(nodes, blocks, triangles, materials, texels, tables, shadow_rays, capacity, &stream,
                       &passing, visibility, counters);
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
