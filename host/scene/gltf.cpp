// SPDX-License-Identifier: Apache-2.0
// Entry points of the glTF reader; the work is in gltf_*.cpp.
#include "scene/gltf.h"

#include "base/log.h"
#include "base/units.h"
#include "scene/gltf_reader.h"
#include "scene/local_frame.h"

#include <algorithm>
#include <set>

namespace obscura {

namespace {

// Extensions that the file says it uses, and those that it uses without saying so.
std::set<std::string> used_extensions(const tinygltf::Model& model) {
    std::set<std::string> names(model.extensionsUsed.begin(), model.extensionsUsed.end());
    const auto add = [&](const auto& owner) {
        for (const auto& [name, value] : owner.extensions)
            names.insert(name);
    };
    const auto add_all = [&](const auto& owners) { std::for_each(owners.begin(), owners.end(), add); };
    add(model);
    add_all(model.scenes);
    add_all(model.nodes);
    add_all(model.materials);
    add_all(model.textures);
    for (const tinygltf::Mesh& mesh : model.meshes) {
        add(mesh);
        add_all(mesh.primitives);
    }
    return names;
}

void check_extensions(GltfReader& reader) {
    const tinygltf::Model& model = reader.model;
    for (const std::string& name : model.extensionsRequired) {
        if (!is_supported_extension(name))
            reader.fail("extensionsRequired", "the file needs the extension {}, which is not supported.",
                        name);
    }
    for (const std::string& name : used_extensions(model)) {
        if (!is_supported_extension(name))
            log_warning("{}: the extension {} is not supported yet and is ignored.", reader.file, name);
    }
}

Box3f used_bounds(const Scene& scene) {
    Box3f bounds;
    for (const Triangle& triangle : scene.triangles) {
        for (const uint32_t vertex : triangle.vertex)
            bounds.extendBy(scene.vertices[vertex].position);
    }
    return bounds;
}

}  // namespace

std::filesystem::path find_scene_file(const std::filesystem::path& path) {
    std::error_code ignored;
    if (!std::filesystem::is_directory(path, ignored)) {
        if (std::filesystem::exists(path, ignored)) return path;
        throw InputError("{}: there is no such scene file or folder.", path.string());
    }
    // "scenes/kitchen/" and "." have no last name of their own.
    const std::filesystem::path folder = std::filesystem::canonical(path);
    for (const char* extension : {".glb", ".gltf"}) {
        std::filesystem::path file = path / folder.filename();
        file += extension;
        if (std::filesystem::is_regular_file(file, ignored)) return file;
    }
    throw InputError("{}: this folder holds no scene of its own name ({}.glb or {}.gltf).", path.string(),
                     folder.filename().string(), folder.filename().string());
}

Scene load_gltf(const std::filesystem::path& file) {
    GltfReader reader;
    reader.file = file.string();
    reader.model = read_gltf_model(file);
    reader.scene.name = file.filename().string();
    check_extensions(reader);
    append_nodes(reader);
    reader.notices.print(reader.file);

    Scene& scene = reader.scene;
    scene.bounds = used_bounds(scene);
    if (scene.dropped_triangles > 0)
        log_warning("{}: {} without area dropped, beginning with {}.", reader.file,
                    counted(scene.dropped_triangles, "triangle"), reader.first_dropped);
    if (scene.triangles.empty()) log_warning("{}: the scene holds no triangles.", reader.file);
    if (scene.cameras.empty()) {
        scene.cameras.push_back(default_camera(scene.bounds));
        log_info("{}: the scene has no camera; one was placed to show all of it.", reader.file);
    }
    move_near_origin(scene);
    return std::move(scene);
}

}  // namespace obscura
