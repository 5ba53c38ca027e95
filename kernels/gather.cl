// SPDX-License-Identifier: Apache-2.0
// Stage gather: adds what the shadow and obscurance rays of a depth found to the path's layers.
//   Reads    ray i's slot, its light contributions and their visibility, its K obscurance results
//   Writes   direct, specular.* and ambient layers of the slot; the obscurance layer once per path. At depth 0 it starts
//            them all, whatever the slot held
// Sums run in fixed order, whatever order the queues were filled in.
#include "lib/layers.clh"
#include "lib/math.clh"

// What the vertex of this depth reflects.
typedef struct Reflected {
    float3 diffuse, glossy;  // from the lights
    float3 ambient;
    float4 obscurance;   // rgb: W; w: without colours
    bool first_diffuse;  // it is the path's first with a diffuse part: obscurance counts
} Reflected;

inline void gather_lights(global const Frame* frame, global const float4* visibility,
                          global const float4* paths, uint slot, Reflected* sum) {
    const uint count = light_sample_count(frame);
    for (uint sample = 0u; sample < count; ++sample) {
        const float3 d = paths[path_index(frame, light_lane(frame, sample, LOBE_DIFFUSE), slot)].xyz;
        const float3 g = NEED_GLOSSY
                             ? paths[path_index(frame, light_lane(frame, sample, LOBE_GLOSSY), slot)].xyz
                             : (float3)(0.0f);
        // Without a contribution there was no shadow ray, and visibility holds nothing.
        if (!(max_component(d + g) > 0.0f)) continue;
        const float3 seen = visibility[sample * frame->crop.w + slot].xyz;
        sum->diffuse += d * seen;
        sum->glossy += g * seen;
    }
}

// Compensated: open directions all add the same number, whose rounding errors would pile up.
inline float4 sum_results(global const float4* results, uint count) {
    float4 sum = (float4)(0.0f);
    float4 excess = (float4)(0.0f);
    for (uint k = 0u; k < count; ++k)
        add_compensated(&sum, &excess, results[k]);
    return sum;
}

inline void gather_ambient(global const Frame* frame, global const float4* results, global float4* paths,
                           uint slot, Reflected* sum) {
    const float4 ambient = paths[path_index(frame, PATH_AMBIENT, slot)];
    if (ambient.w == 0.0f) return;
    float4 w = (float4)(1.0f);
    if (NEED_OBSCURANCE && ambient.w == AMBIENT_TRACED) {
        const uint k_count = frame->sampling.y;
        w = sum_results(results + (size_t)slot * k_count, k_count) / frame->miss.w;
        const size_t sample = path_index(frame, PATH_SAMPLE, slot);
        if (has_layer(frame, LAYER_OBSCURANCE) && (as_uint(paths[sample].w) & PATH_OBSCURANCE_SEEN) == 0u) {
            sum->obscurance = w;
            sum->first_diffuse = true;
            paths[sample].w = as_float(as_uint(paths[sample].w) | PATH_OBSCURANCE_SEEN);
        }
    }
    sum->ambient = ambient.xyz * w.xyz;
}

inline void start_layers(global const Frame* frame, global float4* paths, uint slot, const Reflected* sum) {
    start_layer(frame, paths, LAYER_DIRECT, slot, (float4)(sum->diffuse, 0.0f));
    start_layer(frame, paths, LAYER_AMBIENT, slot, (float4)(sum->ambient, 0.0f));
    start_layer(frame, paths, LAYER_SPECULAR_EMISSION, slot, (float4)(sum->glossy, 0.0f));
    start_layer(frame, paths, LAYER_SPECULAR_DIRECT, slot, (float4)(0.0f));
    start_layer(frame, paths, LAYER_SPECULAR_AMBIENT, slot, (float4)(0.0f));
    start_layer(frame, paths, LAYER_OBSCURANCE, slot, sum->obscurance);
}

inline void add_to_layers(global const Frame* frame, global float4* paths, uint slot, const Reflected* sum) {
    add_to_layer(frame, paths, LAYER_SPECULAR_DIRECT, slot, (float4)(sum->diffuse, 0.0f));
    add_to_layer(frame, paths, LAYER_SPECULAR_AMBIENT, slot, (float4)(sum->ambient, 0.0f));
    // A light's reflection in a glossy surface is the light seen by reflection, however it was sampled.
    if (NEED_GLOSSY) add_to_layer(frame, paths, LAYER_SPECULAR_EMISSION, slot, (float4)(sum->glossy, 0.0f));
    if (sum->first_diffuse) add_to_layer(frame, paths, LAYER_OBSCURANCE, slot, sum->obscurance);
}

kernel void gather(global const Frame* frame, global const float4* rays, global const float4* visibility,
                   global const float4* results, global float4* paths, uint count, uint depth) {
    const uint i = (uint)get_global_id(0);
    if (i >= count) return;
    const uint slot = as_uint(rays[RAY_ORIGIN * frame->crop.w + i].w);
    if (slot >= frame->crop.w) return;  // shade has reported it
    Reflected sum;
    sum.diffuse = sum.glossy = sum.ambient = (float3)(0.0f);
    sum.obscurance = (float4)(0.0f);
    sum.first_diffuse = false;
    if (NEED_LIGHTS) gather_lights(frame, visibility, paths, slot, &sum);
    if (NEED_AMBIENT) gather_ambient(frame, results, paths, slot, &sum);
    if (depth == 0u) {
        start_layers(frame, paths, slot, &sum);
    } else {
        add_to_layers(frame, paths, slot, &sum);
    }
}
