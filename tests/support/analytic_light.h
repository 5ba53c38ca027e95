// SPDX-License-Identifier: Apache-2.0
// Direct light with known values: form factors of rectangles, and the reflection of a rectangle in a GGX surface by
// quadrature in double. The receiver lies at the origin, its normal is +y.
#pragma once

#include <cmath>
#include <numbers>

#include "base/math.h"
#include "scene/material.h"

namespace obscura::test {

// Share of the cosine-weighted hemisphere that a parallel rectangle covers, one corner right above the receiver: sides
// a and b at height h (Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", B-3).
inline double parallel_corner_factor(double a, double b, double h) {
    const double x = a / h, y = b / h;
    const double rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
    return (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry)) / (2 * std::numbers::pi);
}

// The same for a rectangle that stands on the receiver's plane at distance c, its foot's middle nearest: width 2 w,
// height h (B-4, twice).
inline double standing_factor(double w, double h, double c) {
    const double x = w / c, y = h / c;
    const double root = std::sqrt(1 + y * y);
    return (std::atan(x) - std::atan(x / root) / root) / std::numbers::pi;
}

// GGX with height-correlated Smith masking and Schlick's Fresnel: the model of scene/material.h.
struct GgxLobe {
    double alpha, f0, f90;

    double lambda(const V3d& w) const {
        const double tan2 = (w.x * w.x + w.z * w.z) / (w.y * w.y);
        return 0.5 * (std::sqrt(1 + alpha * alpha * tan2) - 1);
    }

    double brdf(const V3d& wo, const V3d& wi) const {
        const V3d m = (wo + wi).normalized();
        const double s = m.x * m.x + m.z * m.z + alpha * alpha * m.y * m.y;
        const double density = alpha * alpha / (std::numbers::pi * s * s);
        const double fresnel = f0 + (f90 - f0) * std::pow(1 - wo.dot(m), 5);
        return fresnel * density / ((1 + lambda(wo) + lambda(wi)) * 4 * wo.y * wi.y);
    }
};

// Radiance to wo under a rectangle of unit radiance that emits downwards: corner, edges u along x and v along z.
inline double reflected_rectangle(const GgxLobe& lobe, const V3d& wo, const V3d& corner, double u, double v) {
    constexpr int STEPS = 1500;
    double sum = 0;
    for (int i = 0; i < STEPS; ++i) {
        for (int j = 0; j < STEPS; ++j) {
            const V3d point = corner + V3d(u * (i + 0.5) / STEPS, 0, v * (j + 0.5) / STEPS);
            const double distance2 = point.length2();
            const V3d wi = point / std::sqrt(distance2);
            sum += lobe.brdf(wo, wi) * wi.y * wi.y / distance2;
        }
    }
    return sum * u * v / STEPS / STEPS;
}

// The same through a white pane above the receiver, parallel to it. brdf: of the direction to the rectangle.
template <typename Brdf>
double rectangle_behind_pane(const Brdf& brdf, const V3d& corner, double u, double v) {
    constexpr int STEPS = 500;
    double sum = 0;
    for (int i = 0; i < STEPS; ++i) {
        for (int j = 0; j < STEPS; ++j) {
            const V3d point = corner + V3d(u * (i + 0.5) / STEPS, 0, v * (j + 0.5) / STEPS);
            const V3d wi = point.normalized();
            sum += brdf(wi) * (1 - pane_reflectance(wi.y)) * wi.y * wi.y / point.length2();
        }
    }
    return sum * u * v / STEPS / STEPS;
}

}  // namespace obscura::test
