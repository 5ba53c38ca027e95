// SPDX-License-Identifier: Apache-2.0
// Where the obscurance W has no variance it is exact for every sampler: nothing near, one distance all around. And what
// holds ray by ray holds for pictures: longer reach, darker falloffs, colours.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "reference/oracles.h"
#include "support/falloffs.h"
#include "support/render.h"
#include "support/scene_builder.h"
#include "support/sphere_facet.h"
#include "support/statistics.h"

namespace obscura::test {
namespace {

using ExactObscurance = DeviceTest;

const Rgb COLOR(0.8f, 0.5f, 0.2f);

TEST_F(ExactObscurance, DomeCentreHasNoVariance) {
    SceneBuilder builder;
    const uint32_t material = builder.material(matte(COLOR));
    builder.sphere({0, 0, 0}, 1, 3, material, true);
    const SphereFacet dome = find_facet(SceneBuilder(builder).finish(), V3d(0, 0, 1));
    builder.quad({-0.001f, 0, 0.001f}, {0.002f, 0, 0}, {0, 0, -0.002f}, material);
    builder.camera(V3d(0, 0.5, 0), V3d(0, 0, 0), 1e-6);
    const Scene scene = builder.finish();
    for (const SamplerKind sampler : {SamplerKind::random, SamplerKind::owen, SamplerKind::lattice}) {
        for (const Falloff& falloff : ALL_FALLOFFS) {
            RenderSettings settings = picture(1, 1, 4, 16);
            settings.sampler = sampler;
            settings.falloff = falloff;
            settings.ambient_light = Rgb(1);
            settings.d_max.value = 2;
            for (settings.seed = 0; settings.seed < 4; ++settings.seed) {
                const double w = channel(render(scene, settings, {"ao"}).image, "ao", 0).at(0);
                EXPECT_GE(w, falloff_value(falloff, dome.inner / 2) - 1e-6) << falloff_text(falloff);
                EXPECT_LE(w, falloff_value(falloff, dome.outer / 2) + 1e-6) << falloff_text(falloff);
            }
        }
    }
}

// Colourless W equals the coverage, bit for bit: every ray of every hit is open.
void expect_open_everywhere(const Scene& scene, double least_coverage) {
    for (const SamplerKind sampler : {SamplerKind::random, SamplerKind::owen, SamplerKind::lattice}) {
        for (const Falloff& falloff : {STEP, SQRT}) {
            RenderSettings settings = picture(48, 36, 4, 8);
            settings.sampler = sampler;
            settings.falloff = falloff;
            settings.ambient_light = Rgb(1);
            const RenderResult result = render(scene, settings, {"ao"});
            const std::vector<double> coverage = channel(result.image, "", 3);
            EXPECT_EQ(channel(result.image, "ao", 0), coverage);
            EXPECT_GE(estimate(coverage).mean, least_coverage);
        }
    }
}

// A floor of `strips` quads side by side: slivers where there are many.
Scene floor_in_empty_space(const V3f& corner, const V3f& u, const V3f& v, int strips) {
    SceneBuilder builder;
    const uint32_t material = builder.material(matte(COLOR));
    for (int i = 0; i < strips; ++i) {
        const float from = static_cast<float>(i) / static_cast<float>(strips);
        builder.quad(corner + from * v, u, v / static_cast<float>(strips), material);
    }
    builder.camera(V3d(0, 5, 0), V3d(1, 0, -3));
    return builder.finish();
}

TEST_F(ExactObscurance, FloorInEmptySpaceIsOpenExactly) {
    const V3f right(100, 0, 0), back(0, 0, -100);
    for (const int strips : {1, 16, 256}) {
        expect_open_everywhere(floor_in_empty_space({-50, 0, 50}, right, back, strips), 1);
        expect_open_everywhere(floor_in_empty_space({-50, 0.3f, 50}, right, back, strips), 1);
        expect_open_everywhere(floor_in_empty_space({-50, 0.3f, 50}, {100, 1, 0}, {0, 2, -100}, strips), 1);
        expect_open_everywhere(floor_in_empty_space({-40, -9, 53}, {97, 11, -20}, {17, 13, -101}, strips), 1);
    }
}

// The floor's centre in a closed cube. d < d_max is a hit; d = d_max is none.
std::vector<double> cube_obscurance(float edge, const Falloff& falloff, SamplerKind sampler) {
    SceneBuilder builder;
    const float half = edge / 2;
    builder.box({-half, 0, -half}, {half, edge, half}, builder.material(matte(COLOR)), true);
    builder.camera(V3d(0, static_cast<double>(half), 0), V3d(0, 0, 0), 1e-6);
    RenderSettings settings = picture(4, 4, 16, 64);
    settings.sampler = sampler;
    settings.falloff = falloff;
    settings.ambient_light = Rgb(1);
    return channel(render(builder.finish(), settings, {"ao"}).image, "ao", 0);
}

TEST_F(ExactObscurance, CubeIsOpenOrClosedExactly) {
    for (const SamplerKind sampler : {SamplerKind::random, SamplerKind::owen, SamplerKind::lattice}) {
        for (const Falloff& falloff : ALL_FALLOFFS) {
            for (const float edge : {2.0f, 2.5f})
                EXPECT_EQ(cube_obscurance(edge, falloff, sampler), std::vector<double>(16, 1))
                    << falloff_text(falloff) << ", edge " << edge;
        }
        // Its farthest corner is sqrt(1.5) edges away.
        EXPECT_EQ(cube_obscurance(0.8f, STEP, sampler), std::vector<double>(16, 0));
    }
}

TEST_F(ExactObscurance, LoneSmoothConvexMeshIsOpenExactly) {
    SceneBuilder builder;
    builder.sphere({0.3f, 0, 0}, 1, 1, builder.material(matte(COLOR)), false, true);
    builder.camera(V3d(0, 0, 3), V3d(0.3, 0, 0));
    expect_open_everywhere(builder.finish(), 0.3);
}

// A floor with spheres and a box on it, and a black sheet out of reach.
Scene clutter() {
    SceneBuilder builder;
    const uint32_t material = builder.material(matte(COLOR));
    builder.quad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}, material);
    builder.sphere({-0.5f, 0.4f, 0}, 0.4f, 2, material);
    builder.sphere({0.5f, 0.3f, 0.3f}, 0.3f, 2, material, false, true);
    builder.box({-0.2f, 0, -1}, {0.6f, 0.8f, -0.5f}, material);
    builder.quad({-30, 0, 3}, {6, 0, 0}, {0, 0, -6}, builder.material(matte(Rgb(0))));
    builder.camera({0, 2, 3}, {0, 0.25, 0}, 0.6);
    return builder.finish();
}

