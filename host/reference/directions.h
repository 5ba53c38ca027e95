// SPDX-License-Identifier: Apache-2.0
// Small mathematics of the reference renderer, in double.
#pragma once

#include "base/math.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace obscura::reference {

using Imath::V2d;

// Cosines to a shading normal are kept above this, which is part of the model (kernels/lib/math.clh).
inline constexpr double GRAZING_COSINE = 1e-4;

inline double max_component(const RgbD& v) {
    return std::max(v.x, std::max(v.y, v.z));
}

inline double mean_component(const RgbD& v) {
    return (v.x + v.y + v.z) / 3;
}

// z is the normal. The two tangents are those of Duff et al. 2017, so that a sample means the same direction here as
// on the device.
struct Basis {
    V3d tangent, bitangent, normal;

    explicit Basis(const V3d& n) : normal(n) {
        const double sign = std::copysign(1.0, n.z);
        const double a = -1 / (sign + n.z);
        const double b = n.x * n.y * a;
        tangent = V3d(1 + sign * n.x * n.x * a, sign * b, -sign * n.x);
        bitangent = V3d(b, sign + n.y * n.y * a, -n.y);
    }
    V3d to_world(const V3d& v) const { return v.x * tangent + v.y * bitangent + v.z * normal; }
    V3d to_local(const V3d& v) const { return {v.dot(tangent), v.dot(bitangent), v.dot(normal)}; }
};

// The unit square onto the unit disc, keeping areas and strata (Shirley, Chiu 1997).
inline V2d concentric_disc(const V2d& u) {
    const double a = 2 * u.x - 1;
    const double b = 2 * u.y - 1;
    if (a == 0 && b == 0) return {0, 0};
    if (std::abs(a) > std::abs(b)) {
        const double angle = std::numbers::pi / 4 * (b / a);
        return {a * std::cos(angle), a * std::sin(angle)};
    }
    const double angle = std::numbers::pi / 4 * (a / b);
    return {b * std::sin(angle), b * std::cos(angle)};
}

// A direction about +z with density cos(theta) / pi (Malley's method).
inline V3d cosine_hemisphere(const V2d& u) {
    const V2d disc = concentric_disc(u);
    return {disc.x, disc.y, std::sqrt(std::max(0.0, 1 - disc.length2()))};
}

// Directions below the geometric surface are reflected about its plane.
inline V3d reflect_above(const V3d& direction, const V3d& n_geo) {
    const double height = direction.dot(n_geo);
    return height < 0 ? direction - 2 * height * n_geo : direction;
}

}  // namespace obscura::reference
