// SPDX-License-Identifier: Apache-2.0
// Scenes far from the origin are moved near it, and tiny and huge ones measured in another unit, without changing a bit
// of their geometry.
#include "scene/local_frame.h"

#include "reference/meshes.h"
#include "scene/gltf.h"
#include "scene/radiometry.h"
#include "support/errors.h"
#include "support/gltf_builder.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

namespace obscura {
namespace {

TEST(LocalFrame, FarSceneIsMovedExactly) {
    for (const V3f& center : {V3f(3.1f, -3.2f, 1e7f), V3f(-1e4f, 1e5f, 123456.7f)}) {
        const Scene far = icosphere(3, 1, center);
        Scene moved = far;
        moved.lights.resize(1);
        moved.lights[0].position = center + V3f(2);
        moved.cameras.emplace_back();
        moved.cameras[0].camera_to_world.translate(V3d(center));
        move_near_origin(moved);
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_LE(std::abs(moved.bounds.min[axis]), 1.6f);
            EXPECT_LE(std::abs(moved.bounds.max[axis]), 1.6f);
        }
        for (size_t i = 0; i < far.vertices.size(); ++i)
            ASSERT_EQ(V3d(moved.vertices[i].position) + moved.origin, V3d(far.vertices[i].position));
        EXPECT_LE((V3d(moved.lights[0].position) + moved.origin - V3d(center + V3f(2))).length(), 1e-6);
        EXPECT_EQ(world_camera(moved, moved.cameras[0]).camera_to_world.translation(), V3d(center));
    }
}

TEST(LocalFrame, SceneAroundTheOriginStays) {
    for (const V3f& center : {V3f(0, 0, 0), V3f(2.9f, -2.9f, 0.5f)}) {
        Scene scene = icosphere(2, 1, center);
        const Box3f before = scene.bounds;
        move_near_origin(scene);
        EXPECT_EQ(scene.origin, V3d(0));
        EXPECT_EQ(scene.bounds, before);
    }
}

TEST(LocalFrame, UnitOfUsualScenesIsTheMetre) {
    EXPECT_EQ(scene_unit({}), 1) << "no triangle";
    for (const auto& [smallest, largest] : {std::pair{1.0, 1.0}, {1e-6, 10.0}, {1e-12, 1e12}})
        EXPECT_EQ(scene_unit({smallest, largest}), 1) << largest;
}

TEST(LocalFrame, UnitKeepsSmallestAndLargestInRange) {
    for (const auto& [smallest, largest] :
         {std::pair{0x1p-140, 0x1p-138}, {1e-20, 10.0}, {1.0, 1e17}, {0x1p60, 0x1p61}, {0x1p100, 0x1p126}}) {
        const double unit = scene_unit({smallest, largest});
        EXPECT_EQ(std::exp2(std::round(std::log2(unit))), unit);
        EXPECT_GE(smallest / unit, 0x1p-40) << largest;
        EXPECT_LE(largest / unit, 0x1p40) << largest;
    }
    EXPECT_LE(1e30 / scene_unit({1e-30, 1e30}), 0x1p41) << "the largest stay";
}

TEST(LocalFrame, ReaderMovesAFarScene) {
    const test::TemporaryFolder folder;
    test::GltfBuilder file;
    file.add_triangle();
    file.json["nodes"][0]["translation"] = {1e6, 0, 0};
    const Scene scene = load_gltf(file.write_glb(folder.file("far.glb")));
    EXPECT_NEAR(scene.origin.x, 1e6, 1);
    EXPECT_EQ(scene.origin.y, 0);
}

// A triangle of legs 2^exponent m, seen by an orthographic camera as high and lit from as far.
Scene scaled_triangle(int exponent) {
    const double size = std::ldexp(1.0, exponent);
    const test::TemporaryFolder folder;
    test::GltfBuilder file;
    file.add_triangle();
    file.json["nodes"][0]["scale"] = {size, size, size};
    file.json["cameras"] = {
        {{"type", "orthographic"},
         {"orthographic", {{"xmag", size}, {"ymag", size}, {"znear", 0}, {"zfar", size}}}}};
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"intensity", 3 * size * size}, {"range", size}},
        {{"type", "directional"}, {"intensity", 5}}};
    file.json["extensionsUsed"] = {"KHR_lights_punctual"};
    file.append("nodes", {{"camera", 0}, {"translation", {0, 0, size}}});
    for (const int light : {0, 1})
        file.append("nodes", {{"translation", {0, 0, size}},
                              {"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}});
    return load_gltf(file.write_glb(folder.file("scaled.glb")));
}

TEST(LocalFrame, ReaderGivesTinyAndHugeScenesAUnitOfTheirOwn) {
    const Scene usual = scaled_triangle(0);
    ASSERT_EQ(usual.unit, 1);
    ASSERT_EQ(usual.triangles.size(), 1u);
    const Radiometry averages = compute_radiometry(usual);
    for (const int exponent : {-140, -60, -41, 41, 60, 126}) {
        SCOPED_TRACE(exponent);
        const double size = std::ldexp(1.0, exponent);
        const Scene scene = scaled_triangle(exponent);
        EXPECT_EQ(scene.unit, size);
        EXPECT_EQ(diagonal(scene), size * diagonal(usual));
        ASSERT_EQ(scene.triangles.size(), 1u);
        for (size_t i = 0; i < usual.vertices.size(); ++i)
            EXPECT_EQ(world_position(scene, scene.vertices[i].position),
                      size * world_position(usual, usual.vertices[i].position));
        const Camera camera = world_camera(scene, scene.cameras[0]);
        EXPECT_EQ(camera.half_height, size);
        EXPECT_EQ(camera.camera_to_world.translation(), V3d(0, 0, size));
        EXPECT_EQ(world_intensity(scene, scene.lights[0]), RgbD(3 * size * size));
        EXPECT_EQ(scene.unit * static_cast<double>(scene.lights[0].range), size);
        EXPECT_EQ(world_position(scene, scene.lights[0].position), V3d(0, 0, size));
        EXPECT_EQ(world_intensity(scene, scene.lights[1]), RgbD(5));
        const Radiometry found = compute_radiometry(scene);
        EXPECT_EQ(found.area, size * size * averages.area);
        EXPECT_EQ(found.emitted, size * size * averages.emitted);
        EXPECT_EQ(found.ambient_bleeding, averages.ambient_bleeding);
    }
}

// Neither triangles without area nor vertices of no triangle say anything about the scene's size; a far object does, and
// leaves near ones what they need.
TEST(LocalFrame, UnitIsThatOfTrianglesWithArea) {
    const auto unit_with = [](const std::vector<float>& more, const std::vector<uint8_t>& indices) {
        const test::TemporaryFolder folder;
        test::GltfBuilder file;
        file.add_triangle();
        const int positions = file.accessor<float>(more, "VEC3");
        file.append(
            "nodes",
            {{"mesh", file.mesh({{"POSITION", positions}}, file.accessor<uint8_t>(indices, "SCALAR"))}});
        const Scene scene = load_gltf(file.write_glb(folder.file("junk.glb")));
        EXPECT_GE(scene.triangles.size(), 1u);
        return scene.unit;
    };
    EXPECT_EQ(unit_with({1e17f, 0, 0, 1e17f, 1, 0, 1e17f, 2, 0}, {0, 1, 2}), 1) << "no area";
    EXPECT_EQ(unit_with({0, 0, 0, 1, 0, 0, 0, 1, 0, 1e17f, 0, 0}, {0, 1, 2}), 1) << "not used";
    const double unit = unit_with({1e17f, 0, 0, 1e17f, 1e17f, 0, 1e17f, 0, 1e17f}, {0, 1, 2});
    EXPECT_GE(1 / unit, 0x1p-40);
    EXPECT_LE(1e17 / unit, 0x1p40);
}

// A lamp whose light at the distance of its scene's size is beyond floats.
TEST(LocalFrame, LampTooBrightForATinySceneIsAnError) {
    const test::TemporaryFolder folder;
    test::GltfBuilder file;
    file.add_triangle();
    file.json["nodes"][0]["scale"] = {1e-25, 1e-25, 1e-25};
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 1}}};
    file.append("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    EXPECT_INPUT_ERROR(load_gltf(file.write_glb(folder.file("bright.glb"))),
                       "its intensity 1 and color 1 must be finite and not negative");
}

}  // namespace
}  // namespace obscura
