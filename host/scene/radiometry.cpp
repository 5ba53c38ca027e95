// SPDX-License-Identifier: Apache-2.0
#include "scene/radiometry.h"

#include "base/error.h"
#include "base/log.h"
#include "scene/material.h"
#include "scene/texture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace obscura {

namespace {

// glTF's soft edge of a spot light is t^2, t = clamp((cos - cos_outer) / ramp, 0, 1). KHR_lights_punctual
// keeps ramp from vanishing like this.
constexpr double SMALLEST_SPOT_RAMP = 0.001;

bool emits(const PunctualLight& light) {
    return light.intensity.x > 0 || light.intensity.y > 0 || light.intensity.z > 0;
}

// int of the soft edge over the sphere, sr.
double spot_solid_angle(const PunctualLight& light) {
    const double outer = static_cast<double>(light.cos_outer);
    const double ramp = std::max(SMALLEST_SPOT_RAMP, static_cast<double>(light.cos_inner) - outer);
    const double ramp_share = std::min(1.0, (1 - outer) / ramp);  // of the ramp that lies below cos = 1
    const double inside = std::max(0.0, 1 - outer - ramp);
    return 2 * std::numbers::pi * (ramp * ramp_share * ramp_share * ramp_share / 3 + inside);
}

// Phi / pi, W/sr.
RgbD emitted_by(const Scene& scene, const PunctualLight& light) {
    if (!emits(light)) return {0, 0, 0};
    const RgbD intensity(light.intensity);
    switch (light.type) {
        case LightType::point:
            return 4.0 * intensity;
        case LightType::spot:
            return spot_solid_angle(light) / std::numbers::pi * intensity;
        case LightType::directional:
            return lit_area(scene, light.direction) / std::numbers::pi * intensity;
    }
    OBSCURA_CHECK(false, "light type {}", static_cast<int>(light.type));
}

}  // namespace

Radiometry compute_radiometry(const Scene& scene) {
    Radiometry result;
    RgbD reflecting(0, 0, 0);  // sum A_i R_i
    RgbD absorbing(0, 0, 0);   // sum A_i (opacity - R_i): 1 - R_ave without cancellation
    std::vector<double> opacity;
    std::vector<RgbD> untextured;  // reflectivity where no texture changes the base colour
    for (const Material& material : scene.materials) {
        opacity.push_back(surface_model(material).opacity);
        untextured.push_back(mean_reflectivity(material, RgbD(material.base_color)));
    }
    const std::vector<RgbD> base_colors = triangle_base_colors(scene);
    for (uint32_t i = 0; i < scene.triangles.size(); ++i) {
        const uint32_t index = scene.triangles[i].material;
        const Material& material = scene.materials[index];
        const double area = triangle_area(scene, i) * (material.double_sided ? 2 : 1);
        const RgbD reflectivity = material.base_color_texture == NO_TEXTURE
                                      ? untextured[index]
                                      : mean_reflectivity(material, base_colors[i]);
        result.area += area * opacity[index];
        reflecting += area * reflectivity;
        absorbing += area * (RgbD(opacity[index]) - reflectivity);
        if (is_emissive(material)) result.emitted += area * RgbD(material.emission);
    }
    for (const PunctualLight& light : scene.lights)
        result.emitted += emitted_by(scene, light);
    // R_ave and I_A are quotients, in which the scene's unit of area cancels.
    for (int c = 0; c < 3 && result.area > 0; ++c) {
        const double endless = std::numeric_limits<double>::infinity();
        result.average_reflectivity[c] = reflecting[c] / result.area;
        result.ambient_bleeding[c] = absorbing[c] > 0 ? result.emitted[c] / absorbing[c] : endless;
        result.ambient_colourless[c] = result.average_reflectivity[c] * result.ambient_bleeding[c];
    }
    result.area *= scene.unit * scene.unit;
    result.emitted *= scene.unit * scene.unit;
    return result;
}

void check_ambient(const Scene& scene, const Radiometry& radiometry, const RenderSettings& settings) {
    if (!settings.obscurance || settings.ambient == Ambient::none || settings.ambient_light) return;
    constexpr const char* CHANNELS[] = {"red", "green", "blue"};
    for (int c = 0; c < 3; ++c) {
        if (std::isinf(radiometry.ambient_bleeding[c]))
            throw InputError(
                "{}: materials: the average reflectivity of the {} channel reaches 1, so light would be "
                "reflected for ever; make the surfaces darker, or set --ambient-light or --ambient none.",
                scene.name, CHANNELS[c]);
    }
}

RgbD resolve_ambient(const Radiometry& radiometry, const RenderSettings& settings) {
    const bool bleeding = settings.bleeding && settings.ambient != Ambient::constant;
    RgbD ambient = bleeding ? radiometry.ambient_bleeding : radiometry.ambient_colourless;
    if (settings.ambient_light) {
        ambient = RgbD(*settings.ambient_light);
        for (int c = 0; bleeding && c < 3; ++c) {
            const double open = radiometry.average_reflectivity[c];
            ambient[c] = open > 0 ? ambient[c] / open : 0;
        }
    }
    return settings.ambient_scale * ambient;
}

std::vector<RgbD> triangle_base_colors(const Scene& scene) {
    std::vector<RgbD> colors;
    std::vector<std::vector<uint32_t>> textured(scene.textures.size());  // triangles of each texture
    for (uint32_t i = 0; i < scene.triangles.size(); ++i) {
        const Material& material = scene.materials[scene.triangles[i].material];
        colors.push_back(RgbD(material.base_color));
        if (material.base_color_texture != NO_TEXTURE)
            textured[static_cast<size_t>(material.base_color_texture)].push_back(i);
    }
    for (size_t t = 0; t < textured.size(); ++t) {
        if (textured[t].empty()) continue;
        const TextureIntegral integral(scene.textures[t]);  // one at a time: several times the texture's size
        for (const uint32_t i : textured[t])
            colors[i] *= integral.mean({scene.corner(i, 0).uv, scene.corner(i, 1).uv, scene.corner(i, 2).uv});
    }
    return colors;
}

bool has_light(const Scene& scene) {
    return std::any_of(
               scene.triangles.begin(), scene.triangles.end(),
               [&](const Triangle& triangle) { return is_emissive(scene.materials[triangle.material]); }) ||
           std::any_of(scene.lights.begin(), scene.lights.end(),
                       [](const PunctualLight& light) { return emits(light); });
}

RenderSettings with_default_sky(const Scene& scene, RenderSettings settings) {
    if (settings.background || settings.ambient_light || has_light(scene)) return settings;
    log_warning(
        "{}: the scene has no light, so it is lit by a uniform white sky; --background and --ambient-light "
        "set "
        "another.",
        scene.name);
    settings.background = Rgb(1, 1, 1);
    settings.ambient_light = Rgb(1, 1, 1);
    return settings;
}

}  // namespace obscura
