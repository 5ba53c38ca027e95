// SPDX-License-Identifier: Apache-2.0
// Stage shade: what happens where a ray hit.
//   Reads    ray i with its hit, the path slot
//   Appends  at most one continuation ray, one shadow ray per light sample, one obscurance point
//   Writes   of the path slot: throughput, emission, first-hit layers, ambient weight, the contribution that each
//            light sample makes if it is visible
// Rays are shaded in batches (lib/batch.clh). The diffuse lobe is never continued: obscurances stand for it.
#include "lib/continuation.clh"
#include "lib/direct_light.clh"
#include "lib/layers.clh"
#include "lib/math.clh"
#include "lib/outbox.clh"
#include "lib/sample_batch.clh"
#include "lib/share.clh"
#include "lib/status.clh"
#include "shared/bvh.h"

inline void write_first_hit(global const Frame* frame, const Vertex* v, global const SceneTriangle* triangle,
                            float4 hit, global float4* paths) {
    const Surface* s = &v->surface;
    const float depth = dot(s->position - frame->camera_origin.xyz, frame->camera_forward.xyz);
    start_layer(
        frame, paths, LAYER_POSITION, v->slot,
        frame->world_origin.w * (float4)(s->position, depth) + (float4)(frame->world_origin.xyz, 0.0f));
    start_layer(frame, paths, LAYER_NORMAL, v->slot, (float4)(s->n_geo, 0.0f));
    start_layer(frame, paths, LAYER_SHADING, v->slot, (float4)(s->n_shade, 0.0f));
    if (has_layer(frame, LAYER_UV)) {
        start_layer(frame, paths, LAYER_UV, v->slot,
                    (float4)(texture_coordinates(triangle, hit.y, hit.z), 0.0f, 0.0f));
    }
    start_layer(frame, paths, LAYER_ALBEDO, v->slot, (float4)(v->diffuse + v->specular, 0.0f));
}

// The layers of the first hit where there is none.
inline void clear_first_hit(global const Frame* frame, global float4* paths, uint slot) {
    for (uint layer = LAYER_POSITION; layer <= LAYER_UV; ++layer)
        start_layer(frame, paths, layer, slot, (float4)(0.0f));
}

// radiance: what a path brings back from where its ray of this depth ends; covered: 1 where that is a surface.
inline void add_emission(global const Frame* frame, global float4* paths, uint depth, uint slot,
                         float3 radiance, float covered) {
    if (depth == 0u) {
        start_layer(frame, paths, LAYER_EMISSION, slot, (float4)(radiance, covered));
    } else {
        add_to_layer(frame, paths, LAYER_SPECULAR_EMISSION, slot, (float4)(radiance, 0.0f));
    }
}

// What emission adds at a vertex, and the first hit's layers. v->pane_way: the way from where the ray was scattered.
inline void write_emission(global const Frame* frame, const SceneData* scene, const Vertex* v,
                           uint light_index, float3 origin, float3 direction, global float4* paths) {
    float3 emitted = (float3)(0.0f);
    if (NEED_EMISSION) {
        emitted = (v->flags & MATERIAL_UNLIT) != 0u
                      ? v->base
                      : emitted_radiance(scene->materials + v->material, v->surface.front) *
                            emission_weight(frame, scene->area_lights, light_index, v->pdf_sr, v->pane_way,
                                            origin, direction);
    }
    add_emission(frame, paths, v->depth, v->slot, v->throughput * emitted, 1.0f);
}

// Vertex of ray i; false if there is nothing to be lit.
INLINED bool meet_surface(global const Frame* frame, const SceneData* scene, global const float4* rays,
                          uint i, uint depth, global float4* paths, global uint* counters, Vertex* v) {
    const uint capacity = frame->crop.w;
    const float4 origin = rays[RAY_ORIGIN * capacity + i];
    const uint slot = as_uint(origin.w);
    if (!check_slot(counters, slot, capacity, STAGE_SHADE, i)) return false;
    const float4 direction = rays[RAY_DIRECTION * capacity + i];
    const float4 hit = rays[RAY_HIT * capacity + i];
    const float4 throughput = paths[path_index(frame, PATH_THROUGHPUT, slot)];
    const uint4 sample = as_uint4(paths[path_index(frame, PATH_SAMPLE, slot)]);

    // What gather reads, for the paths that end here.
    paths[path_index(frame, PATH_AMBIENT, slot)] = (float4)(0.0f);
    const uint primitive = as_uint(hit.w);
    if (primitive == NO_PRIMITIVE) {
        clear_light_lanes(frame, paths, slot);
        const float3 sky = NEED_BACKGROUND ? frame->background.xyz : (float3)(0.0f);
        add_emission(frame, paths, depth, slot, throughput.xyz * sky, 0.0f);
        if (depth == 0u) clear_first_hit(frame, paths, slot);
        return false;
    }

    global const SceneTriangle* triangle = scene->triangles + primitive;
    make_vertex(scene, triangle, direction.xyz, hit, v);
    v->throughput = throughput.xyz;
    v->pdf_sr = throughput.w;
    v->pane_way = direction.w + hit.x;
    v->slot = slot;
    v->depth = depth;
    v->sampler.seed = sample.x;
    v->sampler.sample = sample.y;
    write_emission(frame, scene, v, triangle->ids.y, origin.xyz - direction.w * direction.xyz, direction.xyz,
                   paths);
    if (depth == 0u) write_first_hit(frame, v, triangle, hit, paths);
    if ((v->flags & MATERIAL_UNLIT) == 0u) return true;
    clear_light_lanes(frame, paths, slot);
    return false;
}

