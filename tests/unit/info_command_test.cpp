// SPDX-License-Identifier: Apache-2.0
// `obscura info`: the table and the JSON say what is in the file.
#include "cli/info.h"

#include "base/file.h"
#include "support/command.h"
#include "support/errors.h"
#include "support/gltf_builder.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

namespace obscura {
namespace {

using nlohmann::json;
using test::run_command;

// A lamp of 0.5 m^2 that emits 4, and a grey triangle of 2 m^2 with R = 0.5.
std::string write_scene(const test::TemporaryFolder& folder) {
    test::GltfBuilder file;
    const int lamp = file.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    const int floor = file.accessor<float>({0, 0, 1, 2, 0, 1, 0, 2, 1}, "VEC3");
    const json no_specular = {{"KHR_materials_specular", {{"specularFactor", 0}}}};
    file.append("materials",
                {{"extensions", no_specular},
                 {"emissiveFactor", {4, 4, 4}},
                 {"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, 1}}, {"metallicFactor", 0}}}});
    file.append("materials",
                {{"extensions", no_specular},
                 {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.5, 0.5, 1}}, {"metallicFactor", 0}}}});
    file.append("nodes", {{"mesh", file.mesh({{"POSITION", lamp}}, -1, {{"material", 0}})}});
    file.append("nodes", {{"mesh", file.mesh({{"POSITION", floor}}, -1, {{"material", 1}})}});
    file.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 1}}}});
    file.append("nodes", {{"camera", 0}, {"name", "door"}});
    return file.write_glb(folder.file("room.glb"));
}

TEST(InfoCommand, JsonHoldsCountsAndAverages) {
    const test::TemporaryFolder folder;
    const std::string scene = write_scene(folder);
    const json info = json::parse(run_command(add_info_command, {"info", scene, "--json", "-"}).out);
    EXPECT_EQ(info["triangles"], 2);
    EXPECT_EQ(info["objects"], 2);
    EXPECT_EQ(info["emissive_triangles"], 1);
    EXPECT_EQ(info["cameras"][0]["name"], "door");
    EXPECT_DOUBLE_EQ(info["area"], 2.5);
    EXPECT_DOUBLE_EQ(info["R_ave"][1], 0.4);
    EXPECT_DOUBLE_EQ(info["I_A"][2], 2.0 / 2.5 / 0.6);
    EXPECT_DOUBLE_EQ(info["I_A_colourless"][0], 2.0 / 2.5 / 0.6 * 0.4);
    EXPECT_EQ(info["bounds"]["max"], (json{2, 2, 1}));
    EXPECT_DOUBLE_EQ(info["diagonal"], 3);
    EXPECT_EQ(info["needs"], (json{"area_lights", "emission", "bleeding", "obscurance", "ambient"}));
    EXPECT_EQ(info["needs_reasons"]["area_lights"], "1 emissive triangle");
    EXPECT_EQ(info["needs_reasons"].size(), 15u);
}

TEST(InfoCommand, JsonFileEqualsStandardOutput) {
    const test::TemporaryFolder folder;
    const std::string scene = write_scene(folder);
    const std::string out = run_command(add_info_command, {"info", scene, "--json", "-"}).out;
    run_command(add_info_command, {"info", scene, "--json", folder.file("info.json")});
    EXPECT_EQ(read_text(folder.file("info.json")), out);
}

TEST(InfoCommand, JsonOfAPathThatIsNotUtf8IsValid) {
    const test::TemporaryFolder folder;
    const std::string odd = folder.file("r\xf6\xf6m.glb");  // Latin-1
    std::filesystem::rename(write_scene(folder), odd);
    const json info = json::parse(run_command(add_info_command, {"info", odd, "--json", "-"}).out);
    EXPECT_EQ(info["file"], folder.file("r\ufffd\ufffdm.glb"));
}

TEST(InfoCommand, TableNamesEachPart) {
    const test::TemporaryFolder folder;
    const std::string out = run_command(add_info_command, {"info", write_scene(folder)}).out;
    for (const char* expected :
         {"room.glb", "triangles       2", "diagonal        3 m", "1 emissive triangle",
          "0               door at (0, 0, 0), 28.65 degrees high", "R_ave           0.4", "yes area_lights",
          "-   mirror              no material has a mirror lobe"})
        EXPECT_NE(out.find(expected), std::string::npos) << expected << "\nin\n" << out;
}

// Far from the origin, where the reader moves a scene: positions are the world's all the same.
TEST(InfoCommand, TableHasTheFirstTenLightsAndTheJsonAll) {
    const test::TemporaryFolder folder;
    test::GltfBuilder file;
    file.add_triangle();
    file.json["nodes"][0]["translation"] = {1000, 0, 0};
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 20}}};
    for (int i = 0; i < 12; ++i)
        file.append("nodes", {{"name", "lamp"},
                              {"translation", {1000, i, 0}},
                              {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    const std::string scene = file.write_glb(folder.file("lamps.glb"));
    const std::string out = run_command(add_info_command, {"info", scene}).out;
    EXPECT_NE(out.find("20 20 20 W/sr (RGB) at (1000, 9, 0)\n  and             2 more\n"), std::string::npos)
        << out;
    EXPECT_EQ(out.find("(1000, 10, 0)"), std::string::npos) << out;
    const json lights =
        json::parse(run_command(add_info_command, {"info", scene, "--json", "-"}).out)["lights"];
    ASSERT_EQ(lights.size(), 12u);
    EXPECT_EQ(lights[11]["position"], (json{1000, 11, 0}));
}

TEST(InfoCommand, BadSceneIsAnInputError) {
    EXPECT_INPUT_ERROR(run_command(add_info_command, {"info", "no/such/scene"}),
                       "no such scene file or folder");
    EXPECT_THROW(run_command(add_info_command, {"info"}), CLI::ParseError);
}

}  // namespace
}  // namespace obscura
