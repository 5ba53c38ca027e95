// SPDX-License-Identifier: Apache-2.0
// The scene model: plain data, in world space but for Scene::origin, as the renderer sees it. Readers fill it, validation checks
// it, everything else only reads it. Lengths are in Scene::unit: metres (glTF's unit), but in scenes of extreme size.
// Radiance is W/(sr m^2) per linear RGB channel, angles are radians.
#pragma once

#include "base/math.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace obscura {

constexpr int32_t NO_TEXTURE = -1;

enum class Wrap { repeat, mirrored_repeat, clamp_to_edge };
enum class TextureFilter { nearest, linear };

// Base colour texture: 8 bits per channel RGBA, rows from the top (v = 0), colour sRGB-encoded, alpha linear.
struct Texture {
    std::string name;
    uint32_t width = 0;
    uint32_t height = 0;
    Wrap wrap_u = Wrap::repeat;
    Wrap wrap_v = Wrap::repeat;
    TextureFilter filter = TextureFilter::linear;
    std::vector<uint8_t> rgba;  // width * height * 4
};

// glTF's metallic-roughness material with the extensions obscura renders. How it maps to the reflection
// model is documented in scene/material.h, and only there.
struct Material {
    std::string name;
    Rgb base_color{1, 1, 1};                  // linear, [0, 1]
    int32_t base_color_texture = NO_TEXTURE;  // multiplies base_color
    float metallic = 1;                       // [0, 1]
    float roughness = 1;                      // perceptual, [0, 1]
    float specular = 1;                       // KHR_materials_specular specularFactor, [0, 1]
    Rgb specular_color{1, 1, 1};              // KHR_materials_specular specularColorFactor, >= 0
    float transmission = 0;                   // KHR_materials_transmission factor, [0, 1]
    Rgb emission{0, 0, 0};                    // radiance: emissiveFactor * emissiveStrength
    bool double_sided = false;                // both sides emit and count in A_T
    bool unlit = false;                       // KHR_materials_unlit: shows base_color, E = R = 0
};

struct Vertex {
    V3f position;
    V3f normal{0, 0, 0};  // unit length, world; (0,0,0) = none: shade flat
    V2f uv{0, 0};         // TEXCOORD_0; v = 0 is the texture's top row
};

struct Triangle {
    std::array<uint32_t, 3> vertex;  // indices into Scene::vertices; counter-clockwise seen from the front
    uint32_t material;
    uint32_t object;
};

// A glTF node with a mesh. Objects own contiguous runs of triangles.
struct Object {
    std::string name;
    uint32_t first_triangle = 0;
    uint32_t triangle_count = 0;
};

enum class LightType { point, spot, directional };

// KHR_lights_punctual with photometric units read as radiometric ones: intensity is W/sr per channel over unit^2 for
// point and spot lights, which over a squared distance is W/m^2, and irradiance W/m^2 on a perpendicular surface for
// directional ones.
struct PunctualLight {
    std::string name;
    LightType type = LightType::point;
    Rgb intensity{0, 0, 0};
    V3f position{0, 0, 0};    // point, spot
    V3f direction{0, 0, -1};  // unit, the way the light travels: spot, directional
    float range = 0;          // 0 = unlimited
    float cos_inner = 1;      // spot: full intensity inside
    float cos_outer = 0;      // spot: nothing outside
};

struct Camera {
    std::string name;
    bool orthographic = false;
    M44d camera_to_world;       // rigid: looks down -z, +y up; row-vector convention
    double vertical_fov = 0.8;  // perspective: radians, the whole angle
    double half_height = 1;     // orthographic (ymag)
    double aspect_ratio = 0;    // width / height that the file wishes for; 0 = any
};

struct Scene {
    std::string name;  // for messages: file name without folder
    std::vector<Vertex> vertices;
    std::vector<Triangle> triangles;  // no degenerate ones: readers drop and count them
    std::vector<Object> objects;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<PunctualLight> lights;
    std::vector<Camera> cameras;     // at least one: readers add a default that frames the bounds
    uint32_t dropped_triangles = 0;  // zero area, dropped at load with a warning
    // Where coordinates here lie in the world, in metres: at origin + unit * coordinate (scene/local_frame.h).
    V3d origin{0, 0, 0};
    double unit = 1;  // metres, a power of two
    Box3f bounds;     // of all vertices used by triangles; empty without triangles

    const Vertex& corner(uint32_t triangle, int i) const {
        return vertices[triangles[triangle].vertex[static_cast<size_t>(i)]];
    }
};

// Geometry of one triangle in double, from its float corners.
// Unit normal of the front side; undefined for zero area, which no scene holds. Its zeros are positive: a basis about it
// depends on their sign.
V3d geometric_normal(const Scene& scene, uint32_t triangle);
double triangle_area(const Scene& scene, uint32_t triangle);
double longest_edge(const Scene& scene, uint32_t triangle);

// Of the bounds, in metres; 0 when they are empty.
double diagonal(const Scene& scene);

// Largest component of the cross product of two edges, from exact products in float, as kernels test triangles
// (kernels/lib/intersect.clh). They need a normal float: less is no area.
float edge_product(const V3f& a, const V3f& b, const V3f& c);

// Whether the triangle is shaded with its vertex normals: all three are there, and one differs from the
// geometric normal by more than the rounding of exporters (1e-3).
bool is_smooth(const Scene& scene, uint32_t triangle);

// Linear value of an 8-bit sRGB code (IEC 61966-2-1).
double srgb_to_linear(uint8_t code);

}  // namespace obscura
