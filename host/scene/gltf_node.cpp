// SPDX-License-Identifier: Apache-2.0
// The node tree: transforms in double from the roots down, and what each node carries. Imath's row vectors
// and glTF's column-major column vectors have the same layout in memory, so matrices are copied as they are.
#include "scene/gltf_reader.h"
#include "scene/local_frame.h"

#include <Imath/ImathMatrixAlgo.h>
#include <Imath/ImathQuat.h>

#include <algorithm>
#include <cmath>

namespace obscura {

namespace {

struct PendingNode {
    int node;
    M44d parent_to_world;
};

// An optional member of the node: empty, or of the given size and finite.
void check_numbers(const GltfReader& reader, const std::string& place, const char* key,
                   const std::vector<double>& numbers, size_t size) {
    if (numbers.empty()) return;
    if (numbers.size() != size) reader.fail(place, "{} must be a list of {} numbers.", key, size);
    if (!std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); }))
        reader.fail(place, "{} must hold finite numbers.", key);
}

M44d rotation_matrix(const GltfReader& reader, const std::string& place, const std::vector<double>& q) {
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(length > 0)) reader.fail(place, "its rotation is not a quaternion of length 1.");
    return Imath::Quatd(q[3] / length, V3d(q[0], q[1], q[2]) / length).toMatrix44();
}

M44d local_matrix(const GltfReader& reader, const std::string& place, const tinygltf::Node& node) {
    check_numbers(reader, place, "matrix", node.matrix, 16);
    check_numbers(reader, place, "translation", node.translation, 3);
    check_numbers(reader, place, "rotation", node.rotation, 4);
    check_numbers(reader, place, "scale", node.scale, 3);
    M44d local;
    if (!node.matrix.empty()) {
        for (int i = 0; i < 4; ++i) {
            for (int j = 0; j < 4; ++j)
                local[i][j] = node.matrix[4 * static_cast<size_t>(i) + static_cast<size_t>(j)];
        }
        if (local[0][3] != 0 || local[1][3] != 0 || local[2][3] != 0 || local[3][3] != 1)
            reader.fail(place, "its matrix is not affine; the last row must be 0 0 0 1.");
        return local;
    }
    if (!node.scale.empty()) local.setScale(V3d(node.scale[0], node.scale[1], node.scale[2]));
    if (!node.rotation.empty()) local = local * rotation_matrix(reader, place, node.rotation);
    if (!node.translation.empty())
        local =
            local * M44d().setTranslation(V3d(node.translation[0], node.translation[1], node.translation[2]));
    return local;
}

bool is_finite(const M44d& matrix) {
    const double* const first = matrix.getValue();
    return std::all_of(first, first + 16, [](double x) { return std::isfinite(x); });
}

// The roots of the scene to render: the default one, else the first, else every node without a parent.
std::vector<int> root_nodes(const GltfReader& reader) {
    const tinygltf::Model& model = reader.model;
    if (model.defaultScene >= 0 && static_cast<size_t>(model.defaultScene) >= model.scenes.size())
        reader.fail("scene", "scene {} does not exist; the file has {}.", model.defaultScene,
                    model.scenes.size());
    if (!model.scenes.empty())
        return model.scenes[static_cast<size_t>(std::max(model.defaultScene, 0))].nodes;
    std::vector<bool> is_child(model.nodes.size(), false);
    for (const tinygltf::Node& node : model.nodes) {
        for (const int child : node.children)
            if (child >= 0 && static_cast<size_t>(child) < is_child.size())
                is_child[static_cast<size_t>(child)] = true;
    }
    std::vector<int> roots;
    for (size_t i = 0; i < is_child.size(); ++i)
        if (!is_child[i]) roots.push_back(static_cast<int>(i));
    return roots;
}

void append_object(GltfReader& reader, size_t index, const std::string& place, const M44d& to_world) {
    const tinygltf::Node& node = reader.model.nodes[index];
    if (node.mesh >= 0) {
        if (static_cast<size_t>(node.mesh) >= reader.model.meshes.size())
            reader.fail(place, "mesh {} does not exist; the file has {}.", node.mesh,
                        reader.model.meshes.size());
        const std::string& mesh_name = reader.model.meshes[static_cast<size_t>(node.mesh)].name;
        const std::string name = !node.name.empty()   ? node.name
                                 : !mesh_name.empty() ? mesh_name
                                                      : fmt::format("node {}", index);
        append_mesh(reader, node.mesh, place, to_world, name);
    }
    if (node.skin >= 0)
        reader.notices.add("skins are not supported; the meshes keep the pose in the file", "node");
}

// Calls visit(index, place, to_world) for each node of the scene to render, parents before children.
template <typename Visitor>
void visit_nodes(const GltfReader& reader, const M44d& root_to_world, const Visitor& visit) {
    const auto& nodes = reader.model.nodes;
    std::vector<bool> seen(nodes.size(), false);
    std::vector<PendingNode> stack;
    const auto push_reversed = [&](const std::vector<int>& children, const M44d& to_world) {
        for (auto child = children.rbegin(); child != children.rend(); ++child)
            stack.push_back({*child, to_world});
    };
    push_reversed(root_nodes(reader), root_to_world);
    while (!stack.empty()) {
        const PendingNode pending = stack.back();
        stack.pop_back();
        if (pending.node < 0 || static_cast<size_t>(pending.node) >= nodes.size())
            reader.fail("nodes", "node {} does not exist; the file has {}.", pending.node, nodes.size());
        const auto index = static_cast<size_t>(pending.node);
        const std::string place = gltf_place("node", nodes[index].name, index);
        if (seen[index])
            reader.fail(place, "it is its own ancestor, or has two parents; nodes must form a tree.");
        seen[index] = true;
        const M44d to_world = local_matrix(reader, place, nodes[index]) * pending.parent_to_world;
        if (!is_finite(to_world)) reader.fail(place, "its transform overflows, with those above it.");
        visit(index, place, to_world);
        push_reversed(nodes[index].children, to_world);
    }
}

}  // namespace

void append_nodes(GltfReader& reader) {
    for (size_t i = 1; i < reader.model.scenes.size(); ++i)
        reader.notices.add("only the default scene is rendered; others are ignored", "other scene");
    for (size_t i = 0; i < reader.model.animations.size(); ++i)
        reader.notices.add("animations are not played; nodes keep their place in the file", "animation");
    const auto append_meshes = [&] {
        visit_nodes(reader, M44d().setScale(1 / reader.scene.unit),
                    [&](size_t index, const std::string& place, const M44d& to_world) {
                        append_object(reader, index, place, to_world);
                    });
    };
    const Notices before = reader.notices;
    append_meshes();
    reader.scene.unit = scene_unit(reader.lengths);
    if (reader.scene.unit != 1) {  // once more, from the file's numbers
        reader.notices = before;
        reader.scene.vertices.clear();
        reader.scene.triangles.clear();
        reader.scene.objects.clear();
        reader.scene.dropped_triangles = 0;
        append_meshes();
    }
    visit_nodes(reader, M44d().setScale(1 / reader.scene.unit),
                [&](size_t index, const std::string& place, const M44d& to_world) {
                    append_camera(reader, reader.model.nodes[index], place, to_world);
                    append_light(reader, reader.model.nodes[index], place, to_world);
                });
}

}  // namespace obscura
