// SPDX-License-Identifier: Apache-2.0
// Reading glTF: materials, textures and lights arrive as the specification says, and what isn't supported is
// named in a warning.
#include "scene/gltf.h"

#include "support/gltf_load.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace obscura {
namespace {

using nlohmann::json;
using test::add_image_texture;
using test::expect_near;
using test::GltfBuilder;
using test::load;
using test::Loaded;
using test::TemporaryFolder;

// A triangle whose material is the given one.
GltfBuilder with_material(const json& material) {
    GltfBuilder file;
    const int positions = file.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    const int uvs = file.accessor<float>({0, 0, 1, 0, 0, 1}, "VEC2");
    file.append("materials", material);
    const int mesh = file.mesh({{"POSITION", positions}, {"TEXCOORD_0", uvs}}, -1, {{"material", 0}});
    file.append("nodes", {{"mesh", mesh}});
    return file;
}

TEST(GltfMaterial, MaterialFactorsArrive) {
    const Scene scene =
        load(with_material(
                 {{"name", "paint"},
                  {"doubleSided", true},
                  {"emissiveFactor", {0.5, 0.25, 1}},
                  {"pbrMetallicRoughness",
                   {{"baseColorFactor", {0.1, 0.2, 0.3, 1}},
                    {"metallicFactor", 0.25},
                    {"roughnessFactor", 0.75}}},
                  {"extensions",
                   {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}},
                    {"KHR_materials_specular", {{"specularFactor", 0.5}, {"specularColorFactor", {1, 2, 0}}}},
                    {"KHR_materials_transmission", {{"transmissionFactor", 0.125}}}}}}))
            .scene;
    ASSERT_EQ(scene.materials.size(), 1u);
    const Material& material = scene.materials[0];
    EXPECT_EQ(material.name, "paint");
    EXPECT_EQ(material.base_color, Rgb(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(material.metallic, 0.25f);
    EXPECT_EQ(material.roughness, 0.75f);
    EXPECT_EQ(material.emission, Rgb(4, 2, 8));
    EXPECT_EQ(material.specular, 0.5f);
    EXPECT_EQ(material.specular_color, Rgb(1, 2, 0));
    EXPECT_EQ(material.transmission, 0.125f);
    EXPECT_TRUE(material.double_sided);
    EXPECT_FALSE(material.unlit);
}

TEST(GltfMaterial, MissingMaterialIsTheDefault) {
    GltfBuilder file;
    file.add_triangle();
    const Scene scene = load(file).scene;
    ASSERT_EQ(scene.materials.size(), 1u);
    EXPECT_EQ(scene.materials[0].base_color, Rgb(1, 1, 1));
    EXPECT_EQ(scene.materials[0].metallic, 1);
    EXPECT_EQ(scene.materials[0].roughness, 1);
    EXPECT_FALSE(scene.materials[0].double_sided);
}

TEST(GltfMaterial, UnlitMaterialDoesNotEmit) {
    const Scene scene = load(with_material({{"emissiveFactor", {1, 1, 1}},
                                            {"extensions", {{"KHR_materials_unlit", json::object()}}}}))
                            .scene;
    EXPECT_TRUE(scene.materials[0].unlit);
    EXPECT_EQ(scene.materials[0].emission, Rgb(0, 0, 0));
}

TEST(GltfTexture, TextureArrivesWithItsSampler) {
    GltfBuilder file = with_material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    add_image_texture(file, test::PNG_FOUR_COLORS, {{"magFilter", 9728}, {"wrapS", 33071}, {"wrapT", 33648}});
    const Scene scene = load(file).scene;
    ASSERT_EQ(scene.textures.size(), 1u);
    const Texture& texture = scene.textures[0];
    EXPECT_EQ(texture.width, 2u);
    EXPECT_EQ(texture.height, 2u);
    EXPECT_EQ(texture.rgba,
              (std::vector<uint8_t>{255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 128, 128, 128, 255}));
    EXPECT_EQ(texture.filter, TextureFilter::nearest);
    EXPECT_EQ(texture.wrap_u, Wrap::clamp_to_edge);
    EXPECT_EQ(texture.wrap_v, Wrap::mirrored_repeat);
    EXPECT_EQ(scene.materials[0].base_color_texture, 0);
    EXPECT_EQ(scene.corner(0, 1).uv, V2f(1, 0));
}

TEST(GltfTexture, TextureDefaultsToRepeatAndLinear) {
    GltfBuilder file = with_material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    add_image_texture(file, test::PNG_16_BIT);
    const Scene scene = load(file).scene;
    EXPECT_EQ(scene.textures.at(0).wrap_u, Wrap::repeat);
    EXPECT_EQ(scene.textures.at(0).filter, TextureFilter::linear);
    EXPECT_EQ(scene.textures.at(0).rgba, (std::vector<uint8_t>{128, 255, 0, 255}));
}

TEST(GltfTexture, TextureFileIsFoundBesideTheScene) {
    const TemporaryFolder folder;
    GltfBuilder file = with_material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    file.append("images", {{"uri", "four%20colors.png"}});
    file.append("textures", {{"source", 0}});
    test::write_file(folder.file("four colors.png"), test::PNG_FOUR_COLORS);
    EXPECT_EQ(load_gltf(file.write_gltf(folder.file("test.gltf"))).textures.at(0).width, 2u);
}

TEST(GltfTexture, TextureTransformAndSetApplyToCoordinates) {
    GltfBuilder file;
    const int positions = file.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    const int unused = file.accessor<float>({9, 9, 9, 9, 9, 9}, "VEC2");
    const int uvs = file.accessor<float>({0, 0, 1, 0, 0, 1}, "VEC2");
    // The specification's example: the lower left quadrant, turned by 90 degrees.
    file.append("materials", {{"pbrMetallicRoughness",
                               {{"baseColorTexture",
                                 {{"index", 0},
                                  {"texCoord", 0},
                                  {"extensions",
                                   {{"KHR_texture_transform",
                                     {{"offset", {0, 1}},
                                      {"rotation", std::numbers::pi / 2},
                                      {"scale", {0.5, 0.5}},
                                      {"texCoord", 1}}}}}}}}}});
    add_image_texture(file, test::PNG_FOUR_COLORS);
    file.append("nodes",
                {{"mesh", file.mesh({{"POSITION", positions}, {"TEXCOORD_0", unused}, {"TEXCOORD_1", uvs}},
                                    -1, {{"material", 0}})}});
    const Scene scene = load(file).scene;
    expect_near(V3f(scene.corner(0, 0).uv.x, scene.corner(0, 0).uv.y, 0), V3f(0, 1, 0));
    expect_near(V3f(scene.corner(0, 1).uv.x, scene.corner(0, 1).uv.y, 0), V3f(0, 0.5f, 0));
    expect_near(V3f(scene.corner(0, 2).uv.x, scene.corner(0, 2).uv.y, 0), V3f(0.5f, 1, 0));
}

TEST(GltfLight, LightsTakeTheirNodesPlace) {
    GltfBuilder file;
    file.add_triangle();
    const double h = std::sqrt(0.5);
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"color", {1, 0.5, 0}}, {"intensity", 10}, {"range", 7}},
        {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}, {"name", "torch"}},
        {{"type", "directional"}, {"intensity", 3}}};
    file.append("nodes",
                {{"translation", {1, 2, 3}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    // A quarter turn about x takes -z to +y; the scale changes nothing.
    file.append("nodes", {{"rotation", {h, 0, 0, h}},
                          {"scale", {5, 5, 5}},
                          {"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}});
    file.append("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", 2}}}}}});
    const Scene scene = load(file).scene;
    ASSERT_EQ(scene.lights.size(), 3u);
    EXPECT_EQ(scene.lights[0].type, LightType::point);
    EXPECT_EQ(scene.lights[0].position, V3f(1, 2, 3));
    EXPECT_EQ(scene.lights[0].intensity, Rgb(10, 5, 0));
    EXPECT_EQ(scene.lights[0].range, 7);
    EXPECT_EQ(scene.lights[1].type, LightType::spot);
    EXPECT_EQ(scene.lights[1].name, "torch");
    expect_near(scene.lights[1].direction, V3f(0, 1, 0));
    EXPECT_FLOAT_EQ(scene.lights[1].cos_inner, std::cos(0.25f));
    EXPECT_FLOAT_EQ(scene.lights[1].cos_outer, std::cos(0.5f));
    EXPECT_EQ(scene.lights[2].type, LightType::directional);
    EXPECT_EQ(scene.lights[2].direction, V3f(0, 0, -1));
    EXPECT_EQ(scene.lights[2].intensity, Rgb(3, 3, 3));
}

