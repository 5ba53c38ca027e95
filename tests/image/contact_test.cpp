// SPDX-License-Identifier: Apache-2.0
// The square root is steep where occluders touch: 8 bits of a picture show an error of the distance there. A plane at
// 10^-7 to 10^-2 d_max over floors that are small and large, near the origin and far, level and askew.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/falloffs.h"
#include "support/oracle_geometry.h"
#include "support/render.h"
#include "support/statistics.h"

namespace obscura::test {
namespace {

using Contact = DeviceTest;

// Lengths are in units of d_max.
struct Floor {
    double size;    // of its sides
    double offset;  // of its middle from the origin, along each axis
    V3d normal;
};

const V3d LEVEL(0, 1, 0), ASKEW = V3d(1, 2, 3).normalized();

// Of a higher start rays meet the plane so much nearer that 8 bits may show it.
constexpr double LARGEST_LIFT = 1e-5;

constexpr double ROUNDOFF = 0x1p-24;

// How far rays start above the floor: the bound of position_error (kernels/lib/surface.clh).
double lift(const Scene& scene) {
    const V3d normal = geometric_normal(scene, 0);
    double largest = 0, longest = 0;
    for (int i = 0; i < 3; ++i) {
        const V3d a(scene.corner(0, i).position), b(scene.corner(0, (i + 1) % 3).position);
        double along = 0;
        for (int axis = 0; axis < 3; ++axis)
            along += std::abs(normal[axis] * a[axis]);
        largest = std::max(largest, along);
        longest = std::max(longest, (b - a).length());
    }
    return ROUNDOFF * (7 * largest + 4 * longest);
}

// The floor, and a plane over it that is infinite as far as d_max goes.
Scene make_scene(const Floor& floor, double height) {
    const V3d point(floor.offset);
    const V3d u = floor.normal.cross(V3d(1, 0, 0)).normalized(), v = floor.normal.cross(u);
    SceneBuilder builder;
    const uint32_t material = builder.material(matte(ORACLE_COLOR));
    builder.quad(V3f(point - 0.5 * floor.size * (u + v)), V3f(floor.size * u), V3f(floor.size * v), material);
    const double half = static_cast<double>(BEYOND_REACH);
    builder.quad(V3f(point + height * floor.normal - half * (u + v)), V3f(2 * half * v), V3f(2 * half * u),
                 material);
    builder.camera(point + 0.5 * height * floor.normal, point, ONE_POINT_FOV);
    return builder.finish();
}

// Between the two planes at the floor's middle, as floats have them.
double built_height(const Scene& scene, const V3d& middle) {
    const V3d floor_normal = geometric_normal(scene, 0);
    const V3d foot = middle - floor_normal * (middle - V3d(scene.corner(0, 0).position)).dot(floor_normal);
    return std::abs((foot - V3d(scene.corner(2, 0).position)).dot(geometric_normal(scene, 2)));
}

// From here on W is right: the lift twice, and the rounding of the plane's corners, seen from the floor.
double least_height(const Scene& scene) {
    const V3d diagonal(scene.corner(2, 2).position - scene.corner(2, 0).position);
    return 2 * lift(scene) + ROUNDOFF * diagonal.length();
}

double obscurance(const Scene& scene) {
    RenderSettings settings = picture(4, 4, 64, 256);
    settings.falloff = SQRT;
    settings.d_max.value = 1;
    settings.ambient_light = Rgb(1);
    return estimate(channel(render(scene, settings, {"ao"}).image, "ao", 0)).mean;
}

TEST_F(Contact, SquareRootIsRightBeyondRounding) {
    size_t right = 0;
    for (const V3d& normal : {LEVEL, ASKEW}) {
        for (const auto& [size, offset] : {std::pair{0.1, 0.0},
                                           {1.0, 0.0},
                                           {4.0, 0.0},
                                           {10.0, 0.0},
                                           {0.1, 1.0},
                                           {0.1, 10.0},
                                           {4.0, 4.0}}) {
            for (const double height : {1e-7, 3e-7, 1e-6, 3e-6, 1e-5, 3e-5, 1e-4, 1e-3, 1e-2}) {
                const Floor floor{size, offset, normal};
                const Scene scene = make_scene(floor, height);
                const double built = built_height(scene, V3d(offset));
                ASSERT_LE(lift(scene), LARGEST_LIFT);
                if (built < least_height(scene)) continue;
                EXPECT_NEAR(obscurance(scene), floor_obscurance(SQRT, {}, built), 1.0 / 512)
                    << fmt::format("size {}, offset {}, normal {} {} {}, height {}", size, offset, normal.x,
                                   normal.y, normal.z, built);
                ++right;
            }
        }
    }
    EXPECT_GE(right, 70u);
}

// What README says of a small floor.
TEST_F(Contact, SmallLevelFloorNeedsATenMillionth) {
    const Scene scene = make_scene({0.1, 0, LEVEL}, 1e-7);
    EXPECT_NEAR(obscurance(scene), floor_obscurance(SQRT, {}, static_cast<double>(1e-7f)), 1.0 / 512);
}

// Beyond README's limits.
TEST_F(Contact, HighStartsFindThePlaneTooNear) {
    const Floor floor{0.1, 100, ASKEW};
    const Scene scene = make_scene(floor, 1e-4);
    EXPECT_GT(lift(scene), LARGEST_LIFT);
    const double error =
        obscurance(scene) - floor_obscurance(SQRT, {}, built_height(scene, V3d(floor.offset)));
    EXPECT_LT(error, -1.0 / 512);
    EXPECT_GT(error, -0.004);
}

TEST_F(Contact, NothingIsSeenBelowTheLift) {
    for (const auto& [size, offset] : {std::pair{4.0, 0.0}, {10.0, 0.0}}) {
        const Scene scene = make_scene({size, offset, LEVEL}, 5e-7);
        ASSERT_LT(5e-7, 0.5 * lift(scene));
        EXPECT_EQ(obscurance(scene), 1);
    }
}

}  // namespace
}  // namespace obscura::test
