// SPDX-License-Identifier: Apache-2.0
#include "device/scene_buffers.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "sampling/alias_table.h"
#include "sampling/filter.h"
#include "scene/albedo_table.h"
#include "scene/material.h"
#include "scene/radiometry.h"
#include "shared/bvh.h"

namespace obscura {
namespace {

f32x4 lane(const V3f& v, float w) {
    return {v.x, v.y, v.z, w};
}

// Power of a light for its selection: the channels' mean, so that no channel is starved.
double mean_channel(const V3d& v) {
    return (v.x + v.y + v.z) / 3;
}

SceneTriangle make_triangle(const Scene& scene, uint32_t index) {
    const Vertex& a = scene.corner(index, 0);
    const Vertex& b = scene.corner(index, 1);
    const Vertex& c = scene.corner(index, 2);
    const V3f normal(geometric_normal(scene, index));
    const uint32_t flags = is_smooth(scene, index) ? TRIANGLE_SMOOTH : 0u;
    const auto longest = static_cast<float>(longest_edge(scene, index));
    return {{lane(a.position, normal.x), lane(b.position, normal.y), lane(c.position, normal.z)},
            {scene.triangles[index].material, NO_LIGHT, flags, std::bit_cast<uint32_t>(longest)},
            {lane(a.normal, a.uv.x), lane(b.normal, b.uv.x), lane(c.normal, c.uv.x)},
            {a.uv.y, b.uv.y, c.uv.y, 0}};
}

uint32_t wrap_code(Wrap wrap) {
    switch (wrap) {
        case Wrap::repeat:
            return TEXTURE_WRAP_REPEAT;
        case Wrap::mirrored_repeat:
            return TEXTURE_WRAP_MIRROR;
        case Wrap::clamp_to_edge:
            return TEXTURE_WRAP_CLAMP;
    }
    return TEXTURE_WRAP_REPEAT;
}

u32x4 texture_lane(const Scene& scene, const Material& material, const std::vector<uint32_t>& first_texel) {
    if (material.base_color_texture == NO_TEXTURE) return {0, 0, 0, 0};
    const auto index = static_cast<size_t>(material.base_color_texture);
    const Texture& texture = scene.textures[index];
    const uint32_t bits = wrap_code(texture.wrap_u) | wrap_code(texture.wrap_v) << TEXTURE_WRAP_V_SHIFT |
                          (texture.filter == TextureFilter::linear ? TEXTURE_LINEAR : 0u);
    return {first_texel[index], texture.width, texture.height, bits};
}

SceneMaterial make_material(const Scene& scene, const Material& material,
                            const std::vector<uint32_t>& first_texel) {
    const SurfaceModel model = surface_model(material);
    uint32_t flags = 0;
    if (material.double_sided) flags |= MATERIAL_DOUBLE_SIDED;
    if (material.unlit) flags |= MATERIAL_UNLIT;
    if (is_pane(material)) flags |= MATERIAL_PANE;
    if (model.has_specular) flags |= model.alpha > 0 ? MATERIAL_GLOSSY : MATERIAL_MIRROR;
    u32x4 texture = texture_lane(scene, material, first_texel);
    texture.w |= flags;
    return {lane(material.base_color, material.metallic),
            lane(model.dielectric_f0, model.alpha),
            lane(model.f90, material.transmission),
            lane(model.diffuse_scale, 0),
            lane(model.mean_scale, 0),
            lane(is_emissive(material) ? material.emission : V3f(0), 0),
            texture};
}

// Texels of all textures, one after the other; first_texel[i] is where texture i starts.
std::vector<uint32_t> pack_texels(const Scene& scene, std::vector<uint32_t>& first_texel) {
    std::vector<uint32_t> texels;
    for (const Texture& texture : scene.textures) {
        OBSCURA_CHECK(texels.size() <= std::numeric_limits<uint32_t>::max(), "{} texels", texels.size());
        first_texel.push_back(static_cast<uint32_t>(texels.size()));
        for (size_t i = 0; i + 3 < texture.rgba.size(); i += 4) {
            const std::array<uint8_t, 4> texel{texture.rgba[i], texture.rgba[i + 1], texture.rgba[i + 2],
                                               texture.rgba[i + 3]};
            texels.push_back(std::bit_cast<uint32_t>(texel));
        }
    }
    return texels;
}

// Alias table over the emissive triangles by power; tells each triangle its place in it.
std::vector<AreaLight> make_area_lights(const Scene& scene, std::vector<SceneTriangle>& triangles) {
    std::vector<double> powers;
    std::vector<uint32_t> emitters;
    for (uint32_t i = 0; i < scene.triangles.size(); ++i) {
        const Material& material = scene.materials[scene.triangles[i].material];
        if (!is_emissive(material)) continue;
        const double power =
            mean_channel(V3d(material.emission)) * triangle_area(scene, i) * (material.double_sided ? 2 : 1);
        triangles[i].ids.y = static_cast<uint32_t>(emitters.size());
        powers.push_back(power);
        emitters.push_back(i);
    }
    if (emitters.empty()) return {};
    std::vector<AreaLight> lights;
    const std::vector<AliasEntry> table = build_alias_table(powers);
    for (size_t i = 0; i < emitters.size(); ++i) {
        const uint32_t triangle = emitters[i];
        const V3f center = (scene.corner(triangle, 0).position + scene.corner(triangle, 1).position +
                            scene.corner(triangle, 2).position) /
                           3.0f;
        const bool two_sided = scene.materials[scene.triangles[triangle].material].double_sided;
        lights.push_back({{table[i].acceptance, std::bit_cast<float>(table[i].alias), table[i].probability,
                           std::bit_cast<float>(triangle)},
                          lane(center, static_cast<float>(triangle_area(scene, triangle))),
                          lane(V3f(geometric_normal(scene, triangle)), two_sided ? 1.0f : 0.0f)});
    }
    return lights;
}

uint32_t light_code(LightType type) {
    switch (type) {
        case LightType::point:
            return LIGHT_POINT;
        case LightType::spot:
            return LIGHT_SPOT;
        case LightType::directional:
            return LIGHT_DIRECTIONAL;
    }
    return LIGHT_POINT;
}

// Irradiance in the middle of the scene, by which punctual lights are picked: what they do in the rest of it is as
// likely more as less. Lamps count as no nearer than a quarter of the diagonal. No length here is absolute, such as a
// metre: it would leave one kind of light without samples in a scene that is very large or small.
double selection_weight(const Scene& scene, const PunctualLight& light) {
    const double intensity = mean_channel(V3d(light.intensity));
    if (light.type == LightType::directional || scene.bounds.isEmpty()) return intensity;
    const V3d low(scene.bounds.min), high(scene.bounds.max);
    const double distance2 = (V3d(light.position) - 0.5 * (low + high)).length2();
    return intensity / std::max(distance2, (high - low).length2() / 16);
}

// Alias table over the punctual lights.
std::vector<PointLight> make_point_lights(const Scene& scene) {
    std::vector<double> weights;
    std::vector<const PunctualLight*> sources;
    for (const PunctualLight& light : scene.lights) {
        const double weight = selection_weight(scene, light);
        if (!(weight > 0)) continue;
        weights.push_back(weight);
        sources.push_back(&light);
    }
    if (sources.empty()) return {};
    const std::vector<AliasEntry> table = build_alias_table(weights);
    std::vector<PointLight> lights;
    for (size_t i = 0; i < sources.size(); ++i) {
        const PunctualLight& light = *sources[i];
        // KHR_lights_punctual: cone = saturate(cos * scale + offset)^2.
        const float scale = 1.0f / std::max(0.001f, light.cos_inner - light.cos_outer);
        const float range = light.range > 0 ? light.range : std::numeric_limits<float>::infinity();
        lights.push_back({{table[i].acceptance, std::bit_cast<float>(table[i].alias), table[i].probability,
                           std::bit_cast<float>(light_code(light.type))},
                          lane(light.position, range),
                          lane(light.direction, scale),
                          lane(light.intensity, -light.cos_outer * scale)});
    }
    return lights;
}

std::vector<float> make_tables(PixelFilter filter) {
    static_assert(AlbedoTable::SIZE == ALBEDO_TABLE_SIZE);
    std::vector<float> tables(TABLE_FLOATS);
    std::ranges::copy(ALBEDO_TABLE.values, tables.begin() + TABLE_ALBEDO);
    for (uint32_t code = 0; code < SRGB_TABLE_FLOATS; ++code) {
        tables[TABLE_SRGB + code] = static_cast<float>(srgb_to_linear(static_cast<uint8_t>(code)));
    }
    std::ranges::copy(inverse_filter_cdf(filter, FILTER_TABLE_SIZE), tables.begin() + TABLE_FILTER);
    return tables;
}

}  // namespace

SceneArrays make_scene_arrays(const Scene& scene, PixelFilter filter) {
    SceneArrays arrays;
    std::vector<uint32_t> first_texel;
    arrays.texels = pack_texels(scene, first_texel);
    for (const Material& material : scene.materials) {
        arrays.materials.push_back(make_material(scene, material, first_texel));
    }
    arrays.triangles.reserve(scene.triangles.size());
    for (uint32_t i = 0; i < scene.triangles.size(); ++i)
        arrays.triangles.push_back(make_triangle(scene, i));
    arrays.area_lights = make_area_lights(scene, arrays.triangles);
    arrays.point_lights = make_point_lights(scene);
    arrays.tables = make_tables(filter);
    return arrays;
}

SceneBuffers upload_scene(Device& device, const SceneArrays& arrays, const Bvh& bvh) {
    return {Buffer::holding(device, "nodes", "bvh", bvh.nodes, Pages::huge),
            Buffer::holding(device, "blocks", "bvh", bvh.blocks, Pages::huge),
            Buffer::holding(device, "triangles", "scene", arrays.triangles, Pages::huge),
            Buffer::holding(device, "materials", "scene", arrays.materials),
            Buffer::holding(device, "area_lights", "scene", arrays.area_lights),
            Buffer::holding(device, "point_lights", "scene", arrays.point_lights),
            Buffer::holding(device, "texels", "scene", arrays.texels),
            Buffer::holding(device, "tables", "scene", arrays.tables)};
}

}  // namespace obscura