RenderSettings clutter_settings(const Falloff& falloff, const MaxDistance& d_max, SamplerKind sampler) {
    RenderSettings settings = picture(64, 48, 2, 8);
    settings.falloff = falloff;
    settings.sampler = sampler;
    settings.ambient_light = Rgb(1);
    settings.d_max = d_max;
    return settings;
}

std::vector<double> clutter_obscurance(const Falloff& falloff, const std::string& d_max,
                                       SamplerKind sampler = SamplerKind::owen) {
    static const Scene scene = clutter();
    const RenderSettings settings = clutter_settings(falloff, parse_max_distance(d_max), sampler);
    return channel(render(scene, settings, {"ao"}).image, "ao", 0);
}

// Of W, which is at most 1: falloffs are off by up to 2 ulp, and the sum of 16 of them by a few.
constexpr double FEW_ULPS = 4 * 0x1p-24;

// Each value of `lower` is at most that of `upper`, and many are less.
void expect_ordered(const std::vector<double>& lower, const std::vector<double>& upper,
                    const std::string& what) {
    ASSERT_EQ(lower.size(), upper.size());
    size_t less = 0;
    double worst = 0;
    for (size_t i = 0; i < lower.size(); ++i) {
        worst = std::max(worst, lower[i] - upper[i]);
        less += lower[i] < upper[i] - 1e-3 ? 1 : 0;
    }
    EXPECT_LE(worst, FEW_ULPS) << what;
    EXPECT_GT(less, lower.size() / 8) << what;
}

