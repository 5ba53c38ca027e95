// SPDX-License-Identifier: Apache-2.0
// Procedural meshes that are hard to trace: closed, random, thin, huge, tiny and degenerate ones. Everything is a pure
// function of its arguments.
#pragma once

#include "scene/scene.h"

#include <cstdint>
#include <utility>

namespace obscura {

class MeshBuilder {
  public:
    uint32_t vertex(const V3f& position) {
        scene_.vertices.push_back({position, V3f(0, 0, 0), Imath::V2f(0, 0)});
        return static_cast<uint32_t>(scene_.vertices.size()) - 1;
    }

    void triangle(uint32_t a, uint32_t b, uint32_t c) {
        scene_.triangles.push_back({{a, b, c}, 0, 0});
        for (const uint32_t corner : {a, b, c})
            scene_.bounds.extendBy(scene_.vertices[corner].position);
    }

    void triangle(const V3f& a, const V3f& b, const V3f& c) {
        const uint32_t first = vertex(a);
        vertex(b);
        vertex(c);
        triangle(first, first + 1, first + 2);
    }

    Scene finish() {
        scene_.name = "test";
        scene_.materials.resize(1);
        scene_.objects = {{"mesh", 0, static_cast<uint32_t>(scene_.triangles.size())}};
        return std::move(scene_);
    }

  private:
    Scene scene_;
};

// A closed sphere of 20 * 4^levels triangles, seen from outside counter-clockwise.
Scene icosphere(int levels, float radius = 1, const V3f& center = V3f(0, 0, 0));

// Random triangles in the unit cube. longest: edge length of the longest triangles; thinness: 1 = equilateral
// in the mean, 1e-6 = slivers.
Scene triangle_soup(uint32_t count, float longest, float thinness, uint32_t seed);

// A plane of 2 * side^2 triangles in z = 0, from 0 to 1; many boxes are flat and many centroids equal.
Scene flat_grid(uint32_t side);

// The same triangle again and again.
Scene identical_triangles(uint32_t count);

// Triangles with one common corner, each ratio times the size of the one before; the smallest stay above the
// denormal floats. A binary tree by surface area peels them off one by one.
Scene nested_scales(uint32_t count, float ratio = 0.5F);

// Clusters of small triangles on a line, each half as far from the origin as the one before, down to 1e-36: a
// builder that halves space has to go deeper than any stack.
Scene nested_clusters(uint32_t triangles_per_cluster);

// The scene far from the world's origin, by so many metres along each axis (down along y), where floats are coarse.
Scene moved(Scene scene, float offset);

}  // namespace obscura
