// SPDX-License-Identifier: Apache-2.0
// The stage obscurance at points inside spheres, where every distance is known: values, misses, panes, and results
// only where a point belongs.
#include "scene/material.h"
#include "support/device.h"
#include "support/kernel_queue.h"
#include "support/scene_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace obscura {
namespace {

constexpr uint32_t K = 4;
const Rgb REFLECTIVITY(0.2f, 0.5f, 0.8f);

// A closed sphere of radius 1 about the origin; its facets lie within 1e-3 of it.
test::SceneBuilder sphere() {
    test::SceneBuilder builder;
    builder.sphere({0, 0, 0}, 1, 4, builder.material(test::matte(REFLECTIVITY, Rgb(1))), true);
    return builder;
}

RenderSettings settings_with(double d_max) {
    RenderSettings settings;
    settings.width = settings.height = 8;
    settings.obscurance_rays = K;
    settings.falloff = {FalloffKind::linear, 1};
    settings.d_max = {d_max, MaxDistance::Unit::metres};
    return settings;
}

class ObscuranceStage : public test::DeviceTest {
  protected:
    test::StageBench bench(uint32_t capacity, double d_max, const Scene& scene = sphere().finish()) {
        test::StageBench bench(device(), scene, settings_with(d_max), capacity);
        for (uint32_t slot = 0; slot < capacity; ++slot)
            bench.start_path(slot, 77 + slot, slot % 8);
        return bench;
    }
    static void add_point(test::StageBench& bench, uint32_t slot, const V3f& position) {
        const uint32_t item = bench.counters[COUNT_POINTS]++;
        bench.points().at(POINT_POSITION, item) = test::lane_of(position, test::as_float(slot));
        bench.points().at(POINT_NORMAL, item) = {0, 0, 1, 1e-6f};
        bench.points().at(POINT_SHADING, item) = {0, 0, 1, 0};
    }
    static f32x4 result(test::StageBench& bench, uint32_t slot, uint32_t k) {
        return bench.results().at(0, slot * K + k);
    }
};

TEST_F(ObscuranceStage, OccluderGivesReflectivityTimesFalloff) {
    test::StageBench wave = bench(1, 2);
    add_point(wave, 0, {0, 0, 0});
    wave.run_obscurance(0);
    for (uint32_t k = 0; k < K; ++k) {
        const f32x4 w = result(wave, 0, k);
        EXPECT_NEAR(w.w, 0.5f, 1e-3f) << "rho(1 m / 2 m) of the linear falloff";
        EXPECT_LT((test::xyz_of(w) - w.w * REFLECTIVITY).length(), 1e-6f);
    }
    EXPECT_TRUE(wave.guards_untouched()) << "one slot, K results: exactly full";
}

TEST_F(ObscuranceStage, OpenDirectionsGiveTheAverageReflectivity) {
    test::StageBench wave = bench(1, 0.5);
    add_point(wave, 0, {0, 0, 0});
    wave.run_obscurance(0);
    for (uint32_t k = 0; k < K; ++k) {
        const f32x4 expected{wave.frame.miss.x, wave.frame.miss.y, wave.frame.miss.z, 1};
        EXPECT_EQ(test::bits(result(wave, 0, k)), test::bits(expected));
    }
}

// From P = (0, 0, -0.25) with an offset of 0.25, rays start at the centre, 1 m from the sphere; but P is sqrt(1 + 0.25^2)
// = 1.03 m (sideways) to 1.25 m (straight up) away from what they meet.
TEST_F(ObscuranceStage, DistancesCountFromThePoint) {
    const auto from_below = [&](double d_max) {
        test::StageBench wave = bench(1, d_max);
        add_point(wave, 0, {0, 0, -0.25f});
        wave.points().at(POINT_NORMAL, 0).w = 0.25f;
        wave.run_obscurance(0);
        return wave;
    };
    test::StageBench short_reach = from_below(1.02);
    test::StageBench long_reach = from_below(2);
    for (uint32_t k = 0; k < K; ++k) {
        EXPECT_EQ(result(short_reach, 0, k).w, 1) << "out of reach";
        EXPECT_GT(result(long_reach, 0, k).w, 0.514f);
        EXPECT_LT(result(long_reach, 0, k).w, 0.626f);
    }
}

// In a scene of huge coordinates the offset of the rays exceeds d_max: nothing is left of them to trace.
TEST_F(ObscuranceStage, RaysThatStartBeyondTheReachAreOpen) {
    test::StageBench wave = bench(1, 0.5);
    add_point(wave, 0, {0, 0, -5});
    wave.points().at(POINT_NORMAL, 0).w = 4.75f;
    wave.run_obscurance(0);
    for (uint32_t k = 0; k < K; ++k)
        EXPECT_EQ(result(wave, 0, k).w, 1);
    EXPECT_EQ(wave.counters[STATUS_CODE], STATUS_OK);
    EXPECT_TRUE(wave.guards_untouched());
}

TEST_F(ObscuranceStage, DirectionsDependOnPathDepthAndK) {
    test::StageBench wave = bench(4, 2);
    for (uint32_t slot = 0; slot < 4; ++slot)
        add_point(wave, slot, {0.5f, 0, 0});
    std::set<uint32_t> values;
    for (const uint32_t depth : {0u, 1u}) {
        wave.run_obscurance(depth);
        for (uint32_t slot = 0; slot < 4; ++slot)
            for (uint32_t k = 0; k < K; ++k)
                values.insert(test::bits(result(wave, slot, k).w));
    }
    EXPECT_EQ(values.size(), 2 * 4 * K) << "no direction twice";
}

TEST_F(ObscuranceStage, WritesOnlyTheSlotsOfCountedPoints) {
    test::StageBench wave = bench(6, 2);
    add_point(wave, 4, {0, 0, 0});
    add_point(wave, 1, {0, 0, 0});
    add_point(wave, 3, {0, 0, 0});
    --wave.counters[COUNT_POINTS];  // the third doesn't count
    wave.run_obscurance(0);
    for (uint32_t slot = 0; slot < 6; ++slot) {
        for (uint32_t k = 0; k < K; ++k)
            EXPECT_EQ(wave.results().untouched(0, slot * K + k), slot != 4 && slot != 1) << "slot " << slot;
    }
    EXPECT_EQ(wave.counters[COUNT_POINTS], 2U);
    EXPECT_EQ(wave.counters[STATUS_CODE], STATUS_OK);
}

// Half-way to the sphere stands a clear pane: what it lets pass meets the sphere, the rest ends at the pane.
TEST_F(ObscuranceStage, PanesDimWhatLiesBehind) {
    Material clear = test::matte(Rgb(0.5f, 0.75f, 1));
    clear.transmission = 1;
    test::SceneBuilder builder = sphere();
    builder.sphere({0, 0, 0}, 0.5f, 4, builder.material(clear), true);
    test::StageBench wave = bench(1, 2, builder.finish());
    add_point(wave, 0, {0, 0, 0});
    wave.run_obscurance(0);
    const V3d passed = (1 - pane_reflectance(1)) * V3d(clear.base_color);
    const double mean_passed = (passed.x + passed.y + passed.z) / 3;
    for (uint32_t k = 0; k < K; ++k) {
        const f32x4 w = result(wave, 0, k);
        // The pane reflects nothing diffusely.
        EXPECT_LT((V3d(test::xyz_of(w)) - 0.5 * passed * V3d(REFLECTIVITY)).length(), 2e-3);
        EXPECT_NEAR(static_cast<double>(w.w), 0.25 * (1 - mean_passed) + 0.5 * mean_passed, 2e-3);
    }
}

// Up to sixteen panes let pass what lies behind them, the sphere or open space; the next one is a wall.
TEST_F(ObscuranceStage, SixteenPanesArePassed) {
    Material clear = test::matte(Rgb(1));
    clear.transmission = 1;
    const double passed = 1 - pane_reflectance(1);
    for (const int count : {15, 16, 17}) {
        test::SceneBuilder builder = sphere();
        const uint32_t pane = builder.material(clear);
        const auto radius = [](int i) { return 0.1f + 0.02f * static_cast<float>(i); };
        for (int i = 0; i < count; ++i)
            builder.sphere({0, 0, 0}, radius(i), 3, pane, true);
        const Scene scene = builder.finish();
        for (const double d_max : {2.0, 0.5}) {
            test::StageBench wave = bench(1, d_max, scene);
            add_point(wave, 0, {0, 0, 0});
            wave.run_obscurance(0);
            double w = 0, through = 1;
            for (int i = 0; i < count; ++i) {
                const double share = i < 16 ? passed : 0;
                w += through * (1 - share) * static_cast<double>(radius(i)) / d_max;
                through *= share;
            }
            w += through * std::min(1 / d_max, 1.0);
            const Rgb behind = d_max > 1 ? REFLECTIVITY / 2.0f : test::xyz_of(wave.frame.miss);
            for (uint32_t k = 0; k < K; ++k) {
                EXPECT_NEAR(static_cast<double>(result(wave, 0, k).w), w, 3e-3) << count << " panes";
                EXPECT_LT((V3d(test::xyz_of(result(wave, 0, k))) - through * V3d(behind)).length(), 3e-3);
            }
        }
    }
}

// Of the step only light that meets nothing opaque within d_max comes back, dimmed by the panes on its way: from the kernel
// of every falloff and from its own, with colours and without.
TEST_F(ObscuranceStage, StepLetsPassWhatOnlyPanesAreInTheWayOf) {
    Material clear = test::matte(Rgb(0.5f, 0.75f, 1));
    clear.transmission = 1;
    test::SceneBuilder builder = sphere();
    builder.sphere({0, 0, 0}, 0.5f, 4, builder.material(clear), true);
    const Scene scene = builder.finish();
    const V3d passed = (1 - pane_reflectance(1)) * V3d(clear.base_color);
    const double mean_passed = (passed.x + passed.y + passed.z) / 3;
    for (const char* options : {"", "-D NEED_FALLOFF_STEP=1 -D NEED_TRANSMISSION=1",
                                "-D NEED_FALLOFF_STEP=1 -D NEED_TRANSMISSION=1 -D NEED_BLEEDING=1"}) {
        for (const auto& [d_max, share] : {std::pair{0.4, 0}, {0.75, 1}, {2.0, 2}}) {
            SCOPED_TRACE(fmt::format("{} d_max {}", options, d_max));
            test::StageBench wave = bench(1, d_max, scene);
            wave.frame.lights.z = FALLOFF_STEP;
            if (*options != '\0') wave.kernel_options = options;
            add_point(wave, 0, {0, 0, 0});
            wave.run_obscurance(0);
            const V3d miss(test::xyz_of(wave.frame.miss));
            const V3d expected = share == 0 ? miss : share == 1 ? passed * miss : V3d(0);
            const double colourless = share == 0 ? 1 : share == 1 ? mean_passed : 0;
            for (uint32_t k = 0; k < K; ++k) {
                const f32x4 w = result(wave, 0, k);
                EXPECT_LT((V3d(test::xyz_of(w)) - expected).length(), 2e-3);
                EXPECT_NEAR(static_cast<double>(w.w), colourless, 2e-3);
            }
        }
    }
}

TEST_F(ObscuranceStage, UnlitOccludersBleedNoColour) {
    Material picture = test::matte(REFLECTIVITY);
    picture.transmission = 0.5f;
    picture.unlit = true;
    test::SceneBuilder builder;
    builder.sphere({0, 0, 0}, 1, 4, builder.material(picture), true);
    test::StageBench wave = bench(1, 2, builder.finish());
    add_point(wave, 0, {0, 0, 0});
    wave.run_obscurance(0);
    for (uint32_t k = 0; k < K; ++k) {
        EXPECT_EQ(test::xyz_of(result(wave, 0, k)), V3f(0));
        EXPECT_NEAR(result(wave, 0, k).w, 0.5f, 1e-3f);
    }
}

}  // namespace
}  // namespace obscura