TEST_F(ExactObscurance, LongerReachNeverOpensAPixel) {
    for (const Falloff& falloff : ALL_FALLOFFS) {
        std::vector<double> before = clutter_obscurance(falloff, "0.2");
        for (const char* d_max : {"0.4", "0.81", "1.7", "4"}) {
            const std::vector<double> w = clutter_obscurance(falloff, d_max);
            expect_ordered(w, before, fmt::format("{}, d_max {}", falloff_text(falloff), d_max));
            before = w;
        }
    }
}

// The step falloff closes what is hit at all, so that unlimited reach is no darker than one longer than the scene.
TEST_F(ExactObscurance, UnlimitedReachIsTheLimitOfLongOnes) {
    EXPECT_EQ(clutter_obscurance(STEP, "inf"), clutter_obscurance(STEP, "100"));
}

TEST_F(ExactObscurance, FalloffsAreOrderedForTheSameRays) {
    // From below: on [0, 1) each is at least the one before it.
    const std::vector<std::string> ascending{"step", "pow:2", "linear", "exp:0.5",
                                             "exp",  "sqrt",  "cbrt",   "pow:0.25"};
    for (const SamplerKind sampler : {SamplerKind::random, SamplerKind::owen, SamplerKind::lattice}) {
        std::vector<double> before;
        for (const std::string& name : ascending) {
            const std::vector<double> w = clutter_obscurance(parse_falloff(name), "1", sampler);
            if (!before.empty()) expect_ordered(before, w, name);
            before = w;
        }
        expect_ordered(clutter_obscurance(STEP, "1", sampler),
                       clutter_obscurance({FalloffKind::expjump, 1}, "1", sampler), "step, expjump");
        expect_ordered(clutter_obscurance({FalloffKind::expjump, 1}, "1", sampler),
                       clutter_obscurance(LINEAR, "1", sampler), "expjump, linear");
        expect_ordered(clutter_obscurance(EXP, "1", sampler),
                       clutter_obscurance({FalloffKind::exp, 5}, "1", sampler), "exp, exp:5");
    }
}

// Occluders of one colour: W with bleeding is R_Q (W - W_AO) + R_ave W_AO, pixel for pixel, of the same rays.
TEST_F(ExactObscurance, BleedingFollowsFromColourlessObscurance) {
    const Scene scene = clutter();
    for (const SamplerKind sampler : {SamplerKind::random, SamplerKind::owen, SamplerKind::lattice}) {
        const std::vector<double> step = clutter_obscurance(STEP, "1", sampler);
        for (const Falloff& falloff : ALL_FALLOFFS) {
            const RenderSettings settings = clutter_settings(falloff, {}, sampler);
            const RenderResult found = render(scene, settings, {"ao", "obscurance"});
            const RgbD average = found.radiometry.average_reflectivity;
            const std::vector<double> w = channel(found.image, "ao", 0);
            ASSERT_LT(average.x, 0.9 * static_cast<double>(COLOR.x)) << "or the identity says little";
            for (size_t c = 0; c < 3; ++c) {
                const std::vector<double> bled = channel(found.image, "obscurance", c);
                for (size_t i = 0; i < w.size(); ++i) {
                    const RgbD expected = bleeding_obscurance(w[i], step[i], RgbD(COLOR), average);
                    ASSERT_NEAR(bled[i], expected[static_cast<int>(c)], FEW_ULPS)
                        << falloff_text(falloff) << ", pixel " << i << ", channel " << c;
                }
            }
        }
    }
}

}  // namespace
}  // namespace obscura::test
