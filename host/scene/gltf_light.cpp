// SPDX-License-Identifier: Apache-2.0
// KHR_lights_punctual. A node's scale does not change a light; photometric units are read as radiometric
// ones.
#include "scene/gltf_reader.h"

#include <cmath>
#include <numbers>

namespace obscura {

namespace {

const char* const EXTENSION = "KHR_lights_punctual";

// Of point and spot lights so that over a squared distance in the scene's unit it is W/m^2.
Rgb light_intensity(const GltfReader& reader, const std::string& place, const tinygltf::Light& light) {
    if (!light.color.empty() && light.color.size() != 3)
        reader.fail(place, "color must be a list of 3 numbers.");
    const double scale = light.type == "directional" ? 1 : 1 / (reader.scene.unit * reader.scene.unit);
    Rgb intensity;
    for (int channel = 0; channel < 3; ++channel) {
        const double color = light.color.empty() ? 1 : light.color[static_cast<size_t>(channel)];
        const auto value = static_cast<float>(color * light.intensity * scale);
        if (!(value >= 0) || !std::isfinite(value))
            reader.fail(
                place,
                "its intensity {} and color {} must be finite and not negative, in a unit of length of {} m.",
                light.intensity, color, reader.scene.unit);
        intensity[channel] = value;
    }
    return intensity;
}

void set_cone(const GltfReader& reader, const std::string& place, const tinygltf::SpotLight& spot,
              PunctualLight& light) {
    if (!(spot.innerConeAngle >= 0) || !(spot.innerConeAngle < spot.outerConeAngle) ||
        !(spot.outerConeAngle <= std::numbers::pi / 2 + 1e-6))  // pi / 2 may be written as a rounded-up float
        reader.fail(place, "its cone angles must be 0 <= inner < outer <= pi / 2, not {} and {}.",
                    spot.innerConeAngle, spot.outerConeAngle);
    light.cos_inner = static_cast<float>(std::cos(spot.innerConeAngle));
    light.cos_outer = static_cast<float>(std::cos(spot.outerConeAngle));
}

}  // namespace

void append_light(GltfReader& reader, const tinygltf::Node& node, const std::string& node_place,
                  const M44d& to_world) {
    const tinygltf::Value* extension = find_extension(node.extensions, EXTENSION);
    if (extension == nullptr) return;
    const int index = index_member(reader, node_place + ": " + EXTENSION, *extension, "light", -1);
    const auto& lights = reader.model.lights;
    if (index < 0 || static_cast<size_t>(index) >= lights.size())
        reader.fail(node_place, "light {} does not exist; the file has {}.", index, lights.size());
    const tinygltf::Light& source = lights[static_cast<size_t>(index)];
    const std::string place = gltf_place("light", source.name, static_cast<size_t>(index));

    PunctualLight light;
    light.name = node.name.empty() ? source.name : node.name;
    light.intensity = light_intensity(reader, place, source);
    if (!(source.range >= 0) || !std::isfinite(static_cast<float>(source.range)))
        reader.fail(place, "its range {} must be positive.", source.range);
    light.range = static_cast<float>(source.range / reader.scene.unit);
    light.position = V3f(to_world.translation());
    if (!std::isfinite(light.position.x) || !std::isfinite(light.position.y) ||
        !std::isfinite(light.position.z))
        reader.fail(node_place, "its transform puts its light out of reach.");
    V3d direction;
    to_world.multDirMatrix(V3d(0, 0, -1), direction);
    const double length = direction.length();
    if (source.type == "point") {
        light.type = LightType::point;
    } else if (source.type == "spot") {
        light.type = LightType::spot;
        set_cone(reader, place, source.spot, light);
    } else if (source.type == "directional") {
        light.type = LightType::directional;
    } else {
        reader.fail(place, "its type '{}' is not point, spot or directional.", source.type);
    }
    if (light.type != LightType::point) {
        if (!(length > 0) || !std::isfinite(length))
            reader.fail(node_place, "its transform leaves its light no direction.");
        light.direction = V3f(direction / length);
    }
    reader.scene.lights.push_back(light);
}

}  // namespace obscura
