// SPDX-License-Identifier: Apache-2.0
// Stage film: adds the finished paths of a wave to the picture's sums.
//   Reads    the layers of the path slots
//   Writes   the layer sums of the pixel that the camera visits as number p: its slots, one for each pass, in their
//            order and with the rounding errors carried along, so that every cut of the samples into waves gives the
//            same bits. What the sums hold before the first pass doesn't matter.
#include "lib/layers.clh"
#include "lib/math.clh"
#include "lib/status.clh"

inline size_t film_index(global const Frame* frame, uint plane, uint pixel) {
    return (size_t)plane * frame->crop.z + pixel;
}

// Of the passes before this wave.
inline FilmSum sum_before(global const FilmSum* sums, size_t index, uint first_pass) {
    FilmSum s;
    s.sum = s.excess = (float4)(0.0f);
    return first_pass == 0u ? s : sums[index];
}

// The layer variance: squared deviations from the running mean (Welford 1962). The mean comes from the layers' sums
// before the wave, so that no cut changes it.
inline void add_deviations(global const Frame* frame, global const float4* paths, global FilmSum* sums,
                           uint pixel, uint first_pass, uint first_slot, uint last_slot) {
    FilmSum layers[BEAUTY_LAYERS];
    float3 total = (float3)(0.0f);
    for (uint layer = 0u; layer < BEAUTY_LAYERS; ++layer) {
        const uint plane = layer_plane(frame, layer);
        if (plane == NO_PLANE) continue;
        layers[layer] = sum_before(sums, film_index(frame, plane, pixel), first_pass);
        total += layers[layer].sum.xyz;
    }
    const size_t target = film_index(frame, layer_plane(frame, LAYER_VARIANCE), pixel);
    FilmSum deviations = sum_before(sums, target, first_pass);
    uint n = first_pass;
    for (uint slot = first_slot; slot < last_slot; ++slot) {
        float3 beauty = (float3)(0.0f);
        float3 next_total = (float3)(0.0f);
        for (uint layer = 0u; layer < BEAUTY_LAYERS; ++layer) {
            const uint plane = layer_plane(frame, layer);
            if (plane == NO_PLANE) continue;
            const float4 value = paths[path_index(frame, PATH_LAYERS + plane, slot)];
            beauty += value.xyz;
            add_compensated(&layers[layer].sum, &layers[layer].excess, value);
            next_total += layers[layer].sum.xyz;
        }
        if (n > 0u) {
            const float3 squares = (beauty - total / (float)n) * (beauty - next_total / (float)(n + 1u));
            add_compensated(&deviations.sum, &deviations.excess, (float4)(squares, 0.0f));
        }
        total = next_total;
        ++n;
    }
    sums[target] = deviations;
}

// The wave's passes over its pixels.
kernel void film(global const Frame* frame, global const float4* paths, global FilmSum* sums,
                 global uint* counters, uint first_pixel, uint pixel_count, uint first_pass,
                 uint pass_count) {
    const uint i = (uint)get_global_id(0);
    if (i >= pixel_count) return;
    const uint pixel = first_pixel + i;
    const uint first_slot = i * pass_count;
    const uint last_slot = first_slot + pass_count;
    if (has_layer(frame, LAYER_VARIANCE))
        add_deviations(frame, paths, sums, pixel, first_pass, first_slot, last_slot);
    const uint planes = layer_plane_count(frame);
    for (uint plane = 0u; plane < planes; ++plane) {
        if (plane == layer_plane(frame, LAYER_VARIANCE)) continue;
        const size_t target = film_index(frame, plane, pixel);
        FilmSum s = sum_before(sums, target, first_pass);
        for (uint slot = first_slot; slot < last_slot; ++slot) {
            const float4 value = paths[path_index(frame, PATH_LAYERS + plane, slot)];
            if (!all_finite(value.xyz)) report_failure(counters, STATUS_NOT_FINITE, STAGE_FILM, slot);
            add_compensated(&s.sum, &s.excess, value);
        }
        sums[target] = s;
    }
}
