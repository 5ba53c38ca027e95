// SPDX-License-Identifier: Apache-2.0
// Where the obscurance W has no variance it is exact for every sampler: nothing near, one distance all around. And what
// holds ray by ray holds for pictures: longer reach, darker falloffs, scaled scenes.
#include <gtest/gtest.h>

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

TEST_F(ExactObscurance, LoneSmoothConvexMeshIsOpenExactly) {
    SceneBuilder builder;
    builder.sphere({0.3f, 0, 0}, 1, 1, builder.material(matte(COLOR)), false, true);
    builder.camera(V3d(0, 0, 3), V3d(0.3, 0, 0));
    expect_open_everywhere(builder.finish(), 0.3);
}

// A floor with spheres and a box on it, made of coordinates that a factor of 2^j scales exactly.
Scene clutter(float scale) {
    SceneBuilder builder;
    const uint32_t material = builder.material(matte(COLOR));
    builder.quad(scale * V3f(-3, 0, 3), scale * V3f(6, 0, 0), scale * V3f(0, 0, -6), material);
    builder.sphere(scale * V3f(-0.5f, 0.4f, 0), scale * 0.4f, 2, material);
    builder.sphere(scale * V3f(0.5f, 0.3f, 0.3f), scale * 0.3f, 2, material, false, true);
    builder.box(scale * V3f(-0.2f, 0, -1), scale * V3f(0.6f, 0.8f, -0.5f), material);
    const auto s = static_cast<double>(scale);
    builder.camera(s * V3d(0, 2, 3), s * V3d(0, 0.25, 0), 0.6);
    return builder.finish();
}

std::vector<double> clutter_obscurance(const Falloff& falloff, double d_max, float scale = 1) {
    RenderSettings settings = picture(64, 48, 2, 8);
    settings.falloff = falloff;
    settings.sampler = SamplerKind::owen;
    settings.ambient_light = Rgb(1);
    settings.d_max.value = d_max;
    return channel(render(clutter(scale), settings, {"ao"}).image, "ao", 0);
}

// Each value of `lower` is at most that of `upper`, to the rounding of sums of 16 floats; most are less.
void expect_ordered(const std::vector<double>& lower, const std::vector<double>& upper) {
    ASSERT_EQ(lower.size(), upper.size());
    size_t less = 0;
    for (size_t i = 0; i < lower.size(); ++i) {
        EXPECT_LE(lower[i], upper[i] + 1e-6) << "pixel " << i;
        less += lower[i] < upper[i] - 1e-3 ? 1 : 0;
    }
    EXPECT_GT(less, lower.size() / 4);
}

TEST_F(ExactObscurance, LongerReachNeverOpensAPixel) {
    for (const Falloff& falloff : {STEP, LINEAR, SQRT, EXP}) {
        expect_ordered(clutter_obscurance(falloff, 0.8), clutter_obscurance(falloff, 0.4));
        expect_ordered(clutter_obscurance(falloff, 2.5), clutter_obscurance(falloff, 0.8));
    }
}

TEST_F(ExactObscurance, FalloffsAreOrderedForTheSameRays) {
    const std::vector<double> exponential = clutter_obscurance(EXP, 1);
    expect_ordered(clutter_obscurance(STEP, 1), exponential);
    expect_ordered(exponential, clutter_obscurance(SQRT, 1));
}

TEST_F(ExactObscurance, SceneScaledByAPowerOfTwoKeepsEveryBit) {
    const std::vector<double> original = clutter_obscurance(SQRT, 1);
    EXPECT_EQ(clutter_obscurance(SQRT, 0.0625, 0.0625f), original);
    EXPECT_EQ(clutter_obscurance(SQRT, 64, 64), original);
}

}  // namespace
}  // namespace obscura::test
