// SPDX-License-Identifier: Apache-2.0
// Cameras from files are rigid whatever their node's transform; a scene without one is framed.
#include "scene/gltf.h"
#include "scene/settings.h"
#include "support/errors.h"
#include "support/gltf_builder.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>

namespace obscura {
namespace {

using nlohmann::json;

// The first camera of a scene with one triangle and a camera on a node, below a parent.
Camera load_camera(const json& camera, const json& node, const json& parent = json::object()) {
    const test::TemporaryFolder folder;
    test::GltfBuilder file;
    file.add_triangle();
    file.append("cameras", camera);
    json with_camera = node;
    with_camera["camera"] = 0;
    json with_child = parent;
    with_child["children"] = {file.append("nodes", with_camera)};
    file.append("nodes", with_child);
    return load_gltf(file.write_glb(folder.file("test.glb"))).cameras.at(0);
}

const json PERSPECTIVE = {{"type", "perspective"}, {"perspective", {{"yfov", 0.6}, {"znear", 0.1}}}};

void expect_rigid(const M44d& matrix) {
    const V3d x(matrix[0][0], matrix[0][1], matrix[0][2]);
    const V3d y(matrix[1][0], matrix[1][1], matrix[1][2]);
    const V3d z(matrix[2][0], matrix[2][1], matrix[2][2]);
    EXPECT_NEAR(x.length(), 1, 1e-12);
    EXPECT_NEAR(y.length(), 1, 1e-12);
    EXPECT_NEAR((x.cross(y) - z).length(), 0, 1e-12);  // right-handed
    EXPECT_EQ(V3d(matrix[0][3], matrix[1][3], matrix[2][3]), V3d(0, 0, 0));
    EXPECT_EQ(matrix[3][3], 1);
}

TEST(Camera, PerspectiveTakesItsNodesPlace) {
    const Camera camera = load_camera(PERSPECTIVE, {{"name", "eye"}, {"translation", {1, 2, 3}}});
    EXPECT_EQ(camera.name, "eye");
    EXPECT_FALSE(camera.orthographic);
    EXPECT_EQ(camera.vertical_fov, 0.6);
    EXPECT_EQ(camera.camera_to_world.translation(), V3d(1, 2, 3));
    expect_rigid(camera.camera_to_world);
}

TEST(Camera, OrthographicKeepsItsHalfHeight) {
    const Camera camera =
        load_camera({{"type", "orthographic"},
                     {"name", "plan"},
                     {"orthographic", {{"xmag", 4}, {"ymag", 3}, {"znear", 0}, {"zfar", 10}}}},
                    {{"scale", {2, 2, 2}}});
    EXPECT_EQ(camera.name, "plan");
    EXPECT_TRUE(camera.orthographic);
    EXPECT_EQ(camera.half_height, 3);
    expect_rigid(camera.camera_to_world);
}

TEST(Camera, ScaleShearAndMirroringAreRemoved) {
    const double h = std::sqrt(0.5);
    for (const json& parent :
         {json{{"scale", {2, 3, 4}}}, json{{"scale", {-1, 1, 1}}}, json{{"scale", {1, -2, 1}}},
          json{{"matrix", {1, 0.5, 0, 0, 0, 1, 0, 0, 0.25, 0, 1, 0, 1, 1, 1, 1}}}}) {
        const Camera camera =
            load_camera(PERSPECTIVE, {{"rotation", {0, h, 0, h}}, {"translation", {0, 0, 1}}}, parent);
        expect_rigid(camera.camera_to_world);
    }
    // A quarter turn about y: it looks along -x, scaled or not.
    const Camera camera = load_camera(PERSPECTIVE, {{"rotation", {0, h, 0, h}}}, {{"scale", {2, 3, 4}}});
    V3d forward;
    camera.camera_to_world.multDirMatrix(V3d(0, 0, -1), forward);
    EXPECT_NEAR((forward - V3d(-1, 0, 0)).length(), 0, 1e-12);
}

TEST(Camera, AnotherShapeOfPictureIsNews) {
    const test::TemporaryFolder folder;
    test::GltfBuilder file;
    file.add_triangle();
    file.append("cameras", {{"type", "perspective"},
                            {"perspective", {{"yfov", 0.6}, {"znear", 0.1}, {"aspectRatio", 1.5}}}});
    file.append("nodes", {{"camera", 0}});
    const Scene scene = load_gltf(file.write_glb(folder.file("test.glb")));
    const auto said_of = [&](uint32_t width, uint32_t height) {
        RenderSettings settings;
        settings.width = width;
        settings.height = height;
        testing::internal::CaptureStderr();
        check_aspect(settings, scene.cameras.at(0).aspect_ratio);
        return testing::internal::GetCapturedStderr();
    };
    EXPECT_EQ(said_of(300, 200), "");
    EXPECT_EQ(said_of(301, 200), "");
    EXPECT_NE(said_of(400, 300).find("made for pictures of aspect ratio 1.5; this one has 1.333"),
              std::string::npos);
}

TEST(Camera, MissingOneFramesTheScene) {
    const test::TemporaryFolder folder;
    test::GltfBuilder file;
    const int positions = file.accessor<float>({10, 0, 0, 14, 0, 0, 10, 6, 3}, "VEC3");
    file.append("nodes", {{"mesh", file.mesh({{"POSITION", positions}})}});
    testing::internal::CaptureStderr();
    const Scene scene = load_gltf(file.write_glb(folder.file("test.glb")));
    EXPECT_NE(testing::internal::GetCapturedStderr().find("no camera"), std::string::npos);
    ASSERT_EQ(scene.cameras.size(), 1u);
    const Camera& camera = scene.cameras[0];
    expect_rigid(camera.camera_to_world);
    const M44d to_camera = camera.camera_to_world.inverse();
    for (const Vertex& vertex : scene.vertices) {
        V3d seen;
        to_camera.multVecMatrix(V3d(vertex.position), seen);
        EXPECT_LT(seen.z, 0);
        EXPECT_LE(std::abs(seen.y), -seen.z * std::tan(camera.vertical_fov / 2));
        EXPECT_LE(std::abs(seen.x), -seen.z * std::tan(camera.vertical_fov / 2));
    }
}

TEST(Camera, ImpossibleLensIsAnError) {
    for (const double fov : {0.0, -1.0, 3.2})
        EXPECT_INPUT_ERROR(
            load_camera({{"type", "perspective"}, {"perspective", {{"yfov", fov}, {"znear", 1}}}},
                        json::object()),
            "yfov must be between 0 and pi");
    EXPECT_INPUT_ERROR(load_camera({{"type", "orthographic"},
                                    {"orthographic", {{"xmag", 1}, {"ymag", 0}, {"znear", 0}, {"zfar", 1}}}},
                                   json::object()),
                       "ymag must be positive");
    EXPECT_INPUT_ERROR(load_camera(PERSPECTIVE, {{"scale", {1, 1, 0}}}), "leaves its camera no direction");
}

}  // namespace
}  // namespace obscura
