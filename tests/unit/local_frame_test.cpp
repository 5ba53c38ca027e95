// SPDX-License-Identifier: Apache-2.0
// Scenes far from the origin are moved near it without changing a bit of their geometry.
#include "scene/local_frame.h"

#include "reference/meshes.h"
#include "scene/gltf.h"
#include "support/gltf_builder.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

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

TEST(LocalFrame, ReaderMovesAFarScene) {
    const test::TemporaryFolder folder;
    test::GltfBuilder file;
    file.add_triangle();
    file.json["nodes"][0]["translation"] = {1e6, 0, 0};
    const Scene scene = load_gltf(file.write_glb(folder.file("far.glb")));
    EXPECT_NEAR(scene.origin.x, 1e6, 1);
    EXPECT_EQ(scene.origin.y, 0);
}

}  // namespace
}  // namespace obscura
