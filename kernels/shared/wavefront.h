// SPDX-License-Identifier: Apache-2.0
// Work items, path slots, layers and counters of the wavefront. A queue is one buffer of 16-byte lanes,
// queue[lane * capacity + i]: structure of arrays without a second definition. Included by C++20 and OpenCL C.
#ifndef OBSCURA_SHARED_WAVEFRONT_H
#define OBSCURA_SHARED_WAVEFRONT_H

#include "shared/types.h"

// --- Queues ------------------------------------------------------------------------------------------------
// Ray: camera and glossy rays. Directions are unit vectors, t runs over (0, inf).
#define RAY_ORIGIN 0     // xyz: world position; w: path slot (uint bits)
#define RAY_DIRECTION 1  // xyz: unit direction; w: way through panes since the last scattering, m
#define RAY_HIT 2        // t, u, v (weights of corners 1 and 2), primitive (uint bits; NO_PRIMITIVE = miss)
#define RAY_LANES 3

// Shadow ray: from a surface to a light. It is free when nothing lies at t in (0, direction.w).
#define SHADOW_ORIGIN 0  // xyz: world position; w: result index, light sample * capacity + slot (uint bits)
#define SHADOW_DIRECTION 1  // xyz: towards the light, not normalised; w: t of the light, 1 or +inf
#define SHADOW_LANES 2

// Obscurance point: the origin of K cosine-distributed rays.
#define POINT_POSITION 0  // xyz: P; w: path slot (uint bits)
#define POINT_NORMAL 1    // xyz: n_geo on the side of the viewer; w: offset of the ray origins along it
#define POINT_SHADING 2   // xyz: n_shade on the side of the viewer; w: unused
#define POINT_LANES 3

// --- Path slots: one per camera sample of the wave, slot = sample's index in the wave -----------------------
// rgb: weight of the path so far; w: pdf_sr of the last glossy direction, 0 = mirror or camera. Passing a pane keeps it.
#define PATH_THROUGHPUT 0
// uint bits: pixel seed, sample index, pixel's index in the crop, PATH_* flags.
#define PATH_SAMPLE 1
#define PATH_OBSCURANCE_SEEN 1u  // flag: the obscurance layer of this path is written
// rgb: what W is multiplied by; w: 0 = no ambient light here, or AMBIENT_*.
#define PATH_AMBIENT 2
#define AMBIENT_CONSTANT 1.0f  // W = 1
#define AMBIENT_TRACED 2.0f    // W from the obscurance results
// First of the kept layers (below). After them the light samples: for each the contribution (rgb) that it makes
// if it is visible, through the diffuse lobe and, where the scene has glossy ones, through the glossy lobe.
#define PATH_LAYERS 3

// --- Layers: beauty is the sum of the first six; the others are means of the first hit ----------------------
#define LAYER_EMISSION 0           // rgb; w: coverage (alpha)
#define LAYER_DIRECT 1             // rgb
#define LAYER_AMBIENT 2            // rgb
#define LAYER_SPECULAR_EMISSION 3  // rgb: lights and sky reflected by glossy surfaces
#define LAYER_SPECULAR_DIRECT 4    // rgb
#define LAYER_SPECULAR_AMBIENT 5   // rgb
#define BEAUTY_LAYERS 6
#define LAYER_OBSCURANCE 6  // rgb: W; w: colourless W, both at the first hit with a diffuse part
#define LAYER_POSITION 7    // xyz: first hit; w: distance along the camera's axis
#define LAYER_NORMAL 8      // xyz: geometric normal of the first hit; w: unused
#define LAYER_SHADING 9     // xyz: shading normal of the first hit; w: unused
#define LAYER_ALBEDO 10     // rgb: diffuse + specular albedo of the first hit; w: unused
#define LAYER_UV 11         // x: u, y: v, texture coordinates of the first hit; z, w: unused
// rgb: sum of squared deviations of the samples' beauty from their mean. Only film fills it; path slots leave room for it.
#define LAYER_VARIANCE 12
#define LAYER_COUNT 13

// --- Counters and the first failure, read by the host once per depth ----------------------------------------
#define COUNT_RAYS 0     // continuation rays appended for the next depth
#define COUNT_SHADOWS 1  // shadow rays appended at this depth
#define COUNT_POINTS 2   // obscurance points appended at this depth
#define STATUS_CODE 3    // STATUS_*; the first failure wins
#define STATUS_ITEM 4    // its work item
#define STATUS_STAGE 5   // STAGE_*
#define STATUS_WORDS 8

#define STATUS_OK 0u
#define STATUS_NOT_FINITE 1u      // a NaN or infinite contribution
#define STATUS_STACK_OVERFLOW 2u  // the traversal's stack
#define STATUS_BAD_SLOT 3u        // an item's path slot or result index beyond what there is

#define STAGE_CAMERA 0u
#define STAGE_TRACE 1u
#define STAGE_SHADE 2u
#define STAGE_SHADOW 3u
#define STAGE_OBSCURANCE 4u
#define STAGE_GATHER 5u
#define STAGE_FILM 6u

#ifdef __cplusplus
namespace obscura {
#endif

// A layer of a pixel in the film. A float alone stops growing at 2^24 terms of one size.
typedef struct FilmSum {
    f32x4 sum;
    f32x4 excess;  // what rounding has made the sum too large by (Kahan)
} FilmSum;

#ifdef __cplusplus
static_assert(sizeof(FilmSum) == 32, "device layout");
}  // namespace obscura
#endif

#endif
