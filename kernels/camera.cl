// SPDX-License-Identifier: Apache-2.0
// Stage camera: starts the paths of a wave.
//   Reads    the wave's range of pixels and passes
//   Appends  nothing: sample i of the wave is path slot i and ray i
//   Writes   ray i, of path slot i throughput 1 and the sample; its layers start at depth 0
// A wave is some passes over a range of pixels; a pixel's samples are neighbours in it. The pixels are visited tile by
// tile (pixel_order), so that neighbours in a queue are neighbours in the picture. Pixel filters are sampled, not
// splatted (Ernst, Stamminger, Greiner 2006), which leaves every pixel one owner. Samples are made in batches (lib/batch.clh).
#include "lib/layers.clh"
#include "lib/math.clh"
#include "lib/sample_batch.clh"
#include "lib/share.clh"
#include "shared/bvh.h"
#include "shared/scene.h"

// Camera samples in a row: the first `count`. In the arrays, the first one's values fill what is left.
typedef struct CameraBatch {
    uint count;
    SamplerBatch samplers;
    uint pixel[BATCH];         // in the crop
    float x[BATCH], y[BATCH];  // of the pixel's corner in the image, then of the sample
} CameraBatch;

// Passes over pixels, in the order of visits.
typedef struct PassRange {
    uint first_pixel, first_pass, pass_count;
} PassRange;

// first: counted from the wave's first sample.
inline void find_pixels(global const Frame* frame, global const uint* sample_order,
                        global const uint* pixel_order, PassRange wave, uint first, CameraBatch* batch) {
    FOR_BATCH(lane) {
        const uint sample = first + (lane < batch->count ? lane : 0u);
        const uint pixel = pixel_order[wave.first_pixel + sample / wave.pass_count];
        const uint x = frame->image.z + pixel % frame->crop.x;
        const uint y = frame->image.w + pixel / frame->crop.x;
        batch->pixel[lane] = pixel;
        batch->x[lane] = (float)x;
        batch->y[lane] = (float)y;
        batch->samplers.seed[lane] = pixel_seed(x, y, frame->seed.x);
        batch->samplers.sample[lane] = sample_order[wave.first_pass + sample % wave.pass_count];
    }
}

// Moves positions from the corners of their pixels to where the filter's density puts the samples, from its tabulated
// inverse cdf; the box is exact.
inline void add_filter_offsets(global const Frame* frame, global const float* tables, const uint* codes,
                               float* positions) {
    if (!frame_has(frame, FRAME_TABLE_FILTER)) {
        FOR_BATCH(lane) positions[lane] = positions[lane] + 0.5f + (unit_float(codes[lane]) - 0.5f);
        return;
    }
    global const float* offsets = tables + TABLE_FILTER;
    FOR_BATCH(lane) {
        const float u = unit_float(codes[lane]) * (float)FILTER_TABLE_SIZE;
        const uint i = min((uint)u, FILTER_TABLE_SIZE - 1u);
        positions[lane] = positions[lane] + 0.5f + mix(offsets[i], offsets[i + 1u], u - (float)i);
    }
}

// Origins and directions of the rays through points of the image.
inline void make_rays(global const Frame* frame, const CameraBatch* batch, VectorBatch* origins,
                      VectorBatch* directions) {
    const float3 eye = frame->camera_origin.xyz;
    const float3 forward = frame->camera_forward.xyz;
    const float3 right = frame->camera_right.xyz;
    const float3 up = frame->camera_up.xyz;
    const bool orthographic = as_uint(frame->camera_origin.w) == CAMERA_ORTHOGRAPHIC;
    const float width = (float)frame->image.x;
    const float height = (float)frame->image.y;
    FOR_BATCH(lane) {
        const float sx = 2.0f * batch->x[lane] / width - 1.0f;
        const float sy = 1.0f - 2.0f * batch->y[lane] / height;
        const float shift_x = sx * right.x + sy * up.x;
        const float shift_y = sx * right.y + sy * up.y;
        const float shift_z = sx * right.z + sy * up.z;
        const float x = forward.x + shift_x;
        const float y = forward.y + shift_y;
        const float z = forward.z + shift_z;
        const float scale = rsqrt(x * x + y * y + z * z);
        origins->x[lane] = orthographic ? eye.x + shift_x : eye.x;
        origins->y[lane] = orthographic ? eye.y + shift_y : eye.y;
        origins->z[lane] = orthographic ? eye.z + shift_z : eye.z;
        directions->x[lane] = orthographic ? forward.x : x * scale;
        directions->y[lane] = orthographic ? forward.y : y * scale;
        directions->z[lane] = orthographic ? forward.z : z * scale;
    }
}

inline void start_paths(global const Frame* frame, const CameraBatch* batch, const VectorBatch* origins,
                        const VectorBatch* directions, uint first_slot, global float4* rays,
                        global float4* paths) {
    const uint capacity = frame->crop.w;
    for (uint lane = 0u; lane < batch->count; ++lane) {
        const uint slot = first_slot + lane;
        rays[RAY_ORIGIN * capacity + slot] = (float4)(get_vector(origins, lane), as_float(slot));
        rays[RAY_DIRECTION * capacity + slot] = (float4)(get_vector(directions, lane), 0.0f);
        paths[path_index(frame, PATH_THROUGHPUT, slot)] = (float4)(1.0f, 1.0f, 1.0f, 0.0f);
        paths[path_index(frame, PATH_SAMPLE, slot)] = as_float4(
            (uint4)(batch->samplers.seed[lane], batch->samplers.sample[lane], batch->pixel[lane], 0u));
    }
}

SHARE_FUNCTION make_camera_samples(global const Frame* frame, global const float* tables,
                                   global const uint* sample_order, global const uint* pixel_order,
                                   global float4* rays, global float4* paths, PassRange wave, Share share) {
    CameraBatch batch;
    for (uint slot = share.first; slot < share.last; slot += BATCH) {
        batch.count = min(BATCH, share.last - slot);
        find_pixels(frame, sample_order, pixel_order, wave, slot, &batch);
        SampleSetBatch sets;
        CodeBatch codes;
        make_sample_sets(frame, &batch.samplers, DIMENSION_PIXEL, 1u, frame->lattice.xy, false, &sets);
        draw_codes(&sets, 0u, &codes);
        add_filter_offsets(frame, tables, codes.x, batch.x);
        add_filter_offsets(frame, tables, codes.y, batch.y);
        VectorBatch origins, directions;
        make_rays(frame, &batch, &origins, &directions);
        start_paths(frame, &batch, &origins, &directions, slot, rays, paths);
    }
}

// count: samples of the wave.
kernel void camera(global const Frame* frame, global const float* tables, global const uint* sample_order,
                   global const uint* pixel_order, global float4* rays, global float4* paths,
                   uint first_pixel, uint first_pass, uint pass_count, uint count) {
    const Share share = share_of(count, 256u);
    if (share.first < share.last) {
        const PassRange wave = {first_pixel, first_pass, pass_count};
        make_camera_samples(frame, tables, sample_order, pixel_order, rays, paths, wave, share);
    }
}
