// SPDX-License-Identifier: Apache-2.0
// Stage camera: starts the paths of a wave.
//   Reads    the wave's range of camera samples
//   Appends  nothing: sample i of the wave is path slot i and ray i
//   Writes   ray i, path slot i (throughput 1, layers 0)
// A wave is a run of samples in the order "all pixels of the crop for one sample, then the next sample"; so an
// interrupted render is a whole picture with fewer samples. The pixels are visited tile by tile (pixel_order), so that
// neighbours in a queue are neighbours in the picture. Pixel filters are sampled, not splatted (Ernst, Stamminger,
// Greiner 2006), which leaves every pixel one owner.
#include "lib/layers.clh"
#include "lib/math.clh"
#include "lib/sampler.clh"
#include "shared/bvh.h"
#include "shared/scene.h"

// Offset from the pixel's centre with the filter's density, from its tabulated inverse cdf; the box is exact.
inline float filter_offset(global const Frame* frame, global const float* tables, float u) {
    if (!frame_has(frame, FRAME_TABLE_FILTER)) return u - 0.5f;
    const float x = u * (float)FILTER_TABLE_SIZE;
    const uint i = min((uint)x, FILTER_TABLE_SIZE - 1u);
    global const float* offsets = tables + TABLE_FILTER;
    return mix(offsets[i], offsets[i + 1u], x - (float)i);
}

// first_pixel, first_pass: where in that order the wave starts; count: samples in it.
kernel void camera(global const Frame* frame, global const float* tables, global const uint* sample_order,
                   global const uint* pixel_order, global float4* rays, global float4* paths,
                   uint first_pixel, uint first_pass, uint count) {
    const uint slot = (uint)get_global_id(0);
    if (slot >= count) return;
    const uint pixels = frame->crop.z;
    const uint capacity = frame->crop.w;
    const uint position = first_pixel + slot;
    const uint pixel = pixel_order[position % pixels];
    const uint pass = first_pass + position / pixels;
    const uint x = frame->image.z + pixel % frame->crop.x;
    const uint y = frame->image.w + pixel / frame->crop.x;

    Sampler s;
    s.seed = pixel_seed(x, y, frame->seed.x);
    s.sample = sample_order[pass];
    const float2 u = unit_float2(sample_codes(frame, s, DIMENSION_PIXEL, 0u, 1u, frame->lattice.xy, false));
    const float px = (float)x + 0.5f + filter_offset(frame, tables, u.x);
    const float py = (float)y + 0.5f + filter_offset(frame, tables, u.y);
    const float sx = 2.0f * px / (float)frame->image.x - 1.0f;
    const float sy = 1.0f - 2.0f * py / (float)frame->image.y;

    float3 origin = frame->camera_origin.xyz;
    float3 direction = frame->camera_forward.xyz;
    const float3 shift = sx * frame->camera_right.xyz + sy * frame->camera_up.xyz;
    if (as_uint(frame->camera_origin.w) == CAMERA_ORTHOGRAPHIC) {
        origin += shift;
    } else {
        direction = normalize(direction + shift);
    }

    rays[RAY_ORIGIN * capacity + slot] = (float4)(origin, as_float(slot));
    rays[RAY_DIRECTION * capacity + slot] = (float4)(direction, 0.0f);
    paths[path_index(frame, PATH_THROUGHPUT, slot)] = (float4)(1.0f, 1.0f, 1.0f, 0.0f);
    paths[path_index(frame, PATH_SAMPLE, slot)] = as_float4((uint4)(s.seed, s.sample, pixel, 0u));
    const uint planes = layer_plane_count(frame);
    for (uint plane = 0u; plane < planes; ++plane) {
        paths[path_index(frame, PATH_LAYERS + plane, slot)] = (float4)(0.0f);
    }
}