TEST(GltfMaterial, UnsupportedThingsAreNamedOnceWithACount) {
    GltfBuilder file;
    const int positions = file.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    add_image_texture(file, test::PNG_FOUR_COLORS);
    for (int i = 0; i < 2; ++i) {
        file.append("materials", {{"alphaMode", "BLEND"},
                                  {"normalTexture", {{"index", 0}}},
                                  {"occlusionTexture", {{"index", 0}}},
                                  {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                                  {"extensions",
                                   {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                                    {"KHR_materials_ior", {{"ior", 1.3}}}}}});
        file.append("nodes",
                    {{"mesh", file.mesh({{"POSITION", positions}, {"COLOR_0", positions}}, -1,
                                        {{"material", i}, {"targets", {{{"POSITION", positions}}}}})},
                     {"skin", 0}});
        file.append("nodes", {{"mesh", file.mesh({{"POSITION", positions}}, -1, {{"mode", 1}})}});
    }
    file.json["skins"] = {{{"joints", {0}}}};
    file.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing", "KHR_materials_unlit"};
    const std::string said = load(file).said;
    for (const char* expected :
         {"normal maps are not supported yet and are ignored (2 materials)",
          "alphaMode BLEND is not supported yet", "occlusion textures are ignored",
          "rendered as a thin clear pane (2 materials)", "panes are smooth on both sides (2 materials)",
          "vertex colours are not supported yet and are ignored (2 primitives)",
          "morph targets are not supported", "skins are not supported",
          "points and lines are not rendered (2 primitives)", "indices of refraction",
          "meets a mesh without texture coordinates (2 primitives)", "the extension EXT_mesh_gpu_instancing"})
        EXPECT_NE(said.find(expected), std::string::npos) << expected << "\nin\n" << said;
    EXPECT_EQ(said.find("KHR_materials_unlit"), std::string::npos);
    EXPECT_EQ(said.find("normal maps"), said.rfind("normal maps"));
}

TEST(GltfMaterial, WhatElseTheFileHoldsIsNamed) {
    GltfBuilder file = with_material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                                      {"extensions", {{"KHR_materials_sheen", json::object()}}}});
    add_image_texture(file, test::PNG_FOUR_COLORS, {{"minFilter", 9987}});
    file.json["scenes"] = {{{"nodes", {0}}}, {{"nodes", json::array()}}, {{"nodes", json::array()}}};
    const json sampler = {{"input", 0}, {"output", 0}};
    const json channel = {{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}};
    file.json["animations"] = {{{"samplers", {sampler}}, {"channels", {channel}}}};
    const std::string said = load(file).said;
    for (const char* expected :
         {"the extension KHR_materials_sheen is not supported yet",
          "animations are not played; nodes keep their place in the file (1 animation)",
          "only the default scene is rendered; others are ignored (2 other scenes)",
          "mipmaps are not used; textures keep their full resolution (1 texture)"})
        EXPECT_NE(said.find(expected), std::string::npos) << expected << "\nin\n" << said;
}

