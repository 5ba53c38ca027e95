// SPDX-License-Identifier: Apache-2.0
// The closed forms of W that the image tests trust: against their published values, and against quadrature of the
// definition W = 1 / pi int rho(d(omega)) cos(theta) d omega, which knows no more of the geometry than its planes.
#include "reference/oracles.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "support/falloffs.h"

namespace obscura::test {
namespace {

constexpr double PI = std::numbers::pi;
const std::vector<Wall> WALL{{0, 0.25}};
const std::vector<Wall> THREE_WALLS{{0, 0.25}, {PI / 2, 0.25}, {PI, 0.25}};

std::vector<Wall> corner(double alpha, double beta) {
    return {{0, alpha}, {PI / 2, beta}};
}

// Adaptive Simpson rule (Lyness 1969). What lies between its first points can escape it: a step that is open for less than
// 1 / (4 PARTS) of the interval.
template <typename Function>
double refine(const Function& f, double a, double fa, double b, double fb, double fm, double tolerance,
              int depth) {
    const double m = 0.5 * (a + b);
    const double left = f(0.5 * (a + m)), right = f(0.5 * (m + b));
    const double coarse = (b - a) / 6 * (fa + 4 * fm + fb);
    const double fine = (b - a) / 12 * (fa + 4 * left + 2 * fm + 4 * right + fb);
    if (depth == 0 || std::abs(fine - coarse) < 15 * tolerance) return fine + (fine - coarse) / 15;
    return refine(f, a, fa, m, fm, left, tolerance / 2, depth - 1) +
           refine(f, m, fm, b, fb, right, tolerance / 2, depth - 1);
}

template <typename Function>
double adaptive_simpson(const Function& f, double from, double to, double tolerance) {
    constexpr int PARTS = 96;
    const double width = (to - from) / PARTS;
    double sum = 0;
    for (int i = 0; i < PARTS; ++i) {
        const double a = from + i * width, b = a + width;
        sum += refine(f, a, f(a), b, f(b), f(0.5 * (a + b)), tolerance / PARTS, 30);
    }
    return sum;
}

// The plane at a distance in the direction of its unit normal.
struct Plane {
    V3d normal;
    double distance;
};

double quadrature(const Falloff& falloff, const std::vector<Plane>& planes) {
    const auto rho = [&](const V3d& direction) {
        double nearest = 1;  // d_max
        for (const Plane& plane : planes) {
            const double cosine = direction.dot(plane.normal);
            if (cosine > 0) nearest = std::min(nearest, plane.distance / cosine);
        }
        return falloff_value(falloff, nearest);
    };
    // The direction's projection is uniform on the unit disc, so the square of its radius is on [0, 1].
    const auto at_azimuth = [&](double phi) {
        const auto at_square = [&](double s2) {
            const double s = std::sqrt(s2);
            return rho({s * std::cos(phi), s * std::sin(phi), std::sqrt(1 - s2)});
        };
        return adaptive_simpson(at_square, 0, 1, 1e-8);
    };
    return adaptive_simpson(at_azimuth, 0, 2 * PI, 1e-7) / (2 * PI);
}

std::vector<Plane> planes_of(const std::vector<Wall>& walls, double ceiling) {
    std::vector<Plane> planes;
    for (const Wall& wall : walls)
        planes.push_back({{std::cos(wall.azimuth), std::sin(wall.azimuth), 0}, wall.distance});
    if (std::isfinite(ceiling)) planes.push_back({{0, 0, 1}, ceiling});
    return planes;
}

TEST(Oracles, PlanesAndWallsEqualQuadrature) {
    struct Case {
        std::vector<Wall> walls;
        double ceiling;
    };
    const double open = std::numeric_limits<double>::infinity();
    const std::vector<Case> cases{{{}, 0.1},
                                  {{}, 0.5},
                                  {{}, 1.5},
                                  {WALL, open},
                                  {{{1, 0.01}}, open},
                                  {corner(0.1, 0.5), open},
                                  {corner(0.6, 0.9), open},
                                  {THREE_WALLS, open},
                                  {square_well(0.25), open},
                                  {square_well(0.9), 0.3},
                                  {square_well(0.25), 0.5},
                                  {square_well(0.5), 1},
                                  {{{0, 0.3}, {2, 0.4}, {4.5, 0.2}}, 0.6}};
    for (const auto& [walls, ceiling] : cases) {
        for (const Falloff& falloff : ALL_FALLOFFS) {
            EXPECT_NEAR(floor_obscurance(falloff, walls, ceiling),
                        quadrature(falloff, planes_of(walls, ceiling)), 3e-6)
                << falloff_text(falloff) << ", " << walls.size() << " walls, ceiling " << ceiling;
        }
    }
}

TEST(Oracles, SpheresEqualQuadrature) {
    for (const Falloff& falloff : ALL_FALLOFFS) {
        for (const double diameter : {0.01, 0.5, 1.0, 1.1, 2.0}) {
            const auto at_square = [&](double c2) {
                return falloff_value(falloff, std::min(1.0, diameter * std::sqrt(c2)));
            };
            EXPECT_NEAR(sphere_obscurance(falloff, diameter), adaptive_simpson(at_square, 0, 1, 1e-9), 1e-8)
                << falloff_text(falloff) << " " << diameter;
        }
    }
}

TEST(Oracles, EqualPublishedValues) {
    struct Row {
        const char* name;
        double (*w)(const Falloff&);
        std::array<double, 4> published;  // step, linear, sqrt, exp with lambda = 1
    };
    const std::vector<Row> rows{
        {"plane .1",
         [](const Falloff& f) { return plane_obscurance(f, 0.1); },
         {0.01, 0.19, 0.418303688, 0.262500763}},
        {"plane .25",
         [](const Falloff& f) { return plane_obscurance(f, 0.25); },
         {0.0625, 0.4375, 0.645833333, 0.540008981}},
        {"plane .5",
         [](const Falloff& f) { return plane_obscurance(f, 0.5); },
         {0.25, 0.75, 0.859475708, 0.822101714}},
        {"sphere .5",
         [](const Falloff& f) { return sphere_obscurance(f, 0.5); },
         {0, 0.333333333, 0.565685425, 0.440371560}},
        {"sphere 1",
         [](const Falloff& f) { return sphere_obscurance(f, 1); },
         {0, 0.666666667, 0.8, 0.745930121}},
        {"sphere 2",
         [](const Falloff& f) { return sphere_obscurance(f, 2); },
         {0.75, 0.916666667, 0.95, 0.936482530}},
        {"wall .1",
         [](const Falloff& f) {
             return floor_obscurance(f, {{0, 0.1}});
         },
         {0.563555714, 0.690767331, 0.788268837, 0.729007994}},
        {"wall .25",
         [](const Falloff& f) { return floor_obscurance(f, WALL); },
         {0.657481179, 0.831786277, 0.897596278, 0.867686024}},
        {"wall .5",
         [](const Falloff& f) {
             return floor_obscurance(f, {{0, 0.5}});
         },
         {0.804498891, 0.948035161, 0.971295467, 0.963994120}},
        {"2 walls .1, .1",
         [](const Falloff& f) { return floor_obscurance(f, corner(0.1, 0.1)); },
         {0.316738813, 0.493694218, 0.648723409, 0.551257938}},
        {"2 walls .25, .25",
         [](const Falloff& f) { return floor_obscurance(f, corner(0.25, 0.25)); },
         {0.427375547, 0.702166872, 0.817286476, 0.763500225}},
        {"2 walls .1, .5",
         [](const Falloff& f) { return floor_obscurance(f, corner(0.1, 0.5)); },
         {0.449942797, 0.658715464, 0.770480564, 0.706638299}},
        {"3 walls .25",
         [](const Falloff& f) { return floor_obscurance(f, THREE_WALLS); },
         {0.197269915, 0.572547467, 0.736976673, 0.659314425}},
        {"4 walls .25",
         [](const Falloff& f) { return floor_obscurance(f, square_well(0.25)); },
         {0.0795774716, 0.481522381, 0.678760790, 0.583256803}},
        {"cube .5",
         [](const Falloff& f) { return floor_obscurance(f, square_well(0.25), 0.5); },
         {0, 0.413308927, 0.638101068, 0.530338170}},
        {"cube 1",
         [](const Falloff& f) { return floor_obscurance(f, square_well(0.5), 1); },
         {0.318309886, 0.803889819, 0.891322599, 0.863409998}},
    };
    for (const Row& row : rows)
        for (size_t i = 0; i < MAIN_FALLOFFS.size(); ++i)
            EXPECT_NEAR(row.w(MAIN_FALLOFFS[i]), row.published[i], 6e-10)
                << row.name << ", " << falloff_text(MAIN_FALLOFFS[i]);
}

// Forms of their own, of Malley's disc: the wall cuts a segment off it, two walls two segments and their overlap.
TEST(Oracles, StepEqualsAreasOfTheDisc) {
    const auto segment = [](double x) { return (std::acos(x) - x * std::sqrt(1 - x * x)) / PI; };
    for (const double a : {0.001, 0.1, 0.25, 0.5, 0.7}) {
        EXPECT_NEAR(floor_obscurance(STEP, {{2, a}}), 1 - segment(a), 1e-13);
        EXPECT_NEAR(floor_obscurance(STEP, square_well(a)), 4 * a * a / PI, 1e-13);
        const double b = 0.3, end = std::sqrt(1 - b * b);
        const auto primitive = [](double u) { return 0.5 * (u * std::sqrt(1 - u * u) + std::asin(u)); };
        const double overlap = (primitive(end) - primitive(a) - b * (end - a)) / PI;
        EXPECT_NEAR(floor_obscurance(STEP, corner(a, b)), 1 - segment(a) - segment(b) + overlap, 1e-13);
    }
    for (const double x : {0.001, 0.1, 0.25, 0.5, 0.99}) {
        const double s = std::sqrt(1 - x * x);
        EXPECT_NEAR(floor_obscurance(LINEAR, {{0, x}}),
                    1 - segment(x) + 2 * x / PI * (std::log((1 + s) / x) - s), 1e-13);
    }
}

TEST(Oracles, ManyWallsEqualACylinder) {
    std::vector<Wall> walls;
    for (int i = 0; i < 64; ++i)
        walls.push_back({2 * PI * i / 64, 0.25});
    for (const Falloff& falloff : ALL_FALLOFFS)
        EXPECT_NEAR(floor_obscurance(falloff, walls), plane_obscurance(falloff, 0.25), 5e-4);
}

TEST(Oracles, NothingWithinReachIsOpen) {
    for (const Falloff& falloff : ALL_FALLOFFS) {
        EXPECT_EQ(floor_obscurance(falloff, {}), 1);
        EXPECT_DOUBLE_EQ(floor_obscurance(falloff, square_well(1), 2), 1);
        EXPECT_EQ(dome_obscurance(falloff, 1), 1);
    }
}

TEST(Oracles, NearbyParametersGiveNearbyValues) {
    for (const auto& w : {+[](const Falloff& f) { return plane_obscurance(f, 0.1); },
                          +[](const Falloff& f) { return sphere_obscurance(f, 0.5); },
                          +[](const Falloff& f) { return floor_obscurance(f, WALL); }}) {
        const auto exponent = [&](double p) { return w({FalloffKind::pow, p}); };
        EXPECT_NEAR(exponent(2), exponent(2 + 1e-9), 1e-8);
        EXPECT_EQ(exponent(0.5), w(SQRT));
        // 1 - exp(-lambda t) is linear for small lambda.
        EXPECT_NEAR(w({FalloffKind::exp, 1e-6}), w(LINEAR), 1e-6);
        EXPECT_NEAR(w({FalloffKind::exp, 700}), w({FalloffKind::exp, 710}), 1e-3);
    }
}

TEST(Oracles, BleedingKeepsOpenDirectionsApart) {
    const RgbD red(0.9, 0.2, 0.1), average(0.5, 0.4, 0.3);
    EXPECT_EQ(bleeding_obscurance(1, 1, red, average), average);
    EXPECT_EQ(bleeding_obscurance(1, 0, red, average), red);
    EXPECT_EQ(bleeding_obscurance(0, 0, red, average), RgbD(0));
}

}  // namespace
}  // namespace obscura::test
