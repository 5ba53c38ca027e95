// SPDX-License-Identifier: Apache-2.0
// What glossy surfaces, mirrors and panes show of lamps and of the sky: quadrature, Fresnel, energy.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "scene/albedo_table.h"
#include "scene/material.h"
#include "support/analytic_light.h"
#include "support/busy_room.h"
#include "support/lit_point.h"
#include "support/statistics.h"

namespace obscura::test {
namespace {

using Reflections = DeviceTest;

// What the glossy floor shows of a lamp, against quadrature. max_depth 0 samples the lamp alone, more
// depth shares the work with the lobe's own rays.
Material plastic(float roughness) {
    Material material = matte(Rgb(0.5f));
    material.specular = 1;
    material.roughness = roughness;
    return material;
}

TEST_F(Reflections, GlossyReflectionsOfALampEqualQuadrature) {
    ZTable table;
    for (const Material& material :
         {metal(Rgb(0.9f), 0.35f), metal(Rgb(0.9f), 1), plastic(0.35f), plastic(0.7f)}) {
        const SurfaceModel model = surface_model(material);
        const GgxLobe lobe{static_cast<double>(model.alpha), static_cast<double>(model.f0.x),
                           static_cast<double>(model.f90.x)};
        SceneBuilder builder = floor_scene(material);
        // Its mirror image lies beside the view, so that edges of the highlight fall on the lamp.
        builder.quad({-1.6f, 1, -0.5f}, {1.2f, 0, 0}, {0, 0, 1}, builder.material(matte(Rgb(0), Rgb(2))));
        const Scene scene = builder.finish();
        const double reflected =
            2 * reflected_rectangle(lobe, EYE, V3d(static_cast<double>(-1.6f), 1, -0.5), 1.2, 1);
        for (const uint32_t max_depth : {0u, 3u}) {
            for (const uint32_t light_samples : {1u, 8u}) {
                for (const bool roulette : {true, false}) {
                    // Rays followed by roulette are few and heavy.
                    const uint32_t spp = light_samples > 1 ? 32 : roulette ? 2048 : 512;
                    RenderSettings settings = point_settings(spp, light_samples);
                    settings.max_depth = max_depth;
                    settings.roulette = roulette;
                    ++settings.seed;
                    const Image image = render(scene, settings, {"specular.emission"}).image;
                    table.add(fmt::format(
                                  "metallic {}, roughness {}, depth {}, {} light samples, roulette {}",
                                  material.metallic, material.roughness, max_depth, light_samples, roulette),
                              channel(image, "specular.emission", 0), reflected, reflected, 3e-6 * reflected);
                }
            }
        }
    }
    table.expect_no_failure();
    table.expect_one_percent_matters();
}

TEST_F(Reflections, RouletteKeepsTheMeanOfEveryLayer) {
    const Scene room = busy_room();
    // Means over the picture, for 16 seeds each.
    const auto means = [&](bool roulette, uint64_t first_seed) {
        std::map<std::string, std::vector<double>> values;
        for (uint64_t seed = 0; seed < 16; ++seed) {
            RenderSettings settings = picture(48, 36, 8, 4);
            settings.roulette = roulette;
            settings.seed = first_seed + seed;
            const std::vector<std::string> names{"specular.emission", "specular.direct", "specular.ambient"};
            const Image image = render(room, settings, names).image;
            for (const std::string& name : names)
                values[name].push_back(estimate(channel(image, name, 0)).mean);
        }
        return values;
    };
    const auto on = means(true, 0), off = means(false, 100);
    const double limit = sidak_limit(on.size(), 30);
    for (const auto& [name, values] : on) {
        const Estimate a = estimate(values), b = estimate(off.at(name));
        EXPECT_GT(a.mean, 0);
        EXPECT_LT(std::abs(a.mean - b.mean), limit * std::hypot(a.standard_error, b.standard_error)) << name;
        EXPECT_LT(std::hypot(a.standard_error, b.standard_error), 0.06 * a.mean)
            << name;  // sharp enough to tell
    }
}

// White metal under a white sky: a lobe never reflects more than it gets.
const std::vector<float> ALPHAS{1, 0.1f, 0.01f, 1e-3f, 0};

TEST_F(Reflections, WhiteMetalKeepsWithinItsEnergy) {
    for (const float alpha : ALPHAS) {
        SceneBuilder builder;
        builder.sphere({0, 0, 0}, 1, 3, builder.material(metal(Rgb(1), std::sqrt(alpha))), false, true);
        builder.camera({0, 0, 3}, {0, 0, 0}, 0.72);
        RenderSettings settings = picture(32, 32, 16, 1);
        settings.background = Rgb(1);
        const Image image = render(builder.finish(), settings, {"specular.emission"}).image;
        const std::vector<double> reflected = channel(image, "specular.emission", 0);
        EXPECT_LE(*std::ranges::max_element(reflected), 1 + 1e-6) << alpha;
        EXPECT_GE(*std::ranges::min_element(reflected), 0) << alpha;
        EXPECT_GT(estimate(reflected).mean, 0.25) << alpha;
        for (const double value : channel(image, "", 0))
            EXPECT_TRUE(std::isfinite(value));
    }
}

TEST_F(Reflections, WhiteMetalReflectsItsDirectionalAlbedo) {
    ZTable table;
    for (const float alpha : ALPHAS) {
        for (const double mu : {1.0, 0.7, 0.2}) {
            const Material material = metal(Rgb(1), std::sqrt(alpha));
            SceneBuilder builder;
            builder.quad({-0.2f, 0, 0.2f}, {0.4f, 0, 0}, {0, 0, -0.4f}, builder.material(material));
            builder.camera(V3d(std::sqrt(1 - mu * mu), mu, 0), V3d(0, 0, 0), POINT_FOV);
            RenderSettings settings = point_settings(64, 1);
            settings.background = Rgb(1);
            const Image image = render(builder.finish(), settings, {"specular.emission"}).image;
            const double model_alpha = static_cast<double>(surface_model(material).alpha);
            const AlbedoTerms terms =
                model_alpha > 0 ? integrate_albedo(mu, model_alpha, 0.25) : AlbedoTerms{1, 0};
            table.add(fmt::format("alpha {}, mu {}", alpha, mu), channel(image, "specular.emission", 0),
                      terms.a + terms.b, terms.a + terms.b, 2e-6);
        }
    }
    table.expect_no_failure();
    table.expect_one_percent_matters();
}

// Light samples and the lobe's own rays both see the lamp through the pane: together they count it once.
TEST_F(Reflections, GlossyReflectionsOfALampBehindAPaneEqualQuadrature) {
    Material glass = clear_pane();
    glass.base_color = Rgb(1);
    const GgxLobe lobe{0.25, 0.9, 1};
    SceneBuilder builder = floor_scene(metal(Rgb(0.9f), 0.5f));
    builder.quad({-1.6f, 1, -0.5f}, {1.2f, 0, 0}, {0, 0, 1}, builder.material(matte(Rgb(0), Rgb(2))));
    builder.quad({-2, 0.9f, -2}, {1.9f, 0, 0}, {0, 0, 4}, builder.material(glass));
    const auto brdf = [&](const V3d& wi) { return lobe.brdf(EYE.normalized(), wi); };
    const double expected = 2 * rectangle_behind_pane(brdf, V3d(-1.6, 1, -0.5), 1.2, 1);
    const Scene scene = builder.finish();
    ZTable table;
    for (const uint32_t max_depth : {0u, 3u}) {
        RenderSettings settings = point_settings(256, 4);
        settings.max_depth = max_depth;
        table.add(fmt::format("depth {}", max_depth),
                  channel(render(scene, settings, {"specular.emission"}).image, "specular.emission", 0),
                  expected, expected, 3e-6 * expected);
    }
    table.expect_no_failure();
    table.expect_one_percent_matters();
}

TEST_F(Reflections, PaneShowsALampThroughBothFaces) {
    // Radiance 2 behind the pane, black before it.
    const double passed = 1 - 2 * DIELECTRIC_F0 / (1 + DIELECTRIC_F0);
    ZTable table;
    for (const bool roulette : {true, false}) {
        SceneBuilder builder;
        builder.quad({-1, -1, -3}, {2, 0, 0}, {0, 2, 0}, builder.material(matte(Rgb(0), Rgb(2))));
        builder.quad({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, builder.material(clear_pane()));
        builder.camera({0, 0, 0}, {0, 0, -1}, POINT_FOV);
        RenderSettings settings = point_settings(64, 1);
        settings.roulette = roulette;
        const Image image = render(builder.finish(), settings, {"specular.emission"}).image;
        for (size_t c = 0; c < 3; ++c) {
            const double tint = static_cast<double>(clear_pane().base_color[static_cast<int>(c)]);
            table.add(fmt::format("channel {}, roulette {}", c, roulette),
                      channel(image, "specular.emission", c), 2 * passed * tint, 2 * passed * tint, 2e-6);
        }
    }
    table.expect_no_failure();
    table.expect_one_percent_matters();
}

TEST_F(Reflections, MirrorShowsALampWithFresnel) {
    // 45 degrees: F = F0 + (1 - F0)(1 - cos)^5.
    SceneBuilder builder;
    builder.quad({-0.2f, 0, 0.2f}, {0.4f, 0, 0}, {0, 0, -0.4f},
                 builder.material(metal(Rgb(0.9f, 0.5f, 0), 0)));
    builder.quad({-3, 0, 1}, {0, 0, -2}, {0, 5, 0}, builder.material(matte(Rgb(0), Rgb(2))));
    builder.camera({1, 1, 0}, {0, 0, 0}, POINT_FOV);
    RenderSettings settings = point_settings(1, 1);
    settings.roulette = false;
    const Image image = render(builder.finish(), settings, {"specular.emission"}).image;
    const double grazing = std::pow(1 - std::numbers::sqrt2 / 2, 5);
    for (size_t c = 0; c < 3; ++c) {
        const double f0 = c == 0 ? 0.9 : c == 1 ? 0.5 : 0;
        for (const double value : channel(image, "specular.emission", c))
            EXPECT_NEAR(value, 2 * (f0 + (1 - f0) * grazing), 1e-5);
    }
}

// A white sheet in a room of radiance 1 shows 1, of what material so ever: reflected by its pane and by its lobe, passed,
// diffuse. Roughness must not add a second reflection.
TEST_F(Reflections, WhitePaneInAUniformRoomIsInvisible) {
    ZTable table;
    for (const float transmission : {0.5f, 1.0f}) {
        for (const float roughness : {0.0f, 0.5f, 1.0f}) {
            Material sheet = clear_pane();
            sheet.base_color = Rgb(1);
            sheet.specular = 1;
            sheet.roughness = roughness;
            sheet.transmission = transmission;
            SceneBuilder builder = floor_scene(sheet);
            builder.box({-3, -3, -3}, {3, 3, 3}, builder.material(matte(Rgb(0), Rgb(1))), true);
            const Image image = render(builder.finish(), point_settings(256, 4)).image;
            table.add(fmt::format("transmission {}, roughness {}", transmission, roughness),
                      channel(image, "", 0), 1, 1, 1e-5);
        }
    }
    table.expect_no_failure();
    table.expect_one_percent_matters();
}

}  // namespace
}  // namespace obscura::test
