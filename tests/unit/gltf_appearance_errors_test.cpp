// SPDX-License-Identifier: Apache-2.0
// Materials, textures and lights without sense end in an InputError that names them.
#include "support/gltf_errors.h"

namespace obscura {
namespace {

using nlohmann::json;
using test::error_of;
using test::GltfBuilder;
using test::rich_file;
using test::triangle;

TEST(GltfAppearanceErrors, MaterialValuesMustBeInRange) {
    const auto with_material = [](const json& material) {
        GltfBuilder file = triangle();
        json named = material;
        named["name"] = "paint";
        file.append("materials", named);
        file.json["meshes"][0]["primitives"][0]["material"] = 0;
        return error_of(file);
    };
    EXPECT_CONTAINS(with_material({{"pbrMetallicRoughness", {{"metallicFactor", 1.5}}}}),
                    "material 'paint': metallicFactor is 1.5, outside 0 to 1");
    EXPECT_CONTAINS(with_material({{"pbrMetallicRoughness", {{"roughnessFactor", -0.1}}}}),
                    "roughnessFactor is -0.1");
    EXPECT_CONTAINS(with_material({{"pbrMetallicRoughness", {{"baseColorFactor", {2, 0, 0, 1}}}}}),
                    "baseColorFactor is 2");
    EXPECT_CONTAINS(with_material({{"emissiveFactor", {0, -1, 0}}}), "must be finite and not negative");
    EXPECT_CONTAINS(with_material({{"emissiveFactor", {0, 1, 0, 1}}}), "emissiveFactor");
    const auto with_extension = [&](const char* name, const json& members) {
        return with_material({{"extensions", {{name, members}}}});
    };
    EXPECT_CONTAINS(with_extension("KHR_materials_emissive_strength", {{"emissiveStrength", "high"}}),
                    "emissiveStrength must be a finite number");
    EXPECT_CONTAINS(with_extension("KHR_materials_specular", {{"specularFactor", 2}}), "specularFactor is 2");
    EXPECT_CONTAINS(with_extension("KHR_materials_specular", {{"specularColorFactor", {1, 1}}}),
                    "list of 3 numbers");
    EXPECT_CONTAINS(with_extension("KHR_materials_transmission", {{"transmissionFactor", -1}}),
                    "transmissionFactor is -1");
}

TEST(GltfAppearanceErrors, TexturesMustBeReadable) {
    const auto change = [](const char* list, const char* key, const json& value) {
        GltfBuilder file = rich_file();
        file.json[list][0][key] = value;
        return error_of(file);
    };
    EXPECT_CONTAINS(change("textures", "source", 3), "material 0: texture 0: it has no PNG or JPEG image");
    EXPECT_CONTAINS(change("textures", "sampler", 3), "sampler 3 does not exist");
    EXPECT_CONTAINS(change("samplers", "wrapS", 1), "unknown wrap mode 1");
    EXPECT_CONTAINS(change("images", "bufferView", 0), "can't be decoded as PNG or JPEG");
    EXPECT_CONTAINS(change("images", "bufferView", 50), "50");
    GltfBuilder missing = rich_file();
    missing.json["images"][0] = {{"uri", "missing.png"}};
    EXPECT_CONTAINS(error_of(missing), "the image file 'missing.png' is missing");
    GltfBuilder outside = rich_file();
    outside.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 8;
    EXPECT_CONTAINS(error_of(outside), "texture 8 does not exist");
    GltfBuilder past_end = rich_file();
    past_end.json["bufferViews"].back()["byteLength"] = 100000;
    EXPECT_CONTAINS(error_of(past_end), "reaches past the end of buffer 0");
}

TEST(GltfAppearanceErrors, LightsMustBeMeaningful) {
    const auto with_light = [](const json& light) {
        GltfBuilder file = rich_file();
        file.json["extensions"]["KHR_lights_punctual"]["lights"] = json::array({light});
        return error_of(file);
    };
    EXPECT_CONTAINS(with_light({{"type", "area"}}),
                    "light 0: its type 'area' is not point, spot or directional");
    EXPECT_CONTAINS(with_light({{"type", "point"}, {"intensity", -1}}), "finite and not negative");
    EXPECT_CONTAINS(with_light({{"type", "point"}, {"color", {1, 1}}}), "color must be a list of 3 numbers");
    EXPECT_CONTAINS(with_light({{"type", "point"}, {"range", -2}}), "range -2 must be positive");
    EXPECT_CONTAINS(
        with_light({{"type", "spot"}, {"spot", {{"innerConeAngle", 1}, {"outerConeAngle", 0.5}}}}),
        "0 <= inner < outer");
}

}  // namespace
}  // namespace obscura
