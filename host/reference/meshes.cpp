// SPDX-License-Identifier: Apache-2.0
#include "reference/meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <vector>

namespace obscura {

Scene icosphere(int levels, float radius, const V3f& center) {
    const double phi = 0.5 * (1 + std::sqrt(5.0));
    std::vector<V3d> points{{-1, phi, 0}, {1, phi, 0}, {-1, -phi, 0}, {1, -phi, 0},
                            {0, -1, phi}, {0, 1, phi}, {0, -1, -phi}, {0, 1, -phi},
                            {phi, 0, -1}, {phi, 0, 1}, {-phi, 0, -1}, {-phi, 0, 1}};
    for (V3d& point : points)
        point.normalize();
    std::vector<std::array<uint32_t, 3>> faces{{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                               {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                               {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                               {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
        const auto middle = [&](uint32_t a, uint32_t b) {
            const auto [entry, is_new] =
                middles.try_emplace(std::minmax(a, b), static_cast<uint32_t>(points.size()));
            if (is_new) points.push_back((points[a] + points[b]).normalized());
            return entry->second;
        };
        std::vector<std::array<uint32_t, 3>> finer;
        for (const auto& [a, b, c] : faces) {
            const uint32_t ab = middle(a, b);
            const uint32_t bc = middle(b, c);
            const uint32_t ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
        }
        faces = std::move(finer);
    }
    MeshBuilder mesh;
    for (const V3d& point : points)
        mesh.vertex(V3f(point * static_cast<double>(radius)) + center);
    for (const auto& [a, b, c] : faces)
        mesh.triangle(a, b, c);
    return mesh.finish();
}

Scene triangle_soup(uint32_t count, float longest, float thinness, uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    std::uniform_real_distribution<float> both(-1, 1);
    MeshBuilder mesh;
    for (uint32_t i = 0; i < count; ++i) {
        // One draw per statement and braces: the order in which arguments are evaluated is the compiler's.
        const V3f a{unit(random), unit(random), unit(random)};
        const float length = longest * unit(random);
        const V3f along = V3f{both(random), both(random), both(random)} * length;
        const V3f across = V3f{both(random), both(random), both(random)} * (longest * thinness);
        const float apex = unit(random);
        if (along.cross(across).length() == 0) continue;
        mesh.triangle(a, a + along, a + along * apex + across);
    }
    return mesh.finish();
}

Scene flat_grid(uint32_t side) {
    MeshBuilder mesh;
    for (uint32_t y = 0; y <= side; ++y)
        for (uint32_t x = 0; x <= side; ++x)
            mesh.vertex(V3f(static_cast<float>(x), static_cast<float>(y), 0) / static_cast<float>(side));
    for (uint32_t y = 0; y < side; ++y) {
        for (uint32_t x = 0; x < side; ++x) {
            const uint32_t corner = y * (side + 1) + x;
            mesh.triangle(corner, corner + 1, corner + side + 2);
            mesh.triangle(corner, corner + side + 2, corner + side + 1);
        }
    }
    return mesh.finish();
}

Scene identical_triangles(uint32_t count) {
    MeshBuilder mesh;
    mesh.vertex(V3f(0, 0, 0));
    mesh.vertex(V3f(1, 0, 0.25F));
    mesh.vertex(V3f(0, 1, 0.5F));
    for (uint32_t i = 0; i < count; ++i)
        mesh.triangle(0, 1, 2);
    return mesh.finish();
}

Scene nested_scales(uint32_t count, float ratio) {
    MeshBuilder mesh;
    float size = 1;
    for (uint32_t i = 0; i < count; ++i, size *= ratio)
        mesh.triangle(V3f(size, 0, 0), V3f(0, size, 0), V3f(0, 0, size));
    return mesh.finish();
}

Scene nested_clusters(uint32_t triangles_per_cluster) {
    MeshBuilder mesh;
    for (float distance = 1; distance > 1e-36F; distance *= 0.5F) {
        for (uint32_t i = 0; i < triangles_per_cluster; ++i) {
            const float part = static_cast<float>(i) / static_cast<float>(triangles_per_cluster);
            const float x = distance * (1 + 0.01F * part);
            const float size = distance * 0.001F;
            mesh.triangle(V3f(x, 0, 0), V3f(x + size, size, 0), V3f(x, size, size));
        }
    }
    return mesh.finish();
}

Scene moved(Scene scene, float offset) {
    scene.bounds = {};
    for (Vertex& vertex : scene.vertices)
        vertex.position += V3f(offset, -offset, offset);
    for (const Triangle& triangle : scene.triangles)
        for (const uint32_t corner : triangle.vertex)
            scene.bounds.extendBy(scene.vertices[corner].position);
    return scene;
}

}  // namespace obscura
