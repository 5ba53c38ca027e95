// SPDX-License-Identifier: Apache-2.0
// glTF's materials and their extensions as obscura's. What a material asks for and obscura does not render
// is counted here. Ranges are glTF's own: a factor outside them is an error in the file, not clamped.
#include "scene/gltf_reader.h"
#include "scene/material.h"

#include <cmath>
#include <limits>

namespace obscura {

namespace {

constexpr auto UNBOUNDED = static_cast<double>(std::numeric_limits<float>::max());
constexpr double DEFAULT_IOR = 1.5;

float checked(const GltfReader& reader, const std::string& place, const char* what, double value,
              double most) {
    if (value >= 0 && value <= most) return static_cast<float>(value);
    if (most == UNBOUNDED) reader.fail(place, "{} is {}, but must be finite and not negative.", what, value);
    reader.fail(place, "{} is {}, outside 0 to {}.", what, value, most);
}

Rgb checked(const GltfReader& reader, const std::string& place, const char* what,
            const std::vector<double>& values, double most) {
    if (values.size() < 3) reader.fail(place, "{} must hold 3 numbers.", what);
    return Rgb(checked(reader, place, what, values[0], most), checked(reader, place, what, values[1], most),
               checked(reader, place, what, values[2], most));
}

void convert_specular(GltfReader& reader, const std::string& place, const tinygltf::Value& extension,
                      Material& material) {
    material.specular = checked(reader, place, "specularFactor",
                                number_member(reader, place, extension, "specularFactor", 1), 1);
    material.specular_color =
        checked(reader, place, "specularColorFactor",
                vector_member(reader, place, extension, "specularColorFactor", {1, 1, 1}), UNBOUNDED);
    if (extension.Has("specularTexture") || extension.Has("specularColorTexture"))
        reader.notices.add("specular textures are not supported yet and are ignored", "material");
}

void convert_transmission(GltfReader& reader, const std::string& place, const tinygltf::Value& extension,
                          Material& material) {
    material.transmission = checked(reader, place, "transmissionFactor",
                                    number_member(reader, place, extension, "transmissionFactor", 0), 1);
    if (extension.Has("transmissionTexture"))
        reader.notices.add("transmission textures are not supported yet and are ignored", "material");
    if (!is_pane(material)) return;
    reader.notices.add("refraction is not supported yet; transmission is rendered as a thin clear pane",
                       "material");
    if (material.roughness >= MIRROR_ROUGHNESS)
        reader.notices.add("rough transmission is not supported yet; panes are smooth on both sides",
                           "material");
}

void convert_emission(GltfReader& reader, const std::string& place, const tinygltf::Material& source,
                      Material& material) {
    double strength = 1;
    if (const auto* extension = find_extension(source.extensions, "KHR_materials_emissive_strength"))
        strength = number_member(reader, place, *extension, "emissiveStrength", 1);
    V3d mean(1, 1, 1);
    if (source.emissiveTexture.index >= 0) {
        mean = mean_texel(reader, source.emissiveTexture.index, place, true);
        reader.notices.add("emissive textures are not supported yet; their mean colour is used", "material");
    }
    std::vector<double> radiance;
    for (size_t c = 0; c < source.emissiveFactor.size(); ++c)
        radiance.push_back(source.emissiveFactor[c] * strength * mean[static_cast<int>(c % 3)]);
    material.emission = checked(reader, place, "the emission", radiance, UNBOUNDED);
}

void convert_metallic_roughness(GltfReader& reader, const std::string& place,
                                const tinygltf::PbrMetallicRoughness& source, Material& material) {
    material.base_color = checked(reader, place, "baseColorFactor", source.baseColorFactor, 1);
    if (source.baseColorTexture.index >= 0)
        material.base_color_texture = use_texture(reader, source.baseColorTexture.index, place);
    V3d mean(1, 1, 1);
    if (source.metallicRoughnessTexture.index >= 0) {
        mean = mean_texel(reader, source.metallicRoughnessTexture.index, place, false);
        reader.notices.add("metallic-roughness textures are not supported yet; their mean values are used",
                           "material");
    }
    // Roughness stands in the green channel, metalness in the blue one.
    material.roughness = checked(reader, place, "roughnessFactor", source.roughnessFactor * mean.y, 1);
    material.metallic = checked(reader, place, "metallicFactor", source.metallicFactor * mean.z, 1);
}

void note_unsupported(GltfReader& reader, const std::string& place, const tinygltf::Material& source) {
    Notices& notices = reader.notices;
    if (source.normalTexture.index >= 0)
        notices.add("normal maps are not supported yet and are ignored", "material");
    if (source.occlusionTexture.index >= 0)
        notices.add("occlusion textures are ignored; obscurances are traced instead", "material");
    if (source.alphaMode == "MASK" || source.alphaMode == "BLEND")
        notices.add("alphaMode " + source.alphaMode + " is not supported yet; surfaces are rendered opaque",
                    "material");
    if (const auto* extension = find_extension(source.extensions, "KHR_materials_ior")) {
        if (number_member(reader, place, *extension, "ior", DEFAULT_IOR) != DEFAULT_IOR)
            notices.add("indices of refraction are not supported yet; 1.5 is used", "material");
    }
}

Material convert_material(GltfReader& reader, const std::string& place, const tinygltf::Material& source) {
    Material material;
    material.name = source.name;
    material.double_sided = source.doubleSided;
    material.unlit = find_extension(source.extensions, "KHR_materials_unlit") != nullptr;
    convert_metallic_roughness(reader, place, source.pbrMetallicRoughness, material);
    if (!material.unlit) convert_emission(reader, place, source, material);
    if (const auto* specular = find_extension(source.extensions, "KHR_materials_specular"))
        convert_specular(reader, place, *specular, material);
    if (const auto* transmission = find_extension(source.extensions, "KHR_materials_transmission"))
        convert_transmission(reader, place, *transmission, material);
    note_unsupported(reader, place, source);
    return material;
}

}  // namespace

bool is_supported_extension(const std::string& name) {
    for (const char* known : {"KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_materials_ior",
                              "KHR_materials_specular", "KHR_materials_transmission", "KHR_materials_unlit",
                              "KHR_mesh_quantization", "KHR_texture_transform"})
        if (name == known) return true;
    return false;
}

uint32_t use_material(GltfReader& reader, int index) {
    const auto known = reader.materials.find(index);
    if (known != reader.materials.end()) return known->second;
    const auto slot = static_cast<uint32_t>(reader.scene.materials.size());
    Material material;
    material.name = "default";
    if (index >= 0) {
        const tinygltf::Material& source = reader.model.materials[static_cast<size_t>(index)];
        material =
            convert_material(reader, gltf_place("material", source.name, static_cast<size_t>(index)), source);
    }
    reader.scene.materials.push_back(material);
    reader.materials.emplace(index, slot);
    return slot;
}

UvMapping base_color_mapping(const GltfReader& reader, int index) {
    UvMapping mapping;
    if (index < 0) return mapping;
    const tinygltf::Material& material = reader.model.materials[static_cast<size_t>(index)];
    const tinygltf::TextureInfo& info = material.pbrMetallicRoughness.baseColorTexture;
    if (info.index < 0) return mapping;
    mapping.textured = true;
    mapping.set = info.texCoord;
    const auto* transform = find_extension(info.extensions, "KHR_texture_transform");
    if (transform == nullptr) return mapping;
    const std::string place =
        gltf_place("material", material.name, static_cast<size_t>(index)) + ": KHR_texture_transform";
    mapping.set = index_member(reader, place, *transform, "texCoord", info.texCoord);
    const std::vector<double> offset = vector_member(reader, place, *transform, "offset", {0, 0});
    const std::vector<double> scale = vector_member(reader, place, *transform, "scale", {1, 1});
    const double angle = number_member(reader, place, *transform, "rotation", 0);
    // Counter-clockwise as seen in the picture, whose v axis points down.
    mapping.uu = std::cos(angle) * scale[0];
    mapping.vu = std::sin(angle) * scale[1];
    mapping.u0 = offset[0];
    mapping.uv = -std::sin(angle) * scale[0];
    mapping.vv = std::cos(angle) * scale[1];
    mapping.v0 = offset[1];
    return mapping;
}

}  // namespace obscura
