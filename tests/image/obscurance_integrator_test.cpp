// SPDX-License-Identifier: Apache-2.0
// The reference renderer's model of obscurances by itself: closed forms of W and of the furnace. Needs no device.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "scene/material.h"
#include "scene/radiometry.h"
#include "support/busy_room.h"
#include "support/lit_point.h"
#include "support/reference_picture.h"
#include "support/sphere_facet.h"
#include "support/statistics.h"

namespace obscura::test {
namespace {

// Every pixel sees the same point; its ambient light is R W for an ambient light of 1.
RenderSettings ambient_settings(const Falloff& falloff) {
    RenderSettings settings = picture(8, 8, 16, 64);
    settings.falloff = falloff;
    settings.ambient_light = Rgb(1);
    settings.bleeding = false;
    return settings;
}

// W under a parallel plane at 1/4 of d_max.
struct PlaneCase {
    Falloff falloff;
    double w;
};
const std::vector<PlaneCase> PLANE_CASES{{{FalloffKind::step, 1}, 0.0625},
                                         {{FalloffKind::linear, 1}, 0.4375},
                                         {{FalloffKind::sqrt, 1}, 0.645833333},
                                         {{FalloffKind::exp, 1}, 0.540008981}};

Scene floor_under_plane(const Rgb& plane) {
    SceneBuilder builder = floor_scene(matte(Rgb(0.5f)));
    builder.quad({-3, 0.25f, -3}, {6, 0, 0}, {0, 0, 6}, builder.material(matte(plane)));
    Scene scene = builder.finish();
    SceneBuilder below;
    below.camera({0.1, 0.2, 0}, {0, 0, 0}, POINT_FOV);  // between the two
    scene.cameras = below.finish().cameras;
    return scene;
}

TEST(ObscuranceIntegrator, PlaneObscuresAsItsClosedForm) {
    const Scene scene = floor_under_plane(Rgb(0.8f));
    ZTable table;
    for (const SamplerKind sampler : {SamplerKind::lattice, SamplerKind::owen, SamplerKind::random}) {
        for (const auto& [falloff, w] : PLANE_CASES) {
            RenderSettings settings = ambient_settings(falloff);
            settings.sampler = sampler;
            if (sampler == SamplerKind::random) settings.spp = 512;
            table.add(fmt::format("{}, sampler {}", falloff_text(falloff), static_cast<int>(sampler)),
                      channel(obscurance_picture(scene, settings), "ambient", 0), 0.5 * w, 0.5 * w, 1e-7);
        }
    }
    table.expect_no_failure();
    table.expect_one_percent_matters();
}

// Equation 6: W = R_Q (W_rho - W_AO) + R_ave W_AO for occluders of one colour.
TEST(ObscuranceIntegrator, BleedingTakesTheOccludersColour) {
    const Rgb color(0.8f, 0.4f, 0.1f);
    const Scene scene = floor_under_plane(color);
    RenderSettings settings = ambient_settings(PLANE_CASES[2].falloff);
    settings.bleeding = true;
    const Radiometry radiometry = compute_radiometry(scene);
    const Image image = obscurance_picture(scene, settings);
    ZTable table;
    for (int c = 0; c < 3; ++c) {
        const double r_ave = radiometry.average_reflectivity[c];
        const double w_step = PLANE_CASES[0].w;
        const double w = static_cast<double>(color[c]) * (PLANE_CASES[2].w - w_step) + r_ave * w_step;
        const double expected = 0.5 * w / r_ave;  // the ambient light of 1 is that of an open point
        table.add(fmt::format("channel {}", c), channel(image, "ambient", static_cast<size_t>(c)), expected,
                  expected, 1e-7);
    }
    table.expect_no_failure();
    table.expect_one_percent_matters();
}

// The plane is a pane: directions that pass it are dimmed, and open.
TEST(ObscuranceIntegrator, PanesDimWhatIsBehindThem) {
    Scene scene = floor_under_plane(Rgb(1));
    Material& pane = scene.materials[1];
    pane.transmission = 1;
    ZTable table;
    // 2 int (T + (1 - T) rho(1 / 4 mu)) mu dmu, T = 1 - P(mu); rho is 1 beyond mu = 1/4.
    const double linear = [] {
        constexpr int STEPS = 100000;
        double sum = 0;
        for (int i = 0; i < STEPS; ++i) {
            const double mu = (i + 0.5) / STEPS;
            const double rho = std::min(1.0, 0.25 / mu);
            sum += 2 * mu * (1 - pane_reflectance(mu) * (1 - rho)) / STEPS;
        }
        return sum;
    }();
    table.add("linear",
              channel(obscurance_picture(scene, ambient_settings({FalloffKind::linear, 1})), "ambient", 0),
              0.5 * linear, 0.5 * linear, 1e-6);
    table.expect_no_failure();
    table.expect_one_percent_matters();
}

// E (1 + R + R^2 / (1 - R) W), with bleeding and without.
TEST(ObscuranceIntegrator, FurnaceEqualsItsClosedForm) {
    constexpr double R = 0.8;
    Scene scene = furnace_sphere(Rgb(static_cast<float>(R)), Rgb(1), 1, 4);
    const SphereFacet facet = find_facet(scene, V3d(0.4, 0.3, -0.85));
    SceneBuilder camera;
    camera.camera(V3d(0, 0, 0), facet.foot, 1e-6);
    scene.cameras = camera.finish().cameras;
    ZTable table;
    for (const auto& [falloff, ignored] : PLANE_CASES) {
        for (const double d_max : {1.0, 2.0, 4.0}) {
            for (const bool bleeding : {true, false}) {
                RenderSettings settings = picture(4, 4, 4, 256);
                settings.light_samples = 16;
                settings.falloff = falloff;
                settings.d_max.value = d_max;
                settings.bleeding = bleeding;
                const Bracket w = facet_obscurance(facet, falloff, d_max);
                const double bounced = R * R / (1 - R);
                table.add(fmt::format("{}, d_max {}, bleeding {}", falloff_text(falloff), d_max, bleeding),
                          channel(obscurance_picture(scene, settings), "", 0), 1 + R + bounced * w.low,
                          1 + R + bounced * w.high, 1e-5);
            }
        }
    }
    table.expect_no_failure();
    table.expect_one_percent_matters();
}

TEST(ObscuranceIntegrator, OnePercentMoreAmbientLightIsDetected) {
    RenderSettings settings = ambient_settings(PLANE_CASES[3].falloff);
    settings.ambient_scale = 1.01;
    ZTable table;
    table.add("exp", channel(obscurance_picture(floor_under_plane(Rgb(0.8f)), settings), "ambient", 0),
              0.5 * PLANE_CASES[3].w, 0.5 * PLANE_CASES[3].w, 1e-7);
    EXPECT_FALSE(table.failures().empty());
}

// The room without diffuse reflection: what is left are lights, mirrors, rough metal and panes, which the path tracer
// follows in another way.
TEST(ObscuranceIntegrator, ReflectionsAreThoseOfThePathTracer) {
    Scene scene = busy_room();
    for (Material& material : scene.materials) {
        if (material.unlit || material.transmission > 0 || material.metallic > 0) continue;
        material.base_color = Rgb(0);
    }
    RenderSettings settings = picture(16, 12, 384);
    settings.max_depth = 40;
    settings.background = Rgb(0.3f);
    constexpr uint64_t SEEDS = 16;
    std::vector<std::vector<double>> differences(16 * 12);
    std::vector<double> ratios;  // of the whole picture
    for (settings.seed = 0; settings.seed < SEEDS; ++settings.seed) {
        const std::vector<double> model = channel(obscurance_picture(scene, settings), "", 0);
        RenderSettings other = settings;
        other.seed += 1000;
        const std::vector<double> paths = channel(path_picture(scene, other), "", 0);
        for (size_t pixel = 0; pixel < differences.size(); ++pixel)
            differences[pixel].push_back(model[pixel] - paths[pixel]);
        ratios.push_back(estimate(model).mean / estimate(paths).mean);
    }
    ZTable pixels, picture_ratio;
    for (size_t pixel = 0; pixel < differences.size(); ++pixel)
        pixels.add(fmt::format("pixel {}", pixel), differences[pixel], 0, 0, 1e-6);
    pixels.expect_no_failure();
    picture_ratio.add("the whole picture", ratios, 1, 1, 1e-6);
    picture_ratio.expect_no_failure();
    picture_ratio.expect_one_percent_matters();
}

}  // namespace
}  // namespace obscura::test
