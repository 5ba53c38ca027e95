// SPDX-License-Identifier: Apache-2.0
// What the parts of the glTF reader share; private to host/scene/gltf*.cpp. tinygltf parses the JSON and
// splits the container; everything that it leaves unchecked is checked here before it is used.
#pragma once

#include "base/error.h"
#include "scene/local_frame.h"
#include "scene/scene.h"

#include <tiny_gltf.h>

#include <filesystem>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace obscura {

// What the file holds and obscura does not render: one warning per kind, with a count.
class Notices {
  public:
    // what: a clause without its full stop; unit: the thing counted, in the singular.
    void add(const std::string& what, const std::string& unit);
    void print(const std::string& file) const;

  private:
    struct Notice {
        std::string what, unit;
        uint32_t count = 0;
    };
    std::vector<Notice> notices_;  // in order of first appearance
};

// The state of one load.
struct GltfReader {
    std::string file;  // as the user wrote it, for messages
    tinygltf::Model model;
    Notices notices;
    Scene scene;
    LengthRange lengths;                          // of the triangles read so far
    std::string first_dropped;                    // the place of the first triangle without area
    std::unordered_map<int, uint32_t> materials;  // glTF index (-1: the default) -> Scene::materials
    std::unordered_map<int, int32_t> textures;    // glTF index -> Scene::textures

    template <typename... Args>
    [[noreturn]] void fail(const std::string& place, fmt::format_string<Args...> format,
                           Args&&... args) const {
        throw InputError("{}: {}: {}", file, place, fmt::format(format, std::forward<Args>(args)...));
    }
};

// Extensions that the reader understands; others in extensionsRequired are an error.
bool is_supported_extension(const std::string& name);

// "mesh 'table'", or "mesh 3" when it has no name.
std::string gltf_place(const char* kind, const std::string& name, size_t index);

// gltf_file.cpp: the bytes of a .gltf or .glb file, and of the files it names, as tinygltf's model.
tinygltf::Model read_gltf_model(const std::filesystem::path& file);

// gltf_value.cpp: members of extension objects, which tinygltf leaves as JSON. Throw InputError on wrong
// types and non-finite numbers; place names the owner.
const tinygltf::Value* find_extension(const tinygltf::ExtensionMap& extensions, const char* name);
double number_member(const GltfReader& reader, const std::string& place, const tinygltf::Value& object,
                     const char* key, double fallback);
std::vector<double> vector_member(const GltfReader& reader, const std::string& place,
                                  const tinygltf::Value& object, const char* key,
                                  std::vector<double> fallback);
int index_member(const GltfReader& reader, const std::string& place, const tinygltf::Value& object,
                 const char* key, int fallback);

// gltf_material.cpp: the scene's index of a glTF material (-1: glTF's default material), converted at its
// first use.
uint32_t use_material(GltfReader& reader, int material);

// How a material's base colour texture reads texture coordinates: uv' = (u, v, 1) * matrix.
struct UvMapping {
    bool textured = false;
    int set = 0;                    // TEXCOORD_<set>
    double uu = 1, vu = 0, u0 = 0;  // u' = uu u + vu v + u0
    double uv = 0, vv = 1, v0 = 0;  // v' = uv u + vv v + v0
};
UvMapping base_color_mapping(const GltfReader& reader, int material);

// gltf_texture.cpp: decodes a glTF texture at its first use.
int32_t use_texture(GltfReader& reader, int texture, const std::string& place);
// Mean over all texels, each channel in [0, 1]: stands in for textures that are not supported yet.
V3d mean_texel(GltfReader& reader, int texture, const std::string& place, bool srgb);

// to_world, here and below: from the node's space to the scene's, which counts in Scene::unit.
// gltf_mesh.cpp: adds a mesh as one object, its vertices transformed to world space. node_place: the node's, which messages name too:
// its transform may be what is wrong.
void append_mesh(GltfReader& reader, int mesh, const std::string& node_place, const M44d& to_world,
                 const std::string& object_name);

// gltf_light.cpp, gltf_camera.cpp: the light or camera that a node carries, if any; place: the node's.
void append_light(GltfReader& reader, const tinygltf::Node& node, const std::string& place,
                  const M44d& to_world);
void append_camera(GltfReader& reader, const tinygltf::Node& node, const std::string& place,
                   const M44d& to_world);
Camera default_camera(const Box3f& bounds);

// gltf_node.cpp: walks the node tree of the file's scene and appends what its nodes carry.
void append_nodes(GltfReader& reader);

}  // namespace obscura
