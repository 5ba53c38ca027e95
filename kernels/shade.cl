// SPDX-License-Identifier: Apache-2.0
// Stage shade: what happens where a ray hit.
//   Reads    ray i with its hit, the path slot
//   Appends  at most one continuation ray, one shadow ray per light sample, one obscurance point
//   Writes   of the path slot: throughput, emission, first-hit layers, ambient weight, the contribution that each
//            light sample makes if it is visible
// Direct light is sampled from the lights; glossy reflections of area lights combine both strategies by the power
// heuristic (Veach 1997, section 9.2). The diffuse lobe is never continued: obscurances stand for it.
#include "lib/bsdf.clh"
#include "lib/layers.clh"
#include "lib/lights.clh"
#include "lib/math.clh"
#include "lib/outbox.clh"
#include "lib/sampler.clh"
#include "lib/share.clh"
#include "lib/status.clh"
#include "shared/bvh.h"

// Everything about the hit that more than one step below needs.
typedef struct Vertex {
    Surface surface;
    float3 wo;  // local, to the viewer
    float3 tangent, bitangent;
    float3 base;      // base colour
    float3 f0, f90;   // of the specular lobe
    float3 diffuse;   // R_d(mu_o)
    float3 specular;  // a(mu_o): directional albedo of the specular lobe
    float alpha;
    float3 throughput;
    uint flags;  // MATERIAL_*
    uint slot;
    uint depth;
    Sampler sampler;
} Vertex;

inline bool frame_has(global const Frame* frame, uint flag) {
    return (frame->seed.w & flag) != 0u;
}

inline float power_heuristic(float pdf, float other_pdf) {
    const float ratio = other_pdf / pdf;
    return 1.0f / (1.0f + ratio * ratio);
}

// A glossy ray leaves this vertex, so light samples share the glossy lobe with it.
inline bool continues_glossy(global const Frame* frame, const Vertex* v) {
    return frame_has(frame, FRAME_SPECULAR) && v->depth < frame->seed.z;
}

// Weight of emission that a glossy ray found by itself, against the light samples that could have found it. t: from
// where the ray was scattered, its origin; shadow rays see through panes, as it did.
inline float emission_weight(global const Frame* frame, global const SceneTriangle* triangle,
                             global const AreaLight* area_lights, float pdf_sr, float t, float3 origin,
                             float3 direction) {
    const uint index = triangle->ids.z;
    if (!NEED_AREA_LIGHTS || !(pdf_sr > 0.0f) || index == NO_LIGHT) return 1.0f;
    global const AreaLight* light = area_lights + index;
    const float probability = area_light_probability(area_lights, frame->lights.x, index, origin);
    const float light_pdf =
        area_light_pdf_sr(probability, light->center.w, t * t, fabs(dot(direction, light->normal.xyz)));
    return power_heuristic(pdf_sr, light_pdf * (float)frame->sampling.z);
}

// Contribution of one light sample through both lobes, and its shadow ray if there is any.
inline void connect_light(global const Frame* frame, const Vertex* v, LightSample light, uint sample,
                          global float4* paths, Outbox* shadow_rays) {
    const Surface* surface = &v->surface;
    const float cosine = dot(light.direction, surface->n_shade);
    float3 diffuse = (float3)(0.0f);
    float3 glossy = (float3)(0.0f);
    if (cosine > 0.0f && dot(light.direction, surface->n_geo) > 0.0f &&
        max_component(light.radiance) > 0.0f) {
        const float3 arriving = v->throughput * light.radiance * (cosine / (float)frame->sampling.z);
        if (frame_has(frame, FRAME_DIRECT)) diffuse = arriving * v->diffuse * INV_PI;
        if (NEED_GLOSSY && (v->flags & MATERIAL_GLOSSY) != 0u && frame_has(frame, FRAME_SPECULAR)) {
            const float3 wi =
                (float3)(dot(light.direction, v->tangent), dot(light.direction, v->bitangent), cosine);
            float pdf_sr;
            const float3 brdf = evaluate_ggx(v->wo, wi, v->alpha, v->f0, v->f90, &pdf_sr);
            const bool shared_with_bsdf = light.pdf_sr > 0.0f && continues_glossy(frame, v);
            const float weight =
                shared_with_bsdf ? power_heuristic(light.pdf_sr * (float)frame->sampling.z, pdf_sr) : 1.0f;
            glossy = arriving * brdf * weight;
        }
    }
    paths[path_index(frame, light_lane(frame, sample, LOBE_DIFFUSE), v->slot)] = (float4)(diffuse, 0.0f);
    if (NEED_GLOSSY) {
        paths[path_index(frame, light_lane(frame, sample, LOBE_GLOSSY), v->slot)] = (float4)(glossy, 0.0f);
    }
    if (max_component(diffuse + glossy) > 0.0f) {
        const float3 origin = surface->position + surface->offset * surface->n_geo;
        post(shadow_rays, (float4)(origin, as_float(sample * frame->crop.w + v->slot)),
             (float4)(light.to_light, light.t_light), (float4)(0.0f));
    }
}

