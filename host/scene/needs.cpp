// SPDX-License-Identifier: Apache-2.0
// What a render has to model, with the counts that are the reasons.
#include "scene/needs.h"

#include "base/units.h"
#include "scene/material.h"

#include <fmt/format.h>

namespace obscura {

namespace {

struct Counts {
    uint32_t textured = 0, rough = 0, mirrors = 0, panes = 0, emissive = 0, unlit = 0;  // materials
    uint32_t emissive_triangles = 0, smooth_triangles = 0, used_materials = 0;
    uint32_t points = 0, spots = 0, directionals = 0;
};

bool is_bright(const Rgb& color) {
    return color.x > 0 || color.y > 0 || color.z > 0;
}

Counts count_features(const Scene& scene) {
    Counts counts;
    std::vector<bool> used(scene.materials.size(), false);
    for (uint32_t i = 0; i < scene.triangles.size(); ++i) {
        const uint32_t index = scene.triangles[i].material;
        const Material& material = scene.materials[index];
        used[index] = true;
        if (is_emissive(material)) ++counts.emissive_triangles;
        if (is_smooth(scene, i)) ++counts.smooth_triangles;
    }
    for (size_t i = 0; i < used.size(); ++i) {
        if (!used[i]) continue;
        const Material& material = scene.materials[i];
        const SurfaceModel model = surface_model(material);
        ++counts.used_materials;
        if (material.base_color_texture != NO_TEXTURE) ++counts.textured;
        if (material.unlit) ++counts.unlit;
        if (is_emissive(material)) ++counts.emissive;
        if (model.has_specular) ++(model.alpha > 0 ? counts.rough : counts.mirrors);
        if (is_pane(material)) ++counts.panes;
    }
    for (const PunctualLight& light : scene.lights) {
        if (!is_bright(light.intensity)) continue;
        ++(light.type == LightType::point  ? counts.points
           : light.type == LightType::spot ? counts.spots
                                           : counts.directionals);
    }
    return counts;
}

// "3 materials have a mirror lobe", "1 material has ...", "no material has ...".
std::string having(uint32_t count, const std::string& noun, const std::string& what) {
    if (count == 0) return fmt::format("no {} has {}", noun, what);
    return fmt::format("{} {} {}", counted(count, noun), count == 1 ? "has" : "have", what);
}

std::string counted_or_no(uint32_t count, const std::string& noun) {
    return count == 0 ? "no " + plural(0, noun) : counted(count, noun);
}

// The first reason that switches a feature off, or else the one given.
std::string unless(bool off, const std::string& off_reason, const std::string& reason) {
    return off ? off_reason : reason;
}

Needs find_needs(const Counts& counts, const RenderSettings& settings) {
    Needs needs;
    needs.falloff = settings.falloff.kind;
    needs.textures = counts.textured > 0;
    needs.smooth_normals = counts.smooth_triangles > 0;
    needs.glossy = settings.specular && counts.rough > 0;
    needs.mirror = settings.specular && counts.mirrors > 0;
    needs.transmission = counts.panes > 0;
    // Light samples serve diffuse reflection (--no-direct) and rough specular lobes (--no-specular).
    const bool sampled = settings.direct || needs.glossy;
    needs.area_lights = sampled && counts.emissive_triangles > 0;
    needs.point_lights = sampled && counts.points > 0;
    needs.spot_lights = sampled && counts.spots > 0;
    needs.directional_lights = sampled && counts.directionals > 0;
    needs.emission = counts.emissive > 0 || counts.unlit > 0;
    needs.background = settings.background && is_bright(*settings.background);
    needs.ambient = settings.obscurance && settings.ambient != Ambient::none;
    needs.obscurance = needs.ambient && settings.ambient == Ambient::obscurance;
    needs.bleeding = needs.obscurance && settings.bleeding;
    needs.specular_paths =
        settings.specular && settings.max_depth > 0 && (needs.glossy || needs.mirror || needs.transmission);
    return needs;
}

Needs all_needs(FalloffKind falloff) {
    Needs all;
    for (bool Needs::*flag :
         {&Needs::textures, &Needs::smooth_normals, &Needs::glossy, &Needs::mirror, &Needs::transmission,
          &Needs::area_lights, &Needs::point_lights, &Needs::spot_lights, &Needs::directional_lights,
          &Needs::emission, &Needs::background, &Needs::bleeding, &Needs::obscurance, &Needs::ambient,
          &Needs::specular_paths})
        all.*flag = true;
    all.falloff = falloff;
    return all;
}

// Reasons that hold in automatic mode, in the order of struct Needs.
std::vector<Need> find_reasons(const Counts& counts, const RenderSettings& settings, const Needs& needs) {
    const bool no_lobes = !settings.specular;
    const bool no_samples = !settings.direct && !needs.glossy;
    const std::string no_sampling =
        settings.specular ? "--no-direct, and no rough specular lobe" : "--no-direct and --no-specular";
    const std::string no_ambient = settings.obscurance ? "--ambient none" : "--no-obscurance";
    const auto light = [&](uint32_t count, const char* noun) {
        return unless(no_samples, no_sampling, counted_or_no(count, noun));
    };
    return {
        {"textures", needs.textures, having(counts.textured, "material", "a base colour texture")},
        {"smooth_normals", needs.smooth_normals,
         having(counts.smooth_triangles, "triangle", "vertex normals that differ from its plane's")},
        {"glossy", needs.glossy,
         unless(no_lobes, "--no-specular", having(counts.rough, "material", "a rough specular lobe"))},
        {"mirror", needs.mirror,
         unless(no_lobes, "--no-specular", having(counts.mirrors, "material", "a mirror lobe"))},
        {"transmission", needs.transmission, having(counts.panes, "material", "transmission")},
        {"area_lights", needs.area_lights, light(counts.emissive_triangles, "emissive triangle")},
        {"point_lights", needs.point_lights, light(counts.points, "point light")},
        {"spot_lights", needs.spot_lights, light(counts.spots, "spot light")},
        {"directional_lights", needs.directional_lights, light(counts.directionals, "directional light")},
        {"emission", needs.emission,
         counts.unlit > 0 ? fmt::format("{} emissive and {} unlit materials", counts.emissive, counts.unlit)
                          : counted_or_no(counts.emissive, "emissive material")},
        {"background", needs.background,
         needs.background ? "rays that leave the scene see a sky" : "rays that leave the scene see black"},
        {"bleeding", needs.bleeding,
         !needs.obscurance
             ? "no obscurance rays"
             : unless(!settings.bleeding, "--bleeding off", "obscurance rays carry the colour they hit")},
        {"obscurance", needs.obscurance,
         !needs.ambient ? no_ambient
                        : unless(!needs.obscurance, "--ambient constant",
                                 fmt::format("{} obscurance rays per diffuse hit, falloff {}",
                                             settings.obscurance_rays, falloff_text(settings.falloff)))},
        {"ambient", needs.ambient, unless(!needs.ambient, no_ambient, "light of higher bounces")},
        {"specular_paths", needs.specular_paths,
         !settings.specular        ? "--no-specular"
         : settings.max_depth == 0 ? "--max-depth 0"
         : needs.specular_paths    ? fmt::format("reflections up to depth {}", settings.max_depth)
                                   : "nothing reflects or transmits specularly"},
    };
}

}  // namespace

Needs analyse_needs(const Scene& scene, const RenderSettings& settings) {
    if (settings.needs == NeedsMode::all) return all_needs(settings.falloff.kind);
    return find_needs(count_features(scene), settings);
}

std::vector<Need> explain_needs(const Scene& scene, const RenderSettings& settings) {
    const Counts counts = count_features(scene);
    std::vector<Need> rows = find_reasons(counts, settings, find_needs(counts, settings));
    if (settings.needs == NeedsMode::all) {
        for (Need& row : rows) {
            if (!row.needed) row.reason += "; kept by --needs all";
            row.needed = true;
        }
    }
    return rows;
}

}  // namespace obscura