// The point whose obscurance weighs the ambient light.
inline void add_ambient(global const Frame* frame, const Vertex* v, global float4* paths, Outbox* points) {
    if (!frame_has(frame, FRAME_AMBIENT) || !(max_component(v->diffuse) > 0.0f)) return;
    const Surface* s = &v->surface;
    const bool traced = NEED_OBSCURANCE && frame_has(frame, FRAME_OBSCURANCE);
    paths[path_index(frame, PATH_AMBIENT, v->slot)] =
        (float4)(v->throughput * v->diffuse * frame->ambient.xyz, traced ? AMBIENT_TRACED : AMBIENT_CONSTANT);
    if (traced) {
        post(points, (float4)(s->position, as_float(v->slot)), (float4)(s->n_geo, s->offset),
             (float4)(s->n_shade, 0.0f));
    }
}

// choice: as in sample_continuation.
inline void continue_path(global const Frame* frame, const SceneData* scene, const Vertex* v, float2 choice,
                          global float4* paths, Outbox* rays) {
    Continuation next;
    if (!continues_glossy(frame, v) ||
        !sample_continuation(frame, v, scene->materials + v->material, choice, &next))
        return;
    // A ray that passes a pane straight on is still the one that was scattered before it.
    const bool passes = next.side < 0.0f;
    post(rays, (float4)(ray_origin(&v->surface, next.side), as_float(v->slot)),
         (float4)(next.direction, passes ? v->pane_way : 0.0f), (float4)(0.0f));
    paths[path_index(frame, PATH_THROUGHPUT, v->slot)] =
        (float4)(v->throughput * next.weight, passes ? v->pdf_sr : next.pdf_sr);
}

inline void continue_paths(global const Frame* frame, const SceneData* scene, const VertexBatch* batch,
                           uint depth, global float4* paths, Outbox* rays) {
    SampleSetBatch sets;
    CodeBatch choices;
    make_sample_sets(frame, &batch->samplers, dimension_at(depth, DIMENSION_LOBE), 1u, frame->lattice.xy,
                     true, &sets);
    draw_codes(&sets, 0u, &choices);
    for (uint lane = 0u; lane < batch->count; ++lane)
        continue_path(frame, scene, &batch->vertices[lane], unit_point(&choices, lane), paths, rays);
}

// What is appended on its way into the queues.
typedef struct Appends {
    Outbox rays, shadow_rays, points;
} Appends;

SHARE_FUNCTION shade_rays(global const Frame* frame, const SceneData* scene, global const float4* rays,
                          global float4* paths, global float4* next_rays, global float4* shadow_rays,
                          global float4* points, global uint* counters, uint depth, Share share) {
    const uint capacity = frame->crop.w;
    Appends appends;
    open_outbox(&appends.rays, next_rays, 2u, capacity, &counters[COUNT_RAYS]);
    open_outbox(&appends.shadow_rays, shadow_rays, SHADOW_LANES, capacity * light_sample_count(frame),
                &counters[COUNT_SHADOWS]);
    open_outbox(&appends.points, points, POINT_LANES, capacity, &counters[COUNT_POINTS]);
    VertexBatch batch;
    for (uint i = share.first; i < share.last;) {
        batch.count = 0u;
        for (; i < share.last && batch.count < BATCH; ++i) {
            Vertex* v = &batch.vertices[batch.count];
            if (meet_surface(frame, scene, rays, i, depth, paths, counters, v)) ++batch.count;
        }
        if (batch.count == 0u) break;
        fill_arrays(&batch);
        if (NEED_LIGHTS) add_direct_light(frame, scene, &batch, depth, paths, &appends.shadow_rays);
        if (NEED_AMBIENT) {
            for (uint lane = 0u; lane < batch.count; ++lane)
                add_ambient(frame, &batch.vertices[lane], paths, &appends.points);
        }
        if (NEED_SPECULAR_PATHS) continue_paths(frame, scene, &batch, depth, paths, &appends.rays);
    }
    send(&appends.rays);
    send(&appends.shadow_rays);
    send(&appends.points);
}

kernel void shade(global const Frame* frame, global const SceneTriangle* triangles,
                  global const SceneMaterial* materials, global const AreaLight* area_lights,
                  global const PointLight* point_lights, global const uchar4* texels,
                  global const float* tables, global const float4* rays, global float4* paths,
                  global float4* next_rays, global float4* shadow_rays, global float4* points,
                  global uint* counters, uint count, uint depth) {
    const Share share = share_of(count, OUTBOX_ITEMS);
    if (share.first < share.last) {
        const SceneData scene = {triangles, materials, area_lights, point_lights, texels, tables};
        shade_rays(frame, &scene, rays, paths, next_rays, shadow_rays, points, counters, depth, share);
    }
}