inline void sample_lights(global const Frame* frame, const Vertex* v, global const SceneTriangle* triangles,
                          global const SceneMaterial* materials, global const AreaLight* area_lights,
                          global const PointLight* point_lights, global float4* paths, Outbox* shadow_rays) {
    const uint count = frame->sampling.z;
    const bool selects = NEED_PUNCTUAL_LIGHTS || frame->lights.x > MAX_WEIGHED_LIGHTS;
    SampleSet selections, light_points;
    if (selects) {
        selections = make_sample_set(frame, v->sampler, dimension_at(v->depth, DIMENSION_SELECT_LIGHT), count,
                                     frame->lattice.zw, true);
    }
    if (NEED_AREA_LIGHTS) {
        light_points = make_sample_set(frame, v->sampler, dimension_at(v->depth, DIMENSION_AREA_LIGHT), count,
                                       frame->lattice.zw, true);
    }
    for (uint l = 0u; l < count; ++l) {
        const uint2 select = selects ? set_codes(&selections, l) : (uint2)(0u);
        uint sample = l;
        if (NEED_AREA_LIGHTS) {
            const float2 u = unit_float2(set_codes(&light_points, l));
            const LightSample light = sample_area_light(triangles, materials, area_lights, frame->lights.x,
                                                        &v->surface, u, select.x);
            connect_light(frame, v, light, sample, paths, shadow_rays);
            sample += count;
        }
        if (NEED_PUNCTUAL_LIGHTS) {
            const LightSample light =
                sample_punctual_light(point_lights, frame->lights.y, &v->surface, select.y);
            connect_light(frame, v, light, sample, paths, shadow_rays);
        }
    }
}

// Lobe, direction and weight of the ray that goes on; false if the path ends here.
inline bool sample_continuation(global const Frame* frame, const Vertex* v,
                                global const SceneMaterial* material, float3* direction, float* side,
                                float3* weight, float* pdf_sr) {
    const float2 choice = unit_float2(sample_codes(frame, v->sampler, dimension_at(v->depth, DIMENSION_LOBE),
                                                   0u, 1u, frame->lattice.xy, true));
    const Surface* s = &v->surface;
    const float3 mirrored_local = (float3)(-v->wo.x, -v->wo.y, v->wo.z);
    float3 local_direction = mirrored_local;
    float albedo;  // of everything that may be followed, for the roulette
    *pdf_sr = 0.0f;
    *side = 1.0f;
    if (NEED_TRANSMISSION && (v->flags & MATERIAL_PANE) != 0u) {
        // A pane reflects like a mirror or lets the ray pass straight on, one of them at random.
        const float transmission = material->f90.w;
        const float reflectance = pane_reflectance(v->wo.z);
        const float3 reflected = mix(fresnel(v->f0, v->f90, v->wo.z), (float3)(reflectance), transmission);
        const float3 passed = transmission * (1.0f - reflectance) * v->base;
        const float sum = mean_component(reflected) + mean_component(passed);
        const float p_reflect = mean_component(reflected) / sum;
        const bool reflects = choice.x < p_reflect;
        albedo = max_component(reflected + passed);
        *weight = reflects ? reflected / p_reflect : passed / (1.0f - p_reflect);
        if (!reflects) {
            local_direction = -v->wo;
            *side = -1.0f;
        }
    } else if (NEED_GLOSSY && (v->flags & MATERIAL_GLOSSY) != 0u) {
        const float2 u = unit_float2(sample_codes(frame, v->sampler, dimension_at(v->depth, DIMENSION_BSDF),
                                                  0u, 1u, frame->lattice.xy, true));
        albedo = max_component(v->specular);
        *weight = sample_ggx(v->wo, u, v->alpha, v->f0, v->f90, &local_direction, pdf_sr);
    } else if (NEED_MIRROR && (v->flags & MATERIAL_MIRROR) != 0u) {
        *weight = fresnel(v->f0, v->f90, v->wo.z);
        albedo = max_component(*weight);
    } else {
        return false;
    }

    // Weak lobes are followed now and then, with more weight: every dielectric has a reflection of a few per cent.
    const float follow =
        frame_has(frame, FRAME_ROULETTE) ? fmin(1.0f, 4.0f * albedo * max_component(v->throughput)) : 1.0f;
    if (!(choice.y < follow) || !(max_component(*weight) > 0.0f)) return false;
    *weight /= follow;

    const float3 world =
        local_direction.x * v->tangent + local_direction.y * v->bitangent + local_direction.z * s->n_shade;
    if (*side < 0.0f) {
        *direction = world;
        return true;
    }
    // Below the geometric surface only this strategy finds the light: no density to compare with.
    if (dot(world, s->n_geo) < 0.0f) *pdf_sr = 0.0f;
    *direction = normalize(reflect_above(world, s->n_geo));
    return true;
}

