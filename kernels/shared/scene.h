// SPDX-License-Identifier: Apache-2.0
// The scene as the device reads it: triangles for shading, materials, lights, tables. Tracing uses only
// shared/bvh.h. Included by C++20 and OpenCL C.
#ifndef OBSCURA_SHARED_SCENE_H
#define OBSCURA_SHARED_SCENE_H

#include "shared/types.h"

#define NO_LIGHT 0xffffffffu

// Up to this many emissive triangles are weighed one by one at each receiver; more are picked by power alone.
#define MAX_WEIGHED_LIGHTS 32u

#define TRIANGLE_SMOOTH 1u  // vertex normals differ from the geometric normal

// In one word with the texture's bits. Beside floats a word of few bits would be a denormal number, and what is computed with
// all four components of a vector takes many times as long for one of those.
#define MATERIAL_DOUBLE_SIDED 0x100u
#define MATERIAL_UNLIT 0x200u
#define MATERIAL_MIRROR 0x400u  // a specular lobe without roughness
#define MATERIAL_GLOSSY 0x800u  // a specular lobe with roughness
#define MATERIAL_PANE 0x1000u   // lit, transmission > 0: a thin clear pane

#define TEXTURE_WRAP_REPEAT 0u
#define TEXTURE_WRAP_MIRROR 1u
#define TEXTURE_WRAP_CLAMP 2u
#define TEXTURE_WRAP_V_SHIFT 2u  // bits 0-1 wrap of u, bits 2-3 wrap of v
#define TEXTURE_LINEAR 16u       // bilinear, else nearest

#define LIGHT_POINT 0u
#define LIGHT_SPOT 1u
#define LIGHT_DIRECTIONAL 2u

// Tables buffer (floats): directional albedo of GGX, then the pixel filter's inverse cdf.
#define ALBEDO_TABLE_SIZE 32u  // (A, B) pairs, row = roughness, column = mu
#define ALBEDO_TABLE_FLOATS (2u * ALBEDO_TABLE_SIZE * ALBEDO_TABLE_SIZE)
#define SRGB_TABLE_FLOATS 256u  // linear value of each 8-bit sRGB code
#define FILTER_TABLE_SIZE 128u  // intervals; FILTER_TABLE_SIZE + 1 offsets in pixels from the centre
#define TABLE_ALBEDO 0u
#define TABLE_SRGB (TABLE_ALBEDO + ALBEDO_TABLE_FLOATS)
#define TABLE_FILTER (TABLE_SRGB + SRGB_TABLE_FLOATS)
#define TABLE_FLOATS (TABLE_FILTER + FILTER_TABLE_SIZE + 1u)

#ifdef __cplusplus
namespace obscura {
#endif

// 128 bytes: two cache lines, of which only smooth and textured triangles need the second.
// ids: material, index into the area lights or NO_LIGHT, TRIANGLE_* flags, longest edge in m (float bits).
typedef struct SceneTriangle {
    f32x4 corner[3];  // xyz: world position, m; w: x, y, z of the unit normal that the winding gives
    u32x4 ids;
    f32x4 normal[3];  // xyz: unit vertex normal (used when TRIANGLE_SMOOTH); w: u of the texture coordinates
    f32x4 v;          // xyz: v of the corners' texture coordinates; w: unused
} SceneTriangle;

// 112 bytes; the model is documented in host/scene/material.h.
typedef struct SceneMaterial {
    f32x4 base;           // rgb: base colour factor; w: metallic
    f32x4 dielectric_f0;  // rgb: (1 - metallic) F0 of the dielectric; w: alpha of GGX
    f32x4 f90;            // rgb: Fresnel at grazing incidence; w: transmission
    f32x4 diffuse_scale;  // rgb: base times this is the diffuse albedo before (1 - a(mu_o)); w: unused
    f32x4 mean_scale;     // rgb: base times this is R, the mean diffuse albedo; w: unused
    f32x4 emission;       // rgb: radiance, W/(sr m^2); w: unused
    u32x4 texture;        // base colour: first texel, width, height (0 = none); TEXTURE_* and MATERIAL_* bits
} SceneMaterial;

// 48 bytes: an emissive triangle.
typedef struct AreaLight {
    f32x4
        entry;  // alias table by power (Walker 1977, Vose 1991): acceptance; alias (uint bits); share of the power;
                // triangle (uint bits)
    f32x4 center;  // xyz: centroid, m; w: area, m^2
    f32x4 normal;  // xyz: unit, front side; w: 1 = emits from both sides
} AreaLight;

// 64 bytes: a punctual light in its alias table.
typedef struct PointLight {
    f32x4 entry;  // acceptance probability; alias (uint bits); probability of selection; LIGHT_* (uint bits)
    f32x4 position;   // xyz, m; w: range, m (inf = unlimited)
    f32x4 direction;  // xyz: unit, the way the light travels; w: spot: scale of the angular falloff
    f32x4 intensity;  // rgb: W/sr, directional W/m^2; w: spot: offset of the angular falloff
} PointLight;

#ifdef __cplusplus
static_assert(sizeof(SceneTriangle) == 128 && sizeof(SceneMaterial) == 112, "device layout");
static_assert(sizeof(AreaLight) == 48 && sizeof(PointLight) == 64, "device layout");
}  // namespace obscura
#endif

#endif
