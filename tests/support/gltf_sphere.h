// SPDX-License-Identifier: Apache-2.0
// A glTF file with a sphere below a chain of nodes, to be squeezed by their transforms.
#pragma once

#include "reference/meshes.h"
#include "support/gltf_builder.h"

#include <vector>

namespace obscura::test {

constexpr int SPHERE_LEVELS = 2;
constexpr uint32_t SPHERE_TRIANGLES = 20 * 16;

// Radius 1, about the origin, with the normals of a true sphere. chain: members of the nodes above it, the root first;
// the last one carries the mesh.
inline GltfBuilder sphere_below(const std::vector<nlohmann::json>& chain) {
    const Scene sphere = icosphere(SPHERE_LEVELS);
    std::vector<float> positions;
    std::vector<uint32_t> indices;
    for (const Vertex& vertex : sphere.vertices)
        positions.insert(positions.end(), {vertex.position.x, vertex.position.y, vertex.position.z});
    for (const Triangle& triangle : sphere.triangles)
        indices.insert(indices.end(), triangle.vertex.begin(), triangle.vertex.end());
    GltfBuilder file;
    const int position = file.accessor(positions, "VEC3");
    const int mesh =
        file.mesh({{"POSITION", position}, {"NORMAL", position}}, file.accessor(indices, "SCALAR"));
    for (size_t i = 0; i < chain.size(); ++i) {
        nlohmann::json node = chain[i];
        if (i + 1 < chain.size())
            node["children"] = {i + 1};
        else
            node["mesh"] = mesh;
        file.append("nodes", node);
    }
    return file;
}

}  // namespace obscura::test
