// SPDX-License-Identifier: Apache-2.0
// The constants of one render, uploaded once. Values are always arguments, never compiled in.
// Included by C++20 and OpenCL C.
#ifndef OBSCURA_SHARED_FRAME_H
#define OBSCURA_SHARED_FRAME_H

#include "shared/types.h"

#define CAMERA_PERSPECTIVE 0u
#define CAMERA_ORTHOGRAPHIC 1u

#define SAMPLER_LATTICE 1u  // as SamplerKind on the host
#define SAMPLER_OWEN 2u
#define SAMPLER_RANDOM 3u

#define NO_PLANE 0xffffffffu

#define FALLOFF_STEP 0u  // as FalloffKind on the host
#define FALLOFF_LINEAR 1u
#define FALLOFF_SQRT 2u
#define FALLOFF_CBRT 3u
#define FALLOFF_EXP 4u
#define FALLOFF_EXPJUMP 5u
#define FALLOFF_POW 6u

#define FRAME_ROULETTE 1u       // follow glossy rays with a probability
#define FRAME_DIRECT 2u         // diffuse direct light
#define FRAME_SPECULAR 4u       // glossy, mirror and pane continuations
#define FRAME_AMBIENT 8u        // an ambient term
#define FRAME_OBSCURANCE 16u    // ... weighted by traced obscurance (else W = 1)
#define FRAME_BLEEDING 32u      // obscurance rays carry R(Q)
#define FRAME_TABLE_FILTER 64u  // pixel offsets from the inverse cdf in the tables (else the box)

#ifdef __cplusplus
namespace obscura {
#endif

typedef struct Frame {
    // Camera: ray direction = forward + sx right + sy up with s over [-1, 1] (perspective), or the origin moves.
    f32x4 camera_origin;   // xyz; w: CAMERA_* (uint bits)
    f32x4 camera_right;    // xyz, scaled to the half width; w: unused
    f32x4 camera_up;       // xyz, scaled to the half height; w: unused
    f32x4 camera_forward;  // xyz, unit; w: unused
    u32x4 image;           // full width, full height (pixels), crop x0, crop y0
    u32x4 crop;            // crop width, crop height, pixels in the crop, capacity of the path slots
    u32x4 sampling;        // spp, K obscurance rays, L light samples per group, SAMPLER_*
    u32x4 seed;            // seed, bits needed to hold spp - 1, max_depth, FRAME_* flags
    u32x4 lattice;         // steps in units of 2^-32: pixel set x, y; light set x, y
    u32x4 lattice_points;  // obscurance set x, y; unused
    f32x4 obscurance;      // d_max (finite or inf), 1 / d_max, falloff parameter, 1 / falloff normalisation
    f32x4 miss;  // rgb: what an open direction contributes to W (R_ave, or 1 without bleeding); w: K as float
    f32x4 ambient;       // rgb: I_A; w: unused
    f32x4 background;    // rgb: radiance of the sky; w: unused
    u32x4 lights;        // emissive triangles, punctual lights, FALLOFF_*, unused
    f32x4 world_origin;  // xyz: world position of the coordinates' zero, m; w: their unit, m
    u32x4 plane[4];  // plane of each LAYER_* in path slots and film (NO_PLANE = not kept); [13]: their number
} Frame;

#ifdef __cplusplus
static_assert(sizeof(Frame) == 320, "device layout");
}  // namespace obscura
#endif

#endif
