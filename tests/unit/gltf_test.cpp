// SPDX-License-Identifier: Apache-2.0
// Reading glTF: triangles, transforms, objects and scenes arrive as the specification says.
#include "scene/gltf.h"

#include "support/errors.h"
#include "support/gltf_load.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

namespace obscura {
namespace {

using nlohmann::json;
using test::expect_near;
using test::GltfBuilder;
using test::load;
using test::Loaded;
using test::TemporaryFolder;
using test::world_position;

// The corners of a triangle, for comparison.
std::array<V3f, 3> corners(const Scene& scene, uint32_t triangle) {
    return {scene.corner(triangle, 0).position, scene.corner(triangle, 1).position,
            scene.corner(triangle, 2).position};
}

// One triangle in z = 0 facing +z, with the normal (0,0,1), on a node with these members.
GltfBuilder triangle_on_node(const json& node) {
    GltfBuilder file;
    const int positions = file.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    const int normals = file.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    json with_mesh = node;
    with_mesh["mesh"] = file.mesh({{"POSITION", positions}, {"NORMAL", normals}});
    file.append("nodes", with_mesh);
    return file;
}

TEST(Gltf, IndicesOfEveryTypeGiveTheSameTriangles) {
    const auto make = [](auto index_value) {
        using Index = decltype(index_value);
        GltfBuilder file;
        const int positions = file.accessor<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3");
        const int indices = file.accessor<Index>({0, 1, 2, 0, 2, 3}, "SCALAR");
        file.append("nodes", {{"mesh", file.mesh({{"POSITION", positions}}, indices)}});
        return load(file).scene;
    };
    for (const Scene& scene : {make(uint8_t{}), make(uint16_t{}), make(uint32_t{})}) {
        ASSERT_EQ(scene.triangles.size(), 2u);
        EXPECT_EQ(scene.vertices.size(), 4u);
        EXPECT_EQ(corners(scene, 1), (std::array{V3f(0, 0, 0), V3f(1, 1, 0), V3f(0, 1, 0)}));
        EXPECT_EQ(scene.bounds.max, V3f(1, 1, 0));
        EXPECT_EQ(geometric_normal(scene, 0), V3d(0, 0, 1));
        EXPECT_DOUBLE_EQ(triangle_area(scene, 0), 0.5);
    }
}

TEST(Gltf, StripAndFanKeepTheirOrientation) {
    for (const auto& [mode, points] :
         {std::pair{5, std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0}},
          {6, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, -1, 1, 0}}}) {
        GltfBuilder file;
        const int positions = file.accessor<float>(points, "VEC3");
        file.append("nodes", {{"mesh", file.mesh({{"POSITION", positions}}, -1, {{"mode", mode}})}});
        const Scene scene = load(file).scene;
        ASSERT_EQ(scene.triangles.size(), 3u);
        for (uint32_t i = 0; i < 3; ++i)
            EXPECT_EQ(geometric_normal(scene, i), V3d(0, 0, 1)) << mode << " " << i;
    }
}

TEST(Gltf, OnlyUsedVerticesAreKept) {
    GltfBuilder file;
    const int positions = file.accessor<float>({9, 9, 9, 0, 0, 0, 9, 9, 9, 1, 0, 0, 0, 1, 0}, "VEC3");
    const int indices = file.accessor<uint16_t>({1, 3, 4}, "SCALAR");
    file.append("nodes", {{"mesh", file.mesh({{"POSITION", positions}}, indices)}});
    const Scene scene = load(file).scene;
    EXPECT_EQ(scene.vertices.size(), 3u);
    EXPECT_EQ(scene.bounds.max, V3f(1, 1, 0));
}

TEST(Gltf, InterleavedAccessorsUseTheirStride) {
    GltfBuilder file;
    const std::vector<float> data{0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 1};
    const int view = file.view(data.data(), data.size() * 4);
    file.json["bufferViews"][0]["byteStride"] = 24;
    const json accessor = {{"bufferView", view}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}};
    json second = accessor;
    second["byteOffset"] = 12;
    const int positions = file.append("accessors", accessor);
    const int normals = file.append("accessors", second);
    file.append("nodes", {{"mesh", file.mesh({{"POSITION", positions}, {"NORMAL", normals}})}});
    const Scene scene = load(file).scene;
    ASSERT_EQ(scene.triangles.size(), 1u);
    EXPECT_EQ(corners(scene, 0)[2], V3f(0, 1, 0));
    EXPECT_EQ(scene.corner(0, 2).normal, V3f(0, 0, 1));
}

