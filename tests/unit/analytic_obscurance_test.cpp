// SPDX-License-Identifier: Apache-2.0
// The closed forms that the image tests trust, against independent quadrature in double.
#include "support/analytic_obscurance.h"

#include <gtest/gtest.h>

namespace obscura::test {
namespace {

// W = 2 int_0^1 c rho(d(c)) dc for geometry that depends on the cosine c alone.
template <typename Distance>
double quadrature(const Falloff& falloff, const Distance& distance) {
    constexpr int STEPS = 2000000;
    double sum = 0;
    for (int i = 0; i < STEPS; ++i) {
        const double c = (i + 0.5) / STEPS;
        const double d = distance(c);
        sum += 2 * c * (d < 1 ? falloff_value(falloff, d) : 1.0);
    }
    return sum / STEPS;
}

TEST(AnalyticObscurance, PlaneEqualsQuadrature) {
    for (const Falloff& falloff : ALL_FALLOFFS) {
        for (const double eta : {0.1, 0.25, 0.5, 1.5}) {
            EXPECT_NEAR(plane_obscurance(falloff, eta),
                        quadrature(falloff, [&](double c) { return eta / c; }), 2e-6)
                << falloff_text(falloff) << " " << eta;
        }
    }
}

TEST(AnalyticObscurance, SphereEqualsQuadrature) {
    for (const Falloff& falloff : ALL_FALLOFFS) {
        for (const double sigma : {0.5, 1.0, 2.0}) {
            EXPECT_NEAR(sphere_obscurance(falloff, sigma),
                        quadrature(falloff, [&](double c) { return sigma * c; }), 2e-6)
                << falloff_text(falloff) << " " << sigma;
        }
    }
}

TEST(AnalyticObscurance, WallsEqualPublishedValues) {
    // One wall at 0.25: 1 - B for the step, B = (acos xi - xi s) / pi.
    const double xi = 0.25;
    const double b = (std::acos(xi) - xi * std::sqrt(1 - xi * xi)) / std::numbers::pi;
    EXPECT_NEAR(wall_obscurance({FalloffKind::step, 1}, {{0, xi}}), 1 - b, 1e-6);
    EXPECT_NEAR(wall_obscurance({FalloffKind::sqrt, 1}, {{0, xi}}), 0.897596278, 1e-6);
    EXPECT_NEAR(wall_obscurance({FalloffKind::exp, 1}, {{0, xi}}), 0.867686024, 1e-6);
    // Walls on three sides at 0.25.
    const double half_pi = std::numbers::pi / 2;
    const std::vector<Wall> three{{0, xi}, {half_pi, xi}, {2 * half_pi, xi}};
    EXPECT_NEAR(wall_obscurance({FalloffKind::step, 1}, three), 0.197269915, 1e-6);
    EXPECT_NEAR(wall_obscurance({FalloffKind::linear, 1}, three), 0.572547467, 1e-6);
}

}  // namespace
}  // namespace obscura::test
