// SPDX-License-Identifier: Apache-2.0
#include "wavefront/features.h"

#include <cctype>
#include <map>
#include <sstream>

namespace obscura {
namespace {

const std::map<std::string, bool Needs::*, std::less<>>& need_flags() {
    static const std::map<std::string, bool Needs::*, std::less<>> flags{
        {"textures", &Needs::textures},
        {"smooth_normals", &Needs::smooth_normals},
        {"glossy", &Needs::glossy},
        {"mirror", &Needs::mirror},
        {"transmission", &Needs::transmission},
        {"area_lights", &Needs::area_lights},
        {"point_lights", &Needs::point_lights},
        {"spot_lights", &Needs::spot_lights},
        {"directional_lights", &Needs::directional_lights},
        {"emission", &Needs::emission},
        {"background", &Needs::background},
        {"bleeding", &Needs::bleeding},
        {"obscurance", &Needs::obscurance},
        {"ambient", &Needs::ambient},
        {"specular_paths", &Needs::specular_paths},
    };
    return flags;
}

std::string define(std::string name) {
    for (char& c : name)
        c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return " -D NEED_" + name + "=1";
}

std::string falloff_options(FalloffKind kind, bool all) {
    static const std::map<FalloffKind, std::string> names{
        {FalloffKind::step, "falloff_step"}, {FalloffKind::linear, "falloff_linear"},
        {FalloffKind::sqrt, "falloff_sqrt"}, {FalloffKind::cbrt, "falloff_cbrt"},
        {FalloffKind::exp, "falloff_exp"},   {FalloffKind::expjump, "falloff_expjump"},
        {FalloffKind::pow, "falloff_pow"},
    };
    std::string options;
    for (const auto& [one, name] : names) {
        if (all || one == kind) options += define(name);
    }
    return options;
}

}  // namespace

std::string stage_options(Stage stage, const Needs& needs, bool all, bool portable) {
    std::string options = portable ? " -D OBSCURA_PORTABLE" : "";
    std::istringstream features{std::string(stage_info(stage).features)};
    for (std::string feature; features >> feature;) {
        if (feature == "falloff") {
            options += falloff_options(needs.falloff, all);
        } else if (needs.*need_flags().at(feature)) {
            options += define(feature);
        }
    }
    return options;
}

}  // namespace obscura
