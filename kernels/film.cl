// SPDX-License-Identifier: Apache-2.0
// Stage film: adds the finished paths of a wave to the picture's sums.
//   Reads    the layers of the path slots
//   Writes   the layer sums of pixel p of the wave; its slots p, p + pixels, p + 2 pixels ... in that order, so that
//            every cut of the samples into waves gives the same bits
#include "lib/layers.clh"
#include "lib/math.clh"
#include "lib/status.clh"

// first_pixel: pixel of slot 0; count: samples in the wave.
kernel void film(global const Frame* frame, global const float4* paths, global float4* sums,
                 global uint* counters, uint first_pixel, uint count) {
    const uint first_slot = (uint)get_global_id(0);
    const uint pixels = frame->crop.z;
    if (first_slot >= min(count, pixels)) return;
    const uint pixel = (first_pixel + first_slot) % pixels;
    const uint planes = layer_plane_count(frame);
    for (uint plane = 0u; plane < planes; ++plane) {
        const size_t target = (size_t)plane * pixels + pixel;
        float4 sum = sums[target];
        for (uint slot = first_slot; slot < count; slot += pixels) {
            const float4 value = paths[path_index(frame, PATH_LAYERS + plane, slot)];
            if (!all_finite(value.xyz)) report_failure(counters, STATUS_NOT_FINITE, STAGE_FILM, slot);
            sum += value;
        }
        sums[target] = sum;
    }
}
