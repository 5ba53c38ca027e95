// SPDX-License-Identifier: Apache-2.0
// Light straight from lamps: closed forms of what reaches a point of a matte floor.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "scene/material.h"
#include "support/analytic_light.h"
#include "support/busy_room.h"
#include "support/lit_point.h"
#include "support/statistics.h"

namespace obscura::test {
namespace {

using Lights = DeviceTest;

constexpr double ALBEDO = 0.5;

SceneBuilder matte_floor() {
    return floor_scene(matte(Rgb(static_cast<float>(ALBEDO))));
}

std::vector<double> direct(const Scene& scene, const RenderSettings& settings) {
    return channel(render(scene, settings, {"direct"}).image, "direct", 0);
}

// The floor's direct light under one lamp, in every pixel. rounding: relative; darkness is exact.
void expect_lit(const PunctualLight& light, double irradiance, double rounding = 3e-6) {
    SceneBuilder builder = matte_floor();
    builder.light(light);
    const Scene scene = builder.finish();
    const double expected = ALBEDO / std::numbers::pi * irradiance;
    for (const double value : direct(scene, point_settings(1, 1)))
        EXPECT_NEAR(value, expected, rounding * expected);
}

TEST_F(Lights, PointLightFollowsTheInverseSquareLaw) {
    expect_lit(point_light({0, 2, 0}, Rgb(3)), 3.0 / 4);
    expect_lit(point_light({0, 0.5f, 0}, Rgb(3)), 3.0 / 0.25);
    expect_lit(point_light({3, 4, 0}, Rgb(3)), 3 * 0.8 / 25);
    expect_lit(point_light({0, -1, 0}, Rgb(3)), 0);
}

TEST_F(Lights, RangeEndsAPointLightSmoothly) {
    PunctualLight light = point_light({0, 2, 0}, Rgb(3));
    light.range = 4;  // 1 - (d / range)^4
    expect_lit(light, 3.0 / 4 * (1 - 1.0 / 16));
    light.range = 1.9f;
    expect_lit(light, 0);
}

TEST_F(Lights, SpotLightFadesBetweenItsCones) {
    for (const float angle : {0.0f, 0.29f, 0.35f, 0.4f, 0.45f, 0.51f, 1.0f}) {
        // At height 2 over the point, turned away from it by the angle.
        const V3f axis(std::sin(angle), -std::cos(angle), 0);
        const double outer = std::cos(0.5), inner = std::cos(0.3);
        const double fade =
            std::clamp((std::cos(static_cast<double>(angle)) - outer) / (inner - outer), 0.0, 1.0);
        // Between the cones a rounding error of the cosine counts as a part of their difference, 0.08.
        expect_lit(spot_light({0, 2, 0}, axis, Rgb(3), 0.3f, 0.5f), 3.0 / 4 * fade * fade,
                   3e-6 + 3e-7 / 0.08 / std::max(fade, 1e-3));
    }
}

TEST_F(Lights, DirectionalLightFollowsTheCosine) {
    expect_lit(directional_light({0, -1, 0}, Rgb(2)), 2);
    expect_lit(directional_light({3, -4, 0}, Rgb(2)), 1.6);
    expect_lit(directional_light({0, 1, 0}, Rgb(2)), 0);
}

TEST_F(Lights, OpaqueSurfacesCastShadows) {
    for (const PunctualLight& light :
         {point_light({0, 2, 0}, Rgb(3)), directional_light({0, -1, 0}, Rgb(2))}) {
        // Between the light and the floor, behind the light, and beside the ray.
        for (const auto& [height, x, lit] : {std::tuple{1.0f, -0.1f, false},
                                             {2.5f, -0.1f, light.type == LightType::point},
                                             {1.0f, 0.1f, true}}) {
            SceneBuilder builder = matte_floor();
            builder.light(light);
            builder.quad({x, height, -0.1f}, {0.2f, 0, 0}, {0, 0, 0.2f}, builder.material(matte(Rgb(0.5f))));
            for (const double value : direct(builder.finish(), point_settings(1, 1)))
                EXPECT_EQ(value > 0, lit) << "height " << height;
        }
    }
}

TEST_F(Lights, SeveralPunctualLightsAddUp) {
    SceneBuilder builder = matte_floor();
    builder.light(point_light({0, 2, 0}, Rgb(3)));
    builder.light(point_light({0.6f, 0.8f, 0}, Rgb(2)));
    builder.light(directional_light({3, -4, 0}, Rgb(0.5f)));
    builder.light(spot_light({0, 1, 0}, {0, -1, 0}, Rgb(1), 0.3f, 0.5f));
    builder.light(point_light({0, 2, 0}, Rgb(0)));
    const Scene scene = builder.finish();
    const double expected = ALBEDO / std::numbers::pi * (3.0 / 4 + 2 * 0.8 + 0.5 * 0.8 + 1);
    ZTable table;
    for (const SamplerKind sampler : {SamplerKind::random, SamplerKind::owen, SamplerKind::lattice}) {
        RenderSettings settings = point_settings(64, 4);
        settings.sampler = sampler;
        table.add(fmt::format("sampler {}", static_cast<int>(sampler)), direct(scene, settings), expected,
                  expected, 1e-6 * expected);
    }
    table.expect_no_failure();
    table.expect_one_percent_matters();
}

// A rectangle of radiance 2 over the floor, facing it, cut into parts x parts quads.
void add_ceiling(SceneBuilder& builder, float a, float b, float height, int parts, bool double_sided = false,
                 bool faces_down = true) {
    Material lamp = matte(Rgb(0), Rgb(2));
    lamp.double_sided = double_sided;
    const uint32_t material = builder.material(lamp);
    const V3f u(2 * a / static_cast<float>(parts), 0, 0), v(0, 0, 2 * b / static_cast<float>(parts));
    for (int i = 0; i < parts; ++i) {
        for (int j = 0; j < parts; ++j) {
            const V3f corner = V3f(-a, height, -b) + static_cast<float>(i) * u + static_cast<float>(j) * v;
            faces_down ? builder.quad(corner, u, v, material) : builder.quad(corner, v, u, material);
        }
    }
}

TEST_F(Lights, RectanglesHaveTheirFormFactors) {
    ZTable table;
    for (const SamplerKind sampler : {SamplerKind::random, SamplerKind::owen, SamplerKind::lattice}) {
        // Small and far, as wide as high, wider. 2 triangles are weighed at the receiver, 128 are picked by
        // power.
        for (const auto& [a, b, height] : {std::tuple{0.05, 0.02, 2.0}, {1.0, 0.5, 1.0}, {2.0, 1.5, 1.0}}) {
            for (const int parts : {1, 8}) {
                for (const bool double_sided : {false, true}) {
                    SceneBuilder builder = matte_floor();
                    add_ceiling(builder, static_cast<float>(a), static_cast<float>(b),
                                static_cast<float>(height), parts, double_sided, !double_sided);
                    RenderSettings settings = point_settings(320, 4);
                    settings.sampler = sampler;
                    const double expected = ALBEDO * 2 * 4 * parallel_corner_factor(a, b, height);
                    table.add(fmt::format("{} x {} at {}, {} parts, sampler {}", a, b, height, parts * parts,
                                          static_cast<int>(sampler)),
                              direct(builder.finish(), settings), expected, expected, 2e-6 * expected);
                }
            }
        }
    }
    table.expect_no_failure();
    table.expect_one_percent_matters();
}

// Which lamp and where on it are two dimensions of each light sample: pairing them badly costs more than random points.
TEST_F(Lights, StratifiedSamplersBeatRandomPointsOnManyLamps) {
    SceneBuilder builder = matte_floor();
    add_ceiling(builder, 1, 0.5f, 1, 8);
    const Scene scene = builder.finish();
    const auto error = [&](SamplerKind sampler, uint32_t light_samples) {
        RenderSettings settings = point_settings(256, light_samples);
        settings.sampler = sampler;
        return estimate(direct(scene, settings)).standard_error;
    };
    for (const uint32_t light_samples : {1u, 3u, 4u, 16u}) {
        const double random = error(SamplerKind::random, light_samples);
        EXPECT_LT(error(SamplerKind::owen, light_samples), 0.8 * random) << light_samples;
        EXPECT_LT(error(SamplerKind::lattice, light_samples), 0.8 * random) << light_samples;
    }
}

TEST_F(Lights, StandingRectanglesHaveTheirFormFactors) {
    ZTable table;
    for (const auto& [w, h, c] : {std::tuple{0.5, 1.0, 1.0}, {3.0, 2.0, 0.4}}) {
        SceneBuilder builder = matte_floor();
        const auto width = static_cast<float>(w), height = static_cast<float>(h),
                   distance = static_cast<float>(c);
        builder.quad({-distance, 0, width}, {0, 0, -2 * width}, {0, height, 0},
                     builder.material(matte(Rgb(0), Rgb(2))));
        const double expected = ALBEDO * 2 * standing_factor(w, h, c);
        table.add(fmt::format("{} x {} at {}", w, h, c), direct(builder.finish(), point_settings(128, 4)),
                  expected, expected, 2e-6 * expected);
    }
    table.expect_no_failure();
    table.expect_one_percent_matters();
}

TEST_F(Lights, BackSideOfALampIsDark) {
    SceneBuilder builder = matte_floor();
    add_ceiling(builder, 1, 1, 1, 1, false, false);
    EXPECT_EQ(direct(builder.finish(), point_settings(4, 4)), std::vector<double>(256, 0.0));
}

TEST_F(Lights, PaneDimsDirectLight) {
    // Light falls through two panes at 60 degrees to their normals.
    const double passed = 1 - pane_reflectance(0.5);
    SceneBuilder builder = matte_floor();
    builder.light(directional_light({std::sqrt(3.0f), -1, 0}, Rgb(2)));
    const uint32_t pane = builder.material(clear_pane());
    builder.quad({-5, 0.1f, -1}, {0, 0, 2}, {6, 0, 0}, pane);
    builder.quad({-5, 0.2f, -1}, {6, 0, 0}, {0, 0, 2}, pane);
    Scene scene = builder.finish();
    SceneBuilder below;
    below.camera({0.06, 0.08, 0}, {0, 0, 0}, POINT_FOV);  // under the panes
    scene.cameras = below.finish().cameras;
    const Image image = render(scene, point_settings(1, 1), {"direct"}).image;
    for (size_t c = 0; c < 3; ++c) {
        const double tint = static_cast<double>(clear_pane().base_color[static_cast<int>(c)]);
        const double expected = ALBEDO / std::numbers::pi * 2 * 0.5 * passed * passed * tint * tint;
        for (const double value : channel(image, "direct", c))
            EXPECT_NEAR(value, expected, 1e-5 * expected);
    }
}

}  // namespace
}  // namespace obscura::test
