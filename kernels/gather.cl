// SPDX-License-Identifier: Apache-2.0
// Stage gather: adds what the shadow and obscurance rays of a depth found to the path's layers.
//   Reads    ray i's slot, its light contributions and their visibility, its K obscurance results
//   Writes   direct, specular.* and ambient layers of the slot; the obscurance layer once per path
// Sums run in fixed order, whatever order the queues were filled in.
#include "lib/layers.clh"
#include "lib/math.clh"

inline void gather_lights(global const Frame* frame, global const float4* visibility, global float4* paths,
                          uint slot, uint depth) {
    float3 diffuse = (float3)(0.0f);
    float3 glossy = (float3)(0.0f);
    const uint count = light_sample_count(frame);
    for (uint sample = 0u; sample < count; ++sample) {
        const float3 d = paths[path_index(frame, light_lane(frame, sample, LOBE_DIFFUSE), slot)].xyz;
        const float3 g = NEED_GLOSSY
                             ? paths[path_index(frame, light_lane(frame, sample, LOBE_GLOSSY), slot)].xyz
                             : (float3)(0.0f);
        // Without a contribution there was no shadow ray, and visibility holds nothing.
        if (!(max_component(d + g) > 0.0f)) continue;
        const float3 seen = visibility[sample * frame->crop.w + slot].xyz;
        diffuse += d * seen;
        glossy += g * seen;
    }
    add_to_layer(frame, paths, depth == 0u ? LAYER_DIRECT : LAYER_SPECULAR_DIRECT, slot,
                 (float4)(diffuse, 0.0f));
    // A light's reflection in a glossy surface is the light seen by reflection, however it was sampled.
    if (NEED_GLOSSY) add_to_layer(frame, paths, LAYER_SPECULAR_EMISSION, slot, (float4)(glossy, 0.0f));
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
                           uint slot, uint depth) {
    const float4 ambient = paths[path_index(frame, PATH_AMBIENT, slot)];
    if (ambient.w == 0.0f) return;
    float4 w = (float4)(1.0f);
    if (NEED_OBSCURANCE && ambient.w == AMBIENT_TRACED) {
        const uint k_count = frame->sampling.y;
        const float4 sum = sum_results(results + (size_t)slot * k_count, k_count);
        w = sum / frame->miss.w;
        const size_t sample = path_index(frame, PATH_SAMPLE, slot);
        if (has_layer(frame, LAYER_OBSCURANCE) && (as_uint(paths[sample].w) & PATH_OBSCURANCE_SEEN) == 0u) {
            add_to_layer(frame, paths, LAYER_OBSCURANCE, slot, w);
            paths[sample].w = as_float(as_uint(paths[sample].w) | PATH_OBSCURANCE_SEEN);
        }
    }
    add_to_layer(frame, paths, depth == 0u ? LAYER_AMBIENT : LAYER_SPECULAR_AMBIENT, slot,
                 (float4)(ambient.xyz * w.xyz, 0.0f));
}

kernel void gather(global const Frame* frame, global const float4* rays, global const float4* visibility,
                   global const float4* results, global float4* paths, uint count, uint depth) {
    const uint i = (uint)get_global_id(0);
    if (i >= count) return;
    const uint slot = as_uint(rays[RAY_ORIGIN * frame->crop.w + i].w);
    if (slot >= frame->crop.w) return;  // shade has reported it
    if (NEED_LIGHTS) gather_lights(frame, visibility, paths, slot, depth);
    if (NEED_AMBIENT) gather_ambient(frame, results, paths, slot, depth);
}
