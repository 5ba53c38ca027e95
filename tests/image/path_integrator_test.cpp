// SPDX-License-Identifier: Apache-2.0
// The path tracer by itself: light that is known in closed form, with all its interreflections. Pixels are independent
// randomisations of one number, which all of them share.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "scene/albedo_table.h"
#include "support/analytic_light.h"
#include "support/busy_room.h"
#include "support/lit_point.h"
#include "support/reference_picture.h"
#include "support/statistics.h"

namespace obscura::test {
namespace {

constexpr double ROUNDING = 1e-6;  // relative: pixels are floats

// Inside closed walls of reflectivity R that all emit E, every ray finds E / (1 - R), whatever stands inside as long as it
// absorbs nothing.
void add_furnace(ZTable& table, const std::string& name, const Scene& scene, double expected,
                 RenderSettings settings = picture(16, 16, 128)) {
    for (const SamplerKind sampler : {SamplerKind::lattice, SamplerKind::random}) {
        settings.sampler = sampler;
        table.add(fmt::format("{}, {}", name, sampler == SamplerKind::random ? "random" : "lattice"),
                  channel(path_picture(scene, settings), "", 0), expected, expected, ROUNDING * expected);
    }
}

// The furnace sphere around what `add` builds.
template <typename Add>
Scene furnace_around(float reflectivity, const Add& add) {
    SceneBuilder builder;
    builder.sphere(V3f(0), 1, 3, builder.material(matte(Rgb(reflectivity), Rgb(1))), true);
    add(builder);
    builder.camera(V3d(0, 0, 0.9), V3d(0, 0, 0), 0.9);
    return builder.finish();
}

// A lamp of radiance 2 over the origin, 2a x 2b, facing down.
void add_lamp(SceneBuilder& builder, double a, double b, double height) {
    const V3f corner(static_cast<float>(-a), static_cast<float>(height), static_cast<float>(-b));
    builder.quad(corner, {static_cast<float>(2 * a), 0, 0}, {0, 0, static_cast<float>(2 * b)},
                 builder.material(matte(Rgb(0), Rgb(2))));
}

TEST(PathIntegrator, ClosedFurnaceIsUniform) {
    ZTable table;
    for (const float r : {0.0f, 0.2f, 0.5f, 0.8f}) {
        // Bright walls reflect many times, with the more variance.
        add_furnace(table, fmt::format("R {}", r), furnace_sphere(Rgb(r), Rgb(1)),
                    1 / (1 - static_cast<double>(r)), picture(16, 16, r > 0.7f ? 256 : 128));
    }
    table.expect_no_failure();
    table.expect_one_percent_matters();
}

TEST(PathIntegrator, SmoothNormalsLoseNoLight) {
    SceneBuilder builder;
    builder.sphere(V3f(0), 1, 1, builder.material(matte(Rgb(0.5f), Rgb(1))), true, true);
    builder.camera(V3d(0), V3d(0, 0, -1), 1.2);
    ZTable table;
    add_furnace(table, "coarse sphere", builder.finish(), 2);
    table.expect_no_failure();
    table.expect_one_percent_matters();
}

TEST(PathIntegrator, WhatAbsorbsNothingVanishesInTheFurnace) {
    Material white_pane = clear_pane();
    white_pane.base_color = Rgb(1);
    Material half_pane = white_pane;
    half_pane.transmission = 0.5f;
    ZTable table;
    for (const auto& [name, material] : {std::pair{"mirror", metal(Rgb(1), 0)},
                                         {"white", matte(Rgb(1))},
                                         {"pane", white_pane},
                                         {"half pane", half_pane}}) {
        const Scene scene = furnace_around(0.5f, [&, m = material](SceneBuilder& builder) {
            builder.quad({-0.3f, -0.3f, 0}, {0.6f, 0, 0}, {0, 0.6f, 0}, builder.material(m));
        });
        add_furnace(table, name, scene, 2);
    }
    table.expect_no_failure();
    table.expect_one_percent_matters();
}

// What one bounce on a rough metal loses is the albedo's complement: the pixel shows E / (1 - R) times the albedo.
TEST(PathIntegrator, RoughMetalReflectsItsAlbedo) {
    ZTable table;
    for (const float roughness : {0.2f, 0.6f, 1.0f}) {
        SceneBuilder builder;
        builder.sphere(V3f(0), 10, 3, builder.material(matte(Rgb(0.5f), Rgb(1))), true);
        builder.quad({-0.01f, 0, 0.01f}, {0.02f, 0, 0}, {0, 0, -0.02f},
                     builder.material(metal(Rgb(0.8f), roughness)));
        builder.camera(EYE, V3d(0), POINT_FOV);
        const double alpha = static_cast<double>(roughness) * static_cast<double>(roughness);
        const AlbedoTerms terms = integrate_albedo(EYE.y / EYE.length(), alpha, 0.1);
        const double expected = 2 * (static_cast<double>(0.8f) * terms.a + terms.b);
        table.add(fmt::format("roughness {}", roughness),
                  channel(path_picture(builder.finish(), picture(16, 16, 512)), "", 0), expected, expected,
                  ROUNDING * expected);
    }
    table.expect_no_failure();
    table.expect_one_percent_matters();
}

// An integrating sphere: light from one part of a closed sphere of reflectivity R arrives everywhere alike, and reflected
// again and again it is R / (1 - R) times the mean emission.
TEST(PathIntegrator, IntegratingSphereSpreadsLightEvenly) {
    constexpr double R = 0.5;
    SceneBuilder builder;
    const uint32_t wall = builder.material(matte(Rgb(static_cast<float>(R))));
    const uint32_t lamp = builder.material(matte(Rgb(static_cast<float>(R)), Rgb(1)));
    builder.sphere(V3f(0), 1, 4, wall, true);
    builder.camera(V3d(0), V3d(0, -1, 0), 0.9);
    Scene scene = builder.finish();
    double lit = 0, all = 0;
    for (uint32_t i = 0; i < scene.triangles.size(); ++i) {
        const double area = triangle_area(scene, i);
        all += area;
        if (scene.corner(i, 0).position.y < 0.8f) continue;
        scene.triangles[i].material = lamp;
        lit += area;
    }
    // Flat facets stand for the sphere: their form factors differ from it by a part in a few hundred.
    const double expected = R / (1 - R) * lit / all;
    ZTable table;
    table.add("integrating sphere", channel(path_picture(scene, picture(24, 24, 256)), "", 0),
              0.997 * expected, 1.003 * expected, 0);
    table.expect_no_failure();
    table.expect_one_percent_matters();
}

TEST(PathIntegrator, LampsGiveTheirFormFactors) {
    ZTable table;
    for (const auto& [a, b, height] : {std::tuple{0.05, 0.02, 2.0}, {1.0, 0.5, 1.0}, {4.0, 3.0, 1.0}}) {
        SceneBuilder builder = floor_scene(matte(Rgb(0.5f)));
        add_lamp(builder, a, b, height);
        const double expected = 0.5 * 2 * 4 * parallel_corner_factor(a, b, height);
        table.add(fmt::format("{} x {} at {}", a, b, height),
                  channel(path_picture(builder.finish(), picture(16, 16, 256)), "", 0), expected, expected,
                  ROUNDING * expected);
    }
    table.expect_no_failure();
    table.expect_one_percent_matters();
}

// Light samples and rays of both lobes see the lamp through the pane: it must not count twice.
TEST(PathIntegrator, LampsBehindAPaneCountOnce) {
    constexpr double A = 0.6, B = 0.4, HEIGHT = 1;
    ZTable table;
    for (const auto& [name, material] :
         {std::pair{"matte", matte(Rgb(0.5f))}, {"rough", metal(Rgb(0.5f), 0.6f)}}) {
        SceneBuilder builder;
        // So small that the pane reflects next to nothing of it back to it.
        builder.quad({-0.005f, 0, 0.005f}, {0.01f, 0, 0}, {0, 0, -0.01f}, builder.material(material));
        builder.camera(EYE, V3d(0), POINT_FOV);
        add_lamp(builder, A, B, HEIGHT);
        Material glass = clear_pane();
        glass.base_color = Rgb(1);
        builder.quad({-20, 0.9f, -20}, {40, 0, 0}, {0, 0, 40}, builder.material(glass));
        const bool rough = material.metallic > 0;
        const GgxLobe lobe{0.36, 0.5, 1};
        const V3d wo = EYE.normalized();
        const auto brdf = [&](const V3d& wi) { return rough ? lobe.brdf(wo, wi) : 0.5 / std::numbers::pi; };
        const double expected = 2 * rectangle_behind_pane(brdf, V3d(-A, HEIGHT, -B), 2 * A, 2 * B);
        table.add(name, channel(path_picture(builder.finish(), picture(16, 16, 256)), "", 0), expected,
                  expected, 1e-5 * expected);
    }
    table.expect_no_failure();
    table.expect_one_percent_matters();
}

TEST(PathIntegrator, PunctualLightsFollowTheInverseSquareLaw) {
    SceneBuilder builder = floor_scene(matte(Rgb(0.5f)));
    builder.light(point_light({0, 2, 0}, Rgb(3)));
    builder.light(directional_light({3, -4, 0}, Rgb(2)));
    const double expected = 0.5 / std::numbers::pi * (3.0 / 4 + 2 * 0.8);
    ZTable table;
    table.add("two lamps", channel(path_picture(builder.finish(), picture(16, 16, 64)), "", 0), expected,
              expected, ROUNDING);
    table.expect_no_failure();
    table.expect_one_percent_matters();
}

TEST(PathIntegrator, SkyLightsAnOpenFloor) {
    SceneBuilder builder = floor_scene(matte(Rgb(0.5f)));
    RenderSettings settings = picture(8, 8, 4);
    settings.background = Rgb(1, 2, 3);
    const Image image = path_picture(builder.finish(), settings);
    for (const size_t c : {size_t{0}, size_t{1}, size_t{2}})
        for (const double value : channel(image, "", c))
            EXPECT_NEAR(value, 0.5 * static_cast<double>(c + 1), ROUNDING);
}

// A picture that is unlit is seen, also in mirrors, and lights nothing.
TEST(PathIntegrator, UnlitSurfacesLightNothing) {
    SceneBuilder builder = floor_scene(matte(Rgb(0.5f)));
    builder.quad({-5, 1, -5}, {10, 0, 0}, {0, 0, 10}, builder.material(unlit_picture()));
    EXPECT_EQ(channel(path_picture(builder.finish(), picture(8, 8, 4)), "", 2), std::vector<double>(64, 0.0));
    SceneBuilder mirror = floor_scene(metal(Rgb(1), 0));
    mirror.quad({-5, 1, -5}, {10, 0, 0}, {0, 0, 10}, mirror.material(unlit_picture()));
    for (const double value : channel(path_picture(mirror.finish(), picture(8, 8, 4)), "", 2))
        EXPECT_NEAR(value, 0.9, 1e-6);
}

}  // namespace
}  // namespace obscura::test
