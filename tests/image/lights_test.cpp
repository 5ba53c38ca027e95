// SPDX-License-Identifier: Apache-2.0
// Light from lamps: closed forms of what reaches a point of a matte floor, and of what a glossy floor or a pane shows.
// 16 pixels that see the same point are 16 independent randomisations of it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include "scene/albedo_table.h"
#include "scene/material.h"
#include "support/analytic_light.h"
#include "support/busy_room.h"
#include "support/render.h"
#include "support/statistics.h"

namespace obscura::test {
namespace {

using Lights = DeviceTest;

constexpr double ALBEDO = 0.5;
constexpr double POINT_FOV = 1e-6;
const V3d EYE = V3d(0.6, 0.8, 0);  // of the camera, from the floor's point

RenderSettings point_settings(uint32_t spp, uint32_t light_samples) {
    RenderSettings settings = picture(4, 4, spp, 1);
    settings.light_samples = light_samples;
    settings.obscurance = false;
    return settings;
}

// A floor about the origin, of which the camera sees the origin alone.
SceneBuilder floor_scene(const Material& material) {
    SceneBuilder builder;
    builder.quad({-0.2f, 0, 0.2f}, {0.4f, 0, 0}, {0, 0, -0.4f}, builder.material(material));
    builder.camera(EYE, V3d(0, 0, 0), POINT_FOV);
    return builder;
}

SceneBuilder matte_floor() {
    return floor_scene(matte(Rgb(static_cast<float>(ALBEDO))));
}

std::vector<double> direct(const Scene& scene, const RenderSettings& settings) {
    return channel(render(scene, settings, {"direct"}).image, "direct", 0);
}

// The floor's direct light under one lamp, in every pixel.
void expect_lit(const PunctualLight& light, double irradiance) {
    SceneBuilder builder = matte_floor();
    builder.light(light);
    const Scene scene = builder.finish();
    const double expected = ALBEDO / std::numbers::pi * irradiance;
    for (const double value : direct(scene, point_settings(1, 1)))
        EXPECT_NEAR(value, expected, 3e-6 * expected);
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
        expect_lit(spot_light({0, 2, 0}, axis, Rgb(3), 0.3f, 0.5f), 3.0 / 4 * fade * fade);
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
    builder.light(point_light({3, 4, 0}, Rgb(30)));
    builder.light(directional_light({3, -4, 0}, Rgb(0.5f)));
    builder.light(spot_light({0, 1, 0}, {0, -1, 0}, Rgb(1), 0.3f, 0.5f));
    builder.light(point_light({0, 2, 0}, Rgb(0)));
    const Scene scene = builder.finish();
    const double expected = ALBEDO / std::numbers::pi * (3.0 / 4 + 30 * 0.8 / 25 + 0.5 * 0.8 + 1);
    ZTable table;
    for (const SamplerKind sampler : {SamplerKind::random, SamplerKind::owen, SamplerKind::lattice}) {
        RenderSettings settings = point_settings(64, 4);
        settings.sampler = sampler;
        table.add(fmt::format("sampler {}", static_cast<int>(sampler)), direct(scene, settings), expected,
                  expected, 1e-6 * expected);
    }
    table.expect_no_failure();
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
        // Small and far, as wide as high, huge and near. 2 triangles are weighed at the receiver, 128 are picked by
        // power.
        for (const auto& [a, b, height] : {std::tuple{0.05, 0.02, 2.0}, {1.0, 0.5, 1.0}, {8.0, 4.0, 0.5}}) {
            for (const int parts : {1, 8}) {
                for (const bool double_sided : {false, true}) {
                    SceneBuilder builder = matte_floor();
                    add_ceiling(builder, static_cast<float>(a), static_cast<float>(b),
                                static_cast<float>(height), parts, double_sided, !double_sided);
                    RenderSettings settings = point_settings(256, 4);
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
        table.add(fmt::format("{} x {} at {}", w, h, c), direct(builder.finish(), point_settings(256, 4)),
                  expected, expected, 2e-6 * expected);
    }
    table.expect_no_failure();
}

TEST_F(Lights, BackSideOfALampIsDark) {
    SceneBuilder builder = matte_floor();
    add_ceiling(builder, 1, 1, 1, 1, false, false);
    EXPECT_EQ(direct(builder.finish(), point_settings(4, 4)), std::vector<double>(16, 0.0));
}

// Reflections: what the glossy floor shows of a lamp, against quadrature. max_depth 0 samples the lamp alone, more
// depth shares the work with the lobe's own rays.
Material plastic(float roughness) {
    Material material = matte(Rgb(static_cast<float>(ALBEDO)));
    material.specular = 1;
    material.roughness = roughness;
    return material;
}

TEST_F(Lights, GlossyReflectionsOfALampEqualQuadrature) {
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
                    RenderSettings settings = point_settings(512, light_samples);
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
}

TEST_F(Lights, RouletteKeepsTheMeanOfEveryLayer) {
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
        EXPECT_LT(std::hypot(a.standard_error, b.standard_error), 0.02 * a.mean)
            << name;  // sharp enough to tell
    }
}

// White metal under a white sky: a lobe never reflects more than it gets.
const std::vector<float> ALPHAS{1, 0.1f, 0.01f, 1e-3f, 0};

TEST_F(Lights, WhiteMetalKeepsWithinItsEnergy) {
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
        EXPECT_GT(estimate(reflected).mean, 0.4) << alpha;
        for (const double value : channel(image, "", 0))
            EXPECT_TRUE(std::isfinite(value));
    }
}

TEST_F(Lights, WhiteMetalReflectsItsDirectionalAlbedo) {
    ZTable table;
    for (const float alpha : ALPHAS) {
        for (const double mu : {1.0, 0.7, 0.2}) {
            const Material material = metal(Rgb(1), std::sqrt(alpha));
            SceneBuilder builder;
            builder.quad({-0.2f, 0, 0.2f}, {0.4f, 0, 0}, {0, 0, -0.4f}, builder.material(material));
            builder.camera(V3d(std::sqrt(1 - mu * mu), mu, 0), V3d(0, 0, 0), POINT_FOV);
            RenderSettings settings = point_settings(1024, 1);
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
}

TEST_F(Lights, PaneShowsALampThroughBothFaces) {
    // Radiance 2 behind the pane, black before it.
    const double passed = 1 - 2 * DIELECTRIC_F0 / (1 + DIELECTRIC_F0);
    ZTable table;
    for (const bool roulette : {true, false}) {
        SceneBuilder builder;
        builder.quad({-1, -1, -3}, {2, 0, 0}, {0, 2, 0}, builder.material(matte(Rgb(0), Rgb(2))));
        builder.quad({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, builder.material(clear_pane()));
        builder.camera({0, 0, 0}, {0, 0, -1}, POINT_FOV);
        RenderSettings settings = point_settings(1024, 1);
        settings.roulette = roulette;
        const Image image = render(builder.finish(), settings, {"specular.emission"}).image;
        for (size_t c = 0; c < 3; ++c) {
            const double tint = static_cast<double>(clear_pane().base_color[static_cast<int>(c)]);
            table.add(fmt::format("channel {}, roulette {}", c, roulette),
                      channel(image, "specular.emission", c), 2 * passed * tint, 2 * passed * tint, 2e-6);
        }
    }
    table.expect_no_failure();
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

TEST_F(Lights, MirrorShowsALampWithFresnel) {
    // 45 degrees: F = F0 + (1 - F0)(1 - cos)^5.
    SceneBuilder builder;
    builder.quad({-0.2f, 0, 0.2f}, {0.4f, 0, 0}, {0, 0, -0.4f},
                 builder.material(metal(Rgb(0.9f, 0.5f, 0), 0)));
    builder.quad({-3, 0, -1}, {0, 0, 2}, {0, 3, 0}, builder.material(matte(Rgb(0), Rgb(2))));
    builder.quad({-3, 0, 1}, {0, 0, -2}, {0, 3, 0}, builder.material(matte(Rgb(0), Rgb(2))));
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

}  // namespace
}  // namespace obscura::test
