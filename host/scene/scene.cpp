// SPDX-License-Identifier: Apache-2.0
// Geometry of single triangles, and the decoding of colours. Corners are stored as float; differences of
// floats are exact in double for all but extreme exponents, so areas and normals here are as good as the
// stored geometry.
#include "scene/scene.h"

#include <algorithm>
#include <cmath>

namespace obscura {

namespace {

constexpr double SMOOTH_TOLERANCE = 1e-3;

V3d edge_cross(const Scene& scene, uint32_t triangle) {
    const V3d a(scene.corner(triangle, 0).position);
    const V3d b(scene.corner(triangle, 1).position);
    const V3d c(scene.corner(triangle, 2).position);
    return (b - a).cross(c - a);
}

std::array<double, 256> make_srgb_table() {
    std::array<double, 256> table{};
    for (size_t code = 0; code < table.size(); ++code) {
        const double encoded = static_cast<double>(code) / 255;
        table[code] = encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
    }
    return table;
}

}  // namespace

V3d geometric_normal(const Scene& scene, uint32_t triangle) {
    return edge_cross(scene, triangle).normalized() + V3d(0);  // -0 + 0 is 0
}

double triangle_area(const Scene& scene, uint32_t triangle) {
    return 0.5 * edge_cross(scene, triangle).length();
}

double longest_edge(const Scene& scene, uint32_t triangle) {
    const V3d a(scene.corner(triangle, 0).position);
    const V3d b(scene.corner(triangle, 1).position);
    const V3d c(scene.corner(triangle, 2).position);
    return std::sqrt(std::max({(b - a).length2(), (c - b).length2(), (a - c).length2()}));
}

double diagonal(const Scene& scene) {
    const Box3f& bounds = scene.bounds;
    return bounds.isEmpty() ? 0 : scene.unit * (V3d(bounds.max) - V3d(bounds.min)).length();
}

float edge_product(const V3f& a, const V3f& b, const V3f& c) {
    const V3f e1 = b - a;
    const V3f e2 = c - a;
    float largest = 0;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        const int k = (i + 2) % 3;
        const float kj = e1[k] * e2[j];
        largest = std::max(largest, std::abs(std::fma(e1[j], e2[k], -kj) + std::fma(-e1[k], e2[j], kj)));
    }
    return largest;
}

bool is_smooth(const Scene& scene, uint32_t triangle) {
    const V3d n_geo = geometric_normal(scene, triangle);
    bool differs = false;
    for (int i = 0; i < 3; ++i) {
        const V3d normal(scene.corner(triangle, i).normal);
        if (normal == V3d(0, 0, 0)) return false;
        if ((normal - n_geo).length() > SMOOTH_TOLERANCE) differs = true;
    }
    return differs;
}

double srgb_to_linear(uint8_t code) {
    static const std::array<double, 256> table = make_srgb_table();
    return table[code];
}

}  // namespace obscura