inline void write_first_hit(global const Frame* frame, const Vertex* v, global const SceneTriangle* triangle,
                            float4 hit, global float4* paths) {
    const Surface* s = &v->surface;
    const float depth = dot(s->position - frame->camera_origin.xyz, frame->camera_forward.xyz);
    add_to_layer(
        frame, paths, LAYER_POSITION, v->slot,
        frame->world_origin.w * (float4)(s->position, depth) + (float4)(frame->world_origin.xyz, 0.0f));
    add_to_layer(frame, paths, LAYER_NORMAL, v->slot, (float4)(s->n_geo, 0.0f));
    add_to_layer(frame, paths, LAYER_SHADING, v->slot, (float4)(s->n_shade, 0.0f));
    if (has_layer(frame, LAYER_UV)) {
        add_to_layer(frame, paths, LAYER_UV, v->slot,
                     (float4)(texture_coordinates(triangle, hit.y, hit.z), 0.0f, 0.0f));
    }
    add_to_layer(frame, paths, LAYER_ALBEDO, v->slot, (float4)(v->diffuse + v->specular, 0.0f));
}

// The local frame, lobes and albedos of a hit.
INLINED Vertex make_vertex(global const SceneTriangle* triangle, global const SceneMaterial* material,
                           global const uchar4* texels, global const float* tables, float3 direction,
                           float4 hit, float3 throughput) {
    Vertex v;
    v.surface = make_surface(triangle, hit.y, hit.z, direction);
    // A shading normal that faces away is bent until it sees the viewer at a grazing angle.
    const float3 to_viewer = -direction;
    const float facing = dot(v.surface.n_shade, to_viewer);
    if (facing < GRAZING_COSINE) {
        v.surface.n_shade = normalize(v.surface.n_shade + (GRAZING_COSINE - facing) * to_viewer);
    }
    make_basis(v.surface.n_shade, &v.tangent, &v.bitangent);
    v.wo = (float3)(dot(to_viewer, v.tangent), dot(to_viewer, v.bitangent),
                    fmax(GRAZING_COSINE, dot(to_viewer, v.surface.n_shade)));
    v.flags = material_flags(material);
    v.base = base_color(triangle, material, texels, tables, hit.y, hit.z);
    v.alpha = material->dielectric_f0.w;
    v.f0 = specular_f0(material, v.base);
    v.f90 = material->f90.xyz;
    v.specular = (v.flags & (MATERIAL_GLOSSY | MATERIAL_MIRROR)) != 0u
                     ? specular_albedo(tables, v.f0, v.f90, v.alpha, v.wo.z)
                     : (float3)(0.0f);
    v.diffuse = v.base * material->diffuse_scale.xyz * (1.0f - v.specular);
    v.throughput = throughput;
    return v;
}

// What is appended on its way into the queues.
typedef struct Appends {
    Outbox rays, shadow_rays, points;
} Appends;

