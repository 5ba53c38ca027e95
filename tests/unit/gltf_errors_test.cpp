// SPDX-License-Identifier: Apache-2.0
// Broken glTF files end in an InputError that names file and place, never in a crash or a half-read scene.
#include "support/gltf_errors.h"
#include "scene/gltf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

namespace obscura {
namespace {

using nlohmann::json;
using test::error_of;
using test::error_of_bytes;
using test::GltfBuilder;
using test::rich_file;
using test::TemporaryFolder;
using test::triangle;

constexpr float NOT_A_NUMBER = std::numeric_limits<float>::quiet_NaN();
constexpr float INFINITE = std::numeric_limits<float>::infinity();

TEST(GltfErrors, MissingFileIsNamed) {
    EXPECT_INPUT_ERROR(load_gltf("no/such/scene.glb"), "no/such/scene.glb");
    const TemporaryFolder folder;
    EXPECT_INPUT_ERROR(load_gltf(folder.path()), folder.path().string());
}

TEST(GltfErrors, EmptyAndForeignFilesAreRefused) {
    EXPECT_CONTAINS(error_of_bytes({}), "test.glb: the file is empty");
    EXPECT_CONTAINS(error_of_bytes({'h', 'e', 'l', 'l', 'o'}), "not a valid glTF file");
    EXPECT_CONTAINS(error_of_bytes({'{', '}'}), "not a valid glTF file: it has no asset object.");
    EXPECT_INPUT_ERROR(load_gltf("/dev/null"), "/dev/null: the file is empty");
    EXPECT_CONTAINS(error_of_bytes({'[', '1', ',', '2', ']'}), "not a valid glTF file");
}

TEST(GltfErrors, BrokenContainerSaysWhere) {
    const std::vector<uint8_t> good = triangle().glb_bytes();
    std::vector<uint8_t> bytes = good;
    bytes.resize(bytes.size() - 1);
    EXPECT_CONTAINS(error_of_bytes(bytes), "header: the file is truncated");
    bytes.resize(16);
    EXPECT_CONTAINS(error_of_bytes(bytes), "header: the file is truncated");
    bytes = good;
    bytes[4] = 1;
    EXPECT_CONTAINS(error_of_bytes(bytes), "version 1");
    bytes = good;
    bytes[14] = 0xff;  // length of the JSON chunk
    EXPECT_CONTAINS(error_of_bytes(bytes), "chunk 0: with its");
    bytes = good;
    bytes[16] = 'j';
    EXPECT_CONTAINS(error_of_bytes(bytes), "chunk 0: it is not the JSON chunk");
    // A binary chunk 8 bytes longer than what follows its header: tinygltf alone would read past the end.
    bytes = good;
    const auto json_bytes = static_cast<size_t>(bytes[12] | bytes[13] << 8);
    bytes[20 + json_bytes] = static_cast<uint8_t>(bytes[20 + json_bytes] + 8);
    EXPECT_CONTAINS(error_of_bytes(bytes), "chunk 1: with its 44 bytes it reaches past the end");
}

TEST(GltfErrors, JsonErrorsAreRefused) {
    const std::string broken = R"({"asset": {"version": "2.0"}, "nodes": [}])";
    EXPECT_CONTAINS(error_of_bytes({broken.begin(), broken.end()}, "a.gltf"),
                    "not a valid glTF file: parse error at line 1, column 41: ");
    const std::string huge = R"({"asset": {"version": "2.0"}, "nodes": [{"translation": [1e999, 0, 0]}]})";
    EXPECT_CONTAINS(error_of_bytes({huge.begin(), huge.end()}, "a.gltf"), "not a valid glTF file");
    const std::string deep = R"({"asset": {"version": "2.0"}, "extras": )" + std::string(100000, '[') +
                             std::string(100000, ']') + "}";
    EXPECT_CONTAINS(error_of_bytes({deep.begin(), deep.end()}, "a.gltf"), "levels deep");
}

TEST(GltfErrors, BufferFilesAreChecked) {
    const TemporaryFolder folder;
    const std::string text = triangle().gltf_text("data.bin");
    test::write_file(folder.file("a.gltf"), {text.begin(), text.end()});
    EXPECT_INPUT_ERROR(load_gltf(folder.file("a.gltf")),
                       "a.gltf: the file data.bin that it needs is missing.");
    test::write_file(folder.file("data.bin"), {1, 2, 3});
    EXPECT_INPUT_ERROR(load_gltf(folder.file("a.gltf")), "size mismatch");
    std::filesystem::remove(folder.file("data.bin"));
    std::filesystem::create_directory(folder.file("data.bin"));
    EXPECT_INPUT_ERROR(load_gltf(folder.file("a.gltf")), "data.bin");
}

TEST(GltfErrors, ShellSyntaxInUrisIsNotExpanded) {
    const TemporaryFolder folder;
    const std::string text = triangle().gltf_text("$(touch " + folder.file("touched") + ").bin");
    test::write_file(folder.file("a.gltf"), {text.begin(), text.end()});
    EXPECT_INPUT_ERROR(load_gltf(folder.file("a.gltf")), ".bin that it needs is missing");
    EXPECT_FALSE(std::filesystem::exists(folder.file("touched")));
}

TEST(GltfErrors, AccessorsMustFitTheirBuffers) {
    const std::string place = "mesh 'thing' primitive 0: POSITION: accessor 0: ";
    const auto change = [](const char* list, const char* key, const json& value) {
        GltfBuilder file = triangle();
        file.json[list][0][key] = value;
        return error_of(file);
    };
    EXPECT_CONTAINS(change("accessors", "count", 4),
                    place + "buffer view 0 of 36 bytes has no room for 4 elements of 12 bytes from byte 0");
    EXPECT_CONTAINS(change("accessors", "byteOffset", 4),
                    place + "buffer view 0 of 36 bytes has no room for 3 elements of 12 bytes from byte 4");
    EXPECT_CONTAINS(change("accessors", "byteOffset", 18446744073709551612u), "has no room for");
    EXPECT_CONTAINS(change("accessors", "count", 4294967296u), "more than 32-bit indices reach");
    EXPECT_CONTAINS(change("accessors", "count", 4294967295u), "has no room for");
    EXPECT_CONTAINS(change("accessors", "bufferView", 7),
                    place + "buffer view 7 does not exist; the file has 1");
    EXPECT_CONTAINS(change("accessors", "componentType", 5124), "component type 5124 is not one of glTF's");
    EXPECT_CONTAINS(change("accessors", "type", "VEC2"), "POSITION: its accessor 0 has the wrong type");
    EXPECT_CONTAINS(change("accessors", "componentType", 5125), "has the wrong type");
    EXPECT_CONTAINS(change("bufferViews", "buffer", 3), "buffer 3 does not exist");
    EXPECT_CONTAINS(change("bufferViews", "byteLength", 40), "buffer view 0 ends at byte 0 + 40");
    EXPECT_CONTAINS(change("bufferViews", "byteOffset", 18446744073709551615u),
                    "but its buffer has 36 bytes");
    EXPECT_CONTAINS(change("bufferViews", "byteStride", 8), "elements of 12 bytes overlap at a stride of 8");
    EXPECT_CONTAINS(change("bufferViews", "byteStride", 20), "has no room for");
    EXPECT_CONTAINS(change("bufferViews", "byteLength", 1), "buffer view 0 of 1 byte has no room");
    GltfBuilder file = triangle();
    file.json["accessors"][0].erase("bufferView");
    EXPECT_CONTAINS(error_of(file), "it has no buffer view");
    file = triangle();
    file.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 5;
    EXPECT_CONTAINS(error_of(file), "accessor 5 does not exist; the file has 1");
}

TEST(GltfErrors, SparseDataIsChecked) {
    const auto change = [](const char* part, const char* key, const json& value) {
        GltfBuilder file = rich_file();
        json& sparse = file.json["accessors"][0]["sparse"];
        (*part == '\0' ? sparse : sparse[part])[key] = value;
        return error_of(file);
    };
    EXPECT_CONTAINS(change("", "count", 2), "has no room for");
    EXPECT_CONTAINS(change("", "count", -1), "negative count");
    EXPECT_CONTAINS(change("indices", "byteOffset", -4), "negative count or offset");
    EXPECT_CONTAINS(change("indices", "componentType", 5126), "not an unsigned integer");
    EXPECT_CONTAINS(change("values", "bufferView", 99), "buffer view 99 does not exist");
    GltfBuilder file = rich_file();
    file.buffer[file.json["bufferViews"][4]["byteOffset"].get<size_t>()] = 4;
    EXPECT_CONTAINS(error_of(file), "sparse index 4 is outside its 4 elements");
}

TEST(GltfErrors, VerticesMustBeFinite) {
    const auto with_vertices = [](const std::vector<float>& positions, const std::vector<float>& normals,
                                  double scale) {
        GltfBuilder file;
        const int position = file.accessor<float>(positions, "VEC3");
        const int normal = file.accessor<float>(normals, "VEC3");
        const int mesh = file.mesh({{"POSITION", position}, {"NORMAL", normal}});
        file.append("nodes", {{"mesh", mesh}, {"scale", {scale, 1, 1}}});
        return error_of(file);
    };
    const std::vector<float> good{0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::vector<float> up{0, 0, 1, 0, 0, 1, 0, 0, 1};
    EXPECT_CONTAINS(with_vertices({0, 0, 0, 1, NOT_A_NUMBER, 0, 0, 1, 0}, up, 1),
                    "test.glb: node 0: mesh 'thing' primitive 0: the position of vertex 1 is not finite");
    EXPECT_CONTAINS(with_vertices({0, 0, 0, 1, 0, 0, 0, INFINITE, 0}, up, 1), "the position of vertex 2");
    EXPECT_CONTAINS(with_vertices({0, 0, 0, 3e38f, 0, 0, 0, 1, 0}, up, 10), "the position of vertex 1");
    EXPECT_CONTAINS(with_vertices(good, {0, 0, 1, 0, 0, NOT_A_NUMBER, 0, 0, 1}, 1), "the normal of vertex 1");
    EXPECT_CONTAINS(with_vertices(good, {0, 0, INFINITE, 0, 0, 1, 0, 0, 1}, 1), "the normal of vertex 0");
    EXPECT_CONTAINS(with_vertices(good, {0, 0, 1, 0, 0, 1}, 1), "NORMAL: it has 2 elements for 3 positions");
}

TEST(GltfErrors, LightsAndCamerasMustBeInReach) {
    const auto at = [](const json& transform) {
        GltfBuilder light = rich_file();
        light.json["nodes"][1].erase("camera");
        light.json["nodes"][1].update(transform);
        GltfBuilder camera = rich_file();
        camera.json["nodes"][1].erase("extensions");
        camera.json["nodes"][1].update(transform);
        return std::pair(error_of(light), error_of(camera));
    };
    const auto [light, camera] = at({{"translation", {0, 1e300, 0}}});
    EXPECT_CONTAINS(light, "node 1: its transform puts its light out of reach");
    EXPECT_CONTAINS(camera, "node 1: its transform leaves its camera no direction or position");
    const auto [huge_light, huge_camera] = at({{"scale", {1e300, 1e300, 1e300}}});
    EXPECT_CONTAINS(huge_light, "node 1: its transform leaves its light no direction");
    EXPECT_CONTAINS(huge_camera, "node 1: its transform leaves its camera no direction or position");
    GltfBuilder wide = rich_file();
    wide.json["cameras"][0] = {{"type", "orthographic"},
                               {"orthographic", {{"xmag", 1}, {"ymag", 1e300}, {"znear", 0}, {"zfar", 1}}}};
    EXPECT_CONTAINS(error_of(wide), "camera 0: ymag must be positive");
}

TEST(GltfErrors, IndicesMustBeInRangeAndWhole) {
    const auto with_indices = [](GltfBuilder& file, int indices) {
        const int positions = file.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
        file.append("nodes", {{"mesh", file.mesh({{"POSITION", positions}}, indices)}});
        return error_of(file);
    };
    GltfBuilder out_of_range, fraction, real, vectors;
    EXPECT_CONTAINS(with_indices(out_of_range, out_of_range.accessor<uint16_t>({0, 1, 3}, "SCALAR")),
                    "mesh 'thing' primitive 0: index 3 is outside its 3 positions");
    EXPECT_CONTAINS(with_indices(fraction, fraction.accessor<uint16_t>({0, 1, 2, 0}, "SCALAR")),
                    "its corner count 4 is no multiple of three");
    EXPECT_CONTAINS(with_indices(real, real.accessor<float>({0, 1, 2}, "SCALAR")),
                    "must be unsigned integers");
    EXPECT_CONTAINS(with_indices(vectors, vectors.accessor<uint16_t>({0, 1, 2, 0}, "VEC2")),
                    "must be unsigned integers");
    GltfBuilder file = triangle();
    file.json["meshes"][0]["primitives"][0]["indices"] = 9;
    EXPECT_CONTAINS(error_of(file), "out of bounds");
    file = triangle();
    file.json["meshes"][0]["primitives"][0]["mode"] = 9;
    EXPECT_CONTAINS(error_of(file), "its mode 9 is not one of glTF's");
}

TEST(GltfErrors, ReferencesMustExist) {
    const auto on_node = [](const char* key, const json& value) {
        GltfBuilder file = triangle();
        file.json["nodes"][0]["name"] = "seat";
        file.json["nodes"][0][key] = value;
        return error_of(file);
    };
    EXPECT_CONTAINS(on_node("mesh", 1), "node 'seat': mesh 1 does not exist; the file has 1");
    EXPECT_CONTAINS(on_node("camera", 0), "node 'seat': camera 0 does not exist; the file has 0");
    EXPECT_CONTAINS(on_node("children", {4}), "node 4 does not exist");
    EXPECT_CONTAINS(on_node("children", {-1}), "node -1 does not exist");
    EXPECT_CONTAINS(on_node("extensions", {{"KHR_lights_punctual", {{"light", 2}}}}),
                    "light 2 does not exist");
    EXPECT_CONTAINS(on_node("extensions", {{"KHR_lights_punctual", {{"light", "x"}}}}),
                    "light must be an index");
    GltfBuilder file = triangle();
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    EXPECT_CONTAINS(error_of(file), "material 0 does not exist");
    file = triangle();
    file.json["scene"] = 1;
    EXPECT_CONTAINS(error_of(file), "scene 1 does not exist");
}

TEST(GltfErrors, NodesMustFormATree) {
    GltfBuilder cycle = triangle();
    cycle.json["nodes"] = {{{"children", {1}}}, {{"children", {0}}, {"name", "loop"}}};
    cycle.json["scenes"] = {{{"nodes", {0}}}};
    EXPECT_CONTAINS(error_of(cycle), "node 0: it is its own ancestor");
    GltfBuilder self = triangle();
    self.json["nodes"][0]["children"] = {0};
    self.json["scenes"] = {{{"nodes", {0}}}};
    EXPECT_CONTAINS(error_of(self), "its own ancestor");
    GltfBuilder shared = triangle();
    shared.json["nodes"] = {{{"children", {2}}}, {{"children", {2}}}, {{"mesh", 0}}};
    EXPECT_CONTAINS(error_of(shared), "node 2: it is its own ancestor, or has two parents");
}

TEST(GltfErrors, LongChainOfNodesIsFine) {
    const TemporaryFolder folder;
    GltfBuilder file = triangle();
    for (int i = 1; i < 20000; ++i)
        file.json["nodes"].push_back({{"children", {i - 1}}});
    EXPECT_EQ(load_gltf(file.write_glb(folder.file("chain.glb"))).triangles.size(), 1u);
}

TEST(GltfErrors, TransformsMustBeWellFormed) {
    const auto on_node = [](const char* key, const json& value) {
        GltfBuilder file = triangle();
        file.json["nodes"][0][key] = value;
        return error_of(file);
    };
    EXPECT_CONTAINS(on_node("scale", {1, 1}), "node 0: scale must be a list of 3 numbers");
    EXPECT_CONTAINS(on_node("rotation", {0, 0, 0}), "rotation must be a list of 4 numbers");
    EXPECT_CONTAINS(on_node("rotation", {0, 0, 0, 0}), "not a quaternion of length 1");
    EXPECT_CONTAINS(on_node("matrix", {1, 2, 3}), "matrix must be a list of 16 numbers");
    EXPECT_CONTAINS(on_node("matrix", {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}), "not affine");
}

TEST(GltfErrors, RequiredExtensionsMustBeKnown) {
    GltfBuilder file = triangle();
    file.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    file.json["extensionsUsed"] = {"KHR_draco_mesh_compression"};
    EXPECT_CONTAINS(error_of(file),
                    "extensionsRequired: the file needs the extension KHR_draco_mesh_compression");
}

}  // namespace
}  // namespace obscura