TEST(GltfMaterial, SmoothPanesAndPlainSamplersAreNoNews) {
    GltfBuilder file = with_material(
        {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}, {"roughnessFactor", 0}}},
         {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}});
    add_image_texture(file, test::PNG_FOUR_COLORS, {{"minFilter", 9729}});
    const std::string said = load(file).said;
    EXPECT_EQ(said.find("smooth"), std::string::npos) << said;
    EXPECT_EQ(said.find("mipmaps"), std::string::npos) << said;
}

TEST(GltfMaterial, UnsupportedTexturesStandInWithTheirMean) {
    GltfBuilder file =
        with_material({{"emissiveFactor", {1, 1, 1}},
                       {"emissiveTexture", {{"index", 0}}},
                       {"pbrMetallicRoughness", {{"metallicRoughnessTexture", {{"index", 0}}}}}});
    add_image_texture(file, test::PNG_FOUR_COLORS);
    const Loaded loaded = load(file);
    const Material& material = loaded.scene.materials.at(0);
    const float mean = (1 + 128 / 255.0f) / 4;  // of green and of blue: one texel full, one 128
    EXPECT_FLOAT_EQ(material.roughness, mean);
    EXPECT_FLOAT_EQ(material.metallic, mean);
    EXPECT_FLOAT_EQ(material.emission.x, static_cast<float>((1 + srgb_to_linear(128)) / 4));
    EXPECT_NE(loaded.said.find("their mean colour is used (1 material)"), std::string::npos) << loaded.said;
    EXPECT_TRUE(loaded.scene.textures.empty());
}

}  // namespace
}  // namespace obscura