inline void shade_ray(global const Frame* frame, global const SceneTriangle* triangles,
                      global const SceneMaterial* materials, global const AreaLight* area_lights,
                      global const PointLight* point_lights, global const uchar4* texels,
                      global const float* tables, global const float4* rays, uint i, uint depth,
                      global float4* paths, Appends* appends, global uint* counters) {
    const uint capacity = frame->crop.w;
    const float4 origin = rays[RAY_ORIGIN * capacity + i];
    const uint slot = as_uint(origin.w);
    if (!check_slot(counters, slot, capacity, STAGE_SHADE, i)) return;
    const float4 ray_direction = rays[RAY_DIRECTION * capacity + i];
    const float3 direction = ray_direction.xyz;
    const float4 hit = rays[RAY_HIT * capacity + i];
    const float4 throughput = paths[path_index(frame, PATH_THROUGHPUT, slot)];
    const uint4 sample = as_uint4(paths[path_index(frame, PATH_SAMPLE, slot)]);
    const uint emission_layer = depth == 0u ? LAYER_EMISSION : LAYER_SPECULAR_EMISSION;

    // What gather reads, for the paths that end here.
    paths[path_index(frame, PATH_AMBIENT, slot)] = (float4)(0.0f);
    const uint primitive = as_uint(hit.w);
    if (primitive == NO_PRIMITIVE) {
        clear_light_lanes(frame, paths, slot);
        if (NEED_BACKGROUND) {
            add_to_layer(frame, paths, emission_layer, slot,
                         (float4)(throughput.xyz * frame->background.xyz, 0.0f));
        }
        return;
    }

    global const SceneTriangle* triangle = triangles + primitive;
    global const SceneMaterial* material = materials + triangle->ids.x;
    Vertex v = make_vertex(triangle, material, texels, tables, direction, hit, throughput.xyz);
    v.slot = slot;
    v.depth = depth;
    v.sampler.seed = sample.x;
    v.sampler.sample = sample.y;
    const Surface* s = &v.surface;

    const bool unlit = (v.flags & MATERIAL_UNLIT) != 0u;
    float3 emitted = (float3)(0.0f);
    if (NEED_EMISSION) {
        emitted =
            unlit ? v.base
                  : emitted_radiance(material, s->front) *
                        emission_weight(frame, triangle, area_lights, throughput.w, hit.x + ray_direction.w,
                                        origin.xyz - ray_direction.w * direction, direction);
    }
    add_to_layer(frame, paths, emission_layer, slot,
                 (float4)(v.throughput * emitted, depth == 0u ? 1.0f : 0.0f));
    if (depth == 0u) write_first_hit(frame, &v, triangle, hit, paths);
    if (unlit) {
        clear_light_lanes(frame, paths, slot);
        return;
    }

    if (NEED_LIGHTS) {
        sample_lights(frame, &v, triangles, materials, area_lights, point_lights, paths,
                      &appends->shadow_rays);
    }
    if (NEED_AMBIENT && frame_has(frame, FRAME_AMBIENT) && max_component(v.diffuse) > 0.0f) {
        const bool traced = NEED_OBSCURANCE && frame_has(frame, FRAME_OBSCURANCE);
        paths[path_index(frame, PATH_AMBIENT, slot)] = (float4)(v.throughput * v.diffuse * frame->ambient.xyz,
                                                                traced ? AMBIENT_TRACED : AMBIENT_CONSTANT);
        if (traced) {
            post(&appends->points, (float4)(s->position, as_float(slot)), (float4)(s->n_geo, s->offset),
                 (float4)(s->n_shade, 0.0f));
        }
    }
    if (NEED_SPECULAR_PATHS && continues_glossy(frame, &v)) {
        float3 next_direction, weight;
        float side, pdf_sr;
        if (sample_continuation(frame, &v, material, &next_direction, &side, &weight, &pdf_sr)) {
            const float3 next_origin = s->position + (side * s->offset) * s->n_geo;
            // A ray that passes a pane straight on is still the one that was scattered before it.
            const bool passes = side < 0.0f;
            post(&appends->rays, (float4)(next_origin, as_float(slot)),
                 (float4)(next_direction, passes ? ray_direction.w + hit.x : 0.0f), (float4)(0.0f));
            if (passes) pdf_sr = throughput.w;
            paths[path_index(frame, PATH_THROUGHPUT, slot)] = (float4)(v.throughput * weight, pdf_sr);
        }
    }
}

SHARE_FUNCTION shade_rays(global const Frame* frame, global const SceneTriangle* triangles,
                          global const SceneMaterial* materials, global const AreaLight* area_lights,
                          global const PointLight* point_lights, global const uchar4* texels,
                          global const float* tables, global const float4* rays, global float4* paths,
                          global float4* next_rays, global float4* shadow_rays, global float4* points,
                          global uint* counters, uint depth, Share share) {
    const uint capacity = frame->crop.w;
    Appends appends;
    open_outbox(&appends.rays, next_rays, 2u, capacity, &counters[COUNT_RAYS]);
    open_outbox(&appends.shadow_rays, shadow_rays, SHADOW_LANES, capacity * light_sample_count(frame),
                &counters[COUNT_SHADOWS]);
    open_outbox(&appends.points, points, POINT_LANES, capacity, &counters[COUNT_POINTS]);
    for (uint i = share.first; i < share.last; ++i)
        shade_ray(frame, triangles, materials, area_lights, point_lights, texels, tables, rays, i, depth,
                  paths, &appends, counters);
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
        shade_rays(frame, triangles, materials, area_lights, point_lights, texels, tables, rays, paths,
                   next_rays, shadow_rays, points, counters, depth, share);
    }
}