TEST(Gltf, SparseAccessorReplacesItsElements) {
    GltfBuilder file;
    const int positions = file.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    const std::vector<uint16_t> which{2};
    const std::vector<float> value{0, 5, 0};
    const int index_view = file.view(which.data(), 2);
    const int value_view = file.view(value.data(), 12);
    file.json["accessors"][0]["sparse"] = {{"count", 1},
                                           {"indices", {{"bufferView", index_view}, {"componentType", 5123}}},
                                           {"values", {{"bufferView", value_view}}}};
    file.append("nodes", {{"mesh", file.mesh({{"POSITION", positions}})}});
    EXPECT_EQ(corners(load(file).scene, 0), (std::array{V3f(0, 0, 0), V3f(1, 0, 0), V3f(0, 5, 0)}));
}

TEST(Gltf, NormalisedIntegersBecomeReal) {
    GltfBuilder file;
    const int positions = file.accessor<int16_t>({0, 0, 0, 2, 0, 0, 0, 3, 0}, "VEC3");
    file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    file.json["extensionsUsed"] = {"KHR_mesh_quantization"};
    const int normals = file.accessor<int8_t>({0, 0, 127, 0, 127, 0, 0, 0, -128}, "VEC3", true);
    const int uvs = file.accessor<uint8_t>({0, 255, 51, 0, 255, 0}, "VEC2", true);
    file.append("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    test::add_image_texture(file, test::PNG_FOUR_COLORS);
    file.append("nodes",
                {{"mesh", file.mesh({{"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", uvs}}, -1,
                                    {{"material", 0}})}});
    const Loaded loaded = load(file);
    EXPECT_EQ(loaded.said.find("warning"), std::string::npos) << loaded.said;
    EXPECT_EQ(corners(loaded.scene, 0)[2], V3f(0, 3, 0));
    EXPECT_EQ(loaded.scene.corner(0, 1).normal, V3f(0, 1, 0));
    EXPECT_EQ(loaded.scene.corner(0, 2).normal, V3f(0, 0, -1));
    EXPECT_EQ(loaded.scene.corner(0, 0).uv, V2f(0, 1));
    EXPECT_FLOAT_EQ(loaded.scene.corner(0, 1).uv.x, 0.2f);
}

TEST(Gltf, MissingNormalsAreZero) {
    GltfBuilder file;
    file.add_triangle();
    EXPECT_EQ(load(file).scene.corner(0, 0).normal, V3f(0, 0, 0));
}

TEST(Gltf, HierarchyMultipliesFromTheRoot) {
    // Quarter turn about z, then a shift: (1,0,0) -> (0,1,0) -> scaled by the parent -> shifted.
    const double h = std::sqrt(0.5);
    GltfBuilder file = triangle_on_node({{"rotation", {0, 0, h, h}}, {"translation", {0, 0, 1}}});
    file.append("nodes", {{"children", {0}}, {"scale", {2, 3, 4}}, {"translation", {10, 0, 0}}});
    const Scene scene = load(file).scene;
    expect_near(world_position(scene, 0, 0), V3f(10, 0, 4));
    expect_near(world_position(scene, 0, 1), V3f(10, 3, 4));
    expect_near(world_position(scene, 0, 2), V3f(8, 0, 4));
    EXPECT_EQ(scene.objects.size(), 1u);
}

TEST(Gltf, MatrixEqualsItsParts) {
    const double h = std::sqrt(0.5);
    const Scene parts =
        load(triangle_on_node({{"rotation", {0, h, 0, h}}, {"scale", {2, 3, 4}}, {"translation", {5, 6, 7}}}))
            .scene;
    // Columns: images of x (0,0,-2), y (0,3,0), z (4,0,0), origin (5,6,7).
    const Scene matrix =
        load(triangle_on_node({{"matrix", {0, 0, -2, 0, 0, 3, 0, 0, 4, 0, 0, 0, 5, 6, 7, 1}}})).scene;
    for (int i = 0; i < 3; ++i) {
        expect_near(world_position(parts, 0, i), world_position(matrix, 0, i));
        expect_near(parts.corner(0, i).normal, matrix.corner(0, i).normal);
    }
    expect_near(world_position(matrix, 0, 1), V3f(5, 6, 5));
    expect_near(matrix.corner(0, 0).normal, V3f(1, 0, 0));
}

TEST(Gltf, NormalsTakeTheInverseTranspose) {
    GltfBuilder file;
    const int positions = file.accessor<float>({1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3");
    const float n = std::sqrt(1.0f / 3);
    const int normals = file.accessor<float>({n, n, n, n, n, n, n, n, n}, "VEC3");
    file.append("nodes",
                {{"mesh", file.mesh({{"POSITION", positions}, {"NORMAL", normals}})}, {"scale", {4, 1, 1}}});
    const Scene scene = load(file).scene;
    expect_near(scene.corner(0, 0).normal, V3f(geometric_normal(scene, 0)));
}

TEST(Gltf, MirroringKeepsFrontAndNormalsTogether) {
    for (const json& scale : {json{-1, 1, 1}, json{1, 1, -2}, json{-3, -1, -1}, json{-1, -1, 1}}) {
        const Scene scene = load(triangle_on_node({{"scale", scale}})).scene;
        const V3d front = geometric_normal(scene, 0);
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(front.dot(V3d(scene.corner(0, i).normal)), 1, 1e-6) << scale;
        // The side that was in front in the mesh's own space stays in front.
        EXPECT_EQ(front.z, scale[2].get<double>() > 0 ? 1 : -1) << scale;
    }
}

TEST(Gltf, FlatteningScaleKeepsFacesInItsPlane) {
    const Loaded loaded = load(triangle_on_node({{"scale", {1, 1, 0}}}));
    ASSERT_EQ(loaded.scene.triangles.size(), 1u);
    EXPECT_EQ(loaded.scene.corner(0, 0).normal, V3f(0, 0, 1));
    const Loaded edge_on = load(triangle_on_node({{"scale", {1, 0, 1}}}));
    EXPECT_EQ(edge_on.scene.dropped_triangles, 1u);
}

TEST(Gltf, SharedMeshBecomesSeveralObjects) {
    GltfBuilder file = triangle_on_node({{"name", "left"}});
    file.append("nodes", {{"mesh", 0}, {"translation", {5, 0, 0}}});
    const Scene scene = load(file).scene;
    ASSERT_EQ(scene.objects.size(), 2u);
    EXPECT_EQ(scene.objects[0].name, "left");
    EXPECT_EQ(scene.objects[1].name, "thing");
    EXPECT_EQ(scene.objects[1].first_triangle, 1u);
    EXPECT_EQ(scene.objects[1].triangle_count, 1u);
    EXPECT_EQ(scene.triangles[1].object, 1u);
    EXPECT_EQ(scene.corner(1, 0).position, V3f(5, 0, 0));
}

TEST(Gltf, OnlyTheDefaultSceneIsLoaded) {
    GltfBuilder file = triangle_on_node({{"name", "shown"}});
    file.append("nodes", {{"mesh", 0}, {"name", "hidden"}});
    file.json["scenes"] = {{{"nodes", {1}}}, {{"nodes", {0}}}};
    file.json["scene"] = 1;
    const Scene scene = load(file).scene;
    ASSERT_EQ(scene.objects.size(), 1u);
    EXPECT_EQ(scene.objects[0].name, "shown");
}

// What counts is the product of the edges as the kernels compute it.
TEST(Gltf, TrianglesCountAsLongAsKernelsFindTheirNormal) {
    // Of this triangle, beside one of a metre that sets the unit.
    const auto kept = [](const std::vector<float>& positions) {
        GltfBuilder file;
        file.add_triangle();
        file.append("nodes", {{"mesh", file.mesh({{"POSITION", file.accessor<float>(positions, "VEC3")}})}});
        return load(file).scene.triangles.size() - 1;
    };
    // Its products agree in every bit of a float and differ in the next.
    EXPECT_EQ(kept({0, 0, 0, 0.5118216f, 0.9504637f, 0, 0.22135203f, 0.41105545f, 0}), 1u);
    EXPECT_EQ(kept({0, 0, 0, 1e-18f, 0, 0, 0, 1e-18f, 0}), 1u);
    EXPECT_EQ(kept({0, 0, 0, 1e-20f, 0, 0, 0, 1e-20f, 0}), 1u) << "in a unit between both";
    EXPECT_EQ(kept({0, 0, 0, 1e-34f, 0, 0, 0, 1e-34f, 0}), 0u) << "the product is no normal float";
}

TEST(Gltf, TrianglesWithoutAreaAreDroppedAndCounted) {
    GltfBuilder file;
    const int positions =
        file.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 1, 2, 2, 2}, "VEC3");
    const int indices = file.accessor<uint8_t>({0, 1, 2, 0, 1, 1, 3, 4, 5}, "SCALAR");
    file.append("nodes", {{"mesh", file.mesh({{"POSITION", positions}}, indices)}, {"name", "Floor"}});
    const Loaded loaded = load(file);
    EXPECT_EQ(loaded.scene.triangles.size(), 1u);
    EXPECT_EQ(loaded.scene.dropped_triangles, 2u);
    EXPECT_EQ(loaded.scene.objects[0].triangle_count, 1u);
    EXPECT_NE(loaded.said.find("2 triangles without area dropped, beginning with node 'Floor': mesh 'thing' "
                               "primitive 0, triangle 1.\n"),
              std::string::npos)
        << loaded.said;
}

TEST(Gltf, TextFormWithEitherBufferEqualsBinary) {
    const TemporaryFolder folder;
    const GltfBuilder file = triangle_on_node({{"translation", {1, 0, 0}}});
    const std::string text = file.gltf_text("data.bin");
    test::write_file(folder.file("external.gltf"), {text.begin(), text.end()});
    test::write_file(folder.file("data.bin"), file.buffer);
    for (const std::string& path : {file.write_glb(folder.file("a.glb")),
                                    file.write_gltf(folder.file("b.gltf")), folder.file("external.gltf")}) {
        const Scene scene = load_gltf(path);
        ASSERT_EQ(scene.triangles.size(), 1u) << path;
        EXPECT_EQ(world_position(scene, 0, 1), V3f(2, 0, 0));
        EXPECT_EQ(scene.name, std::filesystem::path(path).filename().string());
    }
}

TEST(Gltf, EmptySceneLoadsWithAWarning) {
    const Loaded loaded = load(GltfBuilder{});
    EXPECT_TRUE(loaded.scene.triangles.empty());
    EXPECT_TRUE(loaded.scene.bounds.isEmpty());
    EXPECT_EQ(loaded.scene.cameras.size(), 1u);
    EXPECT_NE(loaded.said.find("no triangles"), std::string::npos);
}

TEST(SceneFile, FolderMeansTheSceneOfItsName) {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder.path() / "kitchen");
    EXPECT_INPUT_ERROR(find_scene_file(folder.path() / "kitchen"), "no scene of its own name");
    GltfBuilder file;
    file.write_gltf(folder.file("kitchen/kitchen.gltf"));
    EXPECT_EQ(find_scene_file(folder.path() / "kitchen").filename(), "kitchen.gltf");
    EXPECT_EQ(find_scene_file(folder.file("kitchen/")).filename(), "kitchen.gltf");
    file.write_glb(folder.file("kitchen/kitchen.glb"));
    EXPECT_EQ(find_scene_file(folder.path() / "kitchen").filename(), "kitchen.glb");
    EXPECT_EQ(find_scene_file(folder.file("kitchen/kitchen.gltf")), folder.file("kitchen/kitchen.gltf"));
    EXPECT_INPUT_ERROR(find_scene_file(folder.file("missing")), "no such scene file or folder");
}

}  // namespace
}  // namespace obscura
