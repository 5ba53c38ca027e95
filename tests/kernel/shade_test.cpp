// SPDX-License-Identifier: Apache-2.0
// The stage shade at single hits: what it appends, what it leaves in the path slot, and exactly full queues.
#include "support/device.h"
#include "support/kernel_queue.h"
#include "support/scene_builder.h"

#include <cmath>
#include <numbers>
#include <set>

namespace obscura {
namespace {

const Rgb GREY(0.5f, 0.25f, 0.125f);
const Rgb GOLD(0.9f, 0.6f, 0.3f);
const Rgb LAMP(4, 5, 6);
const V3f BULB(0, 2, 0);  // a point light above the floor
const Rgb BULB_INTENSITY(8, 16, 24);
const V3f DOWN(0, -1, 0);

// In the plane y = 0, seen from above: a matte floor for x in [-1, 1], a mirror for x in [2, 4], a lamp that shines
// upwards for x in [5, 6] and an unlit square for x in [7, 8]; all for z in [-1, 0].
Scene tiles() {
    test::SceneBuilder builder;
    Material unlit = test::matte(GOLD);
    unlit.unlit = true;
    const auto tile = [&](float x, float width, const Material& material) {
        builder.quad({x, 0, 0}, {width, 0, 0}, {0, 0, -1}, builder.material(material));
    };
    tile(-1, 2, test::matte(GREY));
    tile(2, 2, test::metal(GOLD, 0));
    tile(5, 1, test::matte(Rgb(0), LAMP));
    tile(7, 1, unlit);
    PunctualLight bulb;
    bulb.intensity = BULB_INTENSITY;
    bulb.position = BULB;
    builder.light(bulb);
    return builder.finish();
}

constexpr float FLOOR = 0, MIRROR = 3, LIT = 5.5f, UNLIT = 7.5f, NOTHING = 20;  // x of the tiles' middles

class ShadeStage : public test::DeviceTest {
  protected:
    // One ray per entry, straight down from y = 3 in the middle of the tile, traced; item i has the slot n - 1 - i.
    test::StageBench bench(const std::vector<float>& tile_x, const V3f& direction = DOWN) {
        RenderSettings settings;
        settings.width = settings.height = 8;
        settings.max_depth = 3;
        settings.background = Rgb(0.1f, 0.2f, 0.3f);
        const auto count = static_cast<uint32_t>(tile_x.size());
        test::StageBench bench(device(), tiles(), settings, count,
                               {LAYER_POSITION, LAYER_NORMAL, LAYER_SHADING, LAYER_ALBEDO});
        for (uint32_t i = 0; i < count; ++i) {
            const uint32_t slot = count - 1 - i;
            bench.start_path(slot, 100 + slot, slot % settings.spp);
            const V3f target(tile_x[i], 0, -0.5f);
            bench.set_ray(i, slot, target - 3.0f * direction, direction);
        }
        bench.run_trace(count, 0);
        return bench;
    }
    static V3f layer(test::StageBench& bench, uint32_t layer, uint32_t slot) {
        return test::xyz_of(bench.layer(layer, slot));
    }
    static void expect_no_light_samples(test::StageBench& bench, uint32_t slot) {
        for (uint32_t sample = 0; sample < bench.light_samples; ++sample) {
            EXPECT_EQ(test::xyz_of(bench.contribution(sample, 0, slot)), V3f(0));
            EXPECT_EQ(test::xyz_of(bench.contribution(sample, 1, slot)), V3f(0));
        }
        EXPECT_EQ(bench.paths().at(PATH_AMBIENT, slot).w, 0);
    }
    static void expect_appended(const test::StageBench& bench, uint32_t rays, uint32_t shadows,
                                uint32_t points) {
        EXPECT_EQ(bench.counters[COUNT_RAYS], rays);
        EXPECT_EQ(bench.counters[COUNT_SHADOWS], shadows);
        EXPECT_EQ(bench.counters[COUNT_POINTS], points);
        EXPECT_EQ(bench.counters[STATUS_CODE], STATUS_OK);
    }
};

TEST_F(ShadeStage, MissAddsTheSkyAndEndsThePath) {
    test::StageBench wave = bench({NOTHING});
    wave.paths().at(PATH_THROUGHPUT, 0) = {1, 0.5f, 2, 0};
    wave.run_shade(1, 0);
    EXPECT_EQ(layer(wave, LAYER_EMISSION, 0), V3f(0.1f, 0.1f, 0.6f));
    EXPECT_EQ(wave.layer(LAYER_EMISSION, 0).w, 0) << "not covered";
    expect_no_light_samples(wave, 0);
    expect_appended(wave, 0, 0, 0);
    EXPECT_TRUE(wave.shadow_rays().untouched(SHADOW_ORIGIN, 0));
    EXPECT_TRUE(wave.points().untouched(POINT_POSITION, 0));
    EXPECT_TRUE(wave.next_rays().untouched(RAY_ORIGIN, 0));
}

TEST_F(ShadeStage, MissAtTheFirstDepthLeavesNothingOfAnotherWave) {
    test::StageBench wave = bench({NOTHING});
    for (const int old : {LAYER_EMISSION, LAYER_POSITION, LAYER_NORMAL, LAYER_SHADING, LAYER_ALBEDO})
        wave.layer(static_cast<uint32_t>(old), 0) = {7, 8, 9, 1};
    wave.run_shade(1, 0);
    EXPECT_EQ(test::bits(wave.layer(LAYER_EMISSION, 0)), test::bits(f32x4{0.1f, 0.2f, 0.3f, 0}));
    for (const int old : {LAYER_POSITION, LAYER_NORMAL, LAYER_SHADING, LAYER_ALBEDO})
        EXPECT_EQ(test::bits(wave.layer(static_cast<uint32_t>(old), 0)), test::bits(f32x4{}))
            << "layer " << old;
}

TEST_F(ShadeStage, LampIsSeenFromItsFront) {
    test::StageBench wave = bench({LIT});
    wave.run_shade(1, 0);
    EXPECT_EQ(layer(wave, LAYER_EMISSION, 0), LAMP);
    EXPECT_EQ(wave.layer(LAYER_EMISSION, 0).w, 1) << "covered";
    test::StageBench from_below = bench({LIT}, -DOWN);
    from_below.run_shade(1, 0);
    EXPECT_EQ(layer(from_below, LAYER_EMISSION, 0), V3f(0)) << "one-sided";
}

TEST_F(ShadeStage, LampInAMirrorGoesToTheSpecularLayer) {
    test::StageBench wave = bench({LIT});
    wave.paths().at(PATH_THROUGHPUT, 0) = {0.5f, 0.5f, 0.5f, 0};  // pdf 0: by way of a mirror
    wave.run_shade(1, 1);
    EXPECT_EQ(layer(wave, LAYER_SPECULAR_EMISSION, 0), 0.5f * LAMP);
    EXPECT_EQ(layer(wave, LAYER_EMISSION, 0), V3f(0));
    EXPECT_EQ(layer(wave, LAYER_POSITION, 0), V3f(0)) << "the first hit was elsewhere";
}

TEST_F(ShadeStage, UnlitSurfaceShowsItsColourAndEnds) {
    test::StageBench wave = bench({UNLIT});
    wave.run_shade(1, 0);
    EXPECT_EQ(layer(wave, LAYER_EMISSION, 0), GOLD);
    expect_no_light_samples(wave, 0);
    expect_appended(wave, 0, 0, 0);
}

TEST_F(ShadeStage, MatteFloorAsksTheBulbAndItsSurroundings) {
    test::StageBench wave = bench({FLOOR});
    wave.run_shade(1, 0);
    // R / pi I cos / d^2 of the bulb at (0, 2, 0) from (0, 0, -0.5); the lamp beside shines upwards.
    const double d2 = 4 + 0.25;
    const double geometry = 2 / std::sqrt(d2) / d2 * std::numbers::inv_pi;
    const uint32_t bulb_sample = 1;  // the area-light group comes first
    const V3d seen(test::xyz_of(wave.contribution(bulb_sample, 0, 0)));
    EXPECT_LT((seen - geometry * V3d(GREY) * V3d(BULB_INTENSITY)).length(), 1e-6);
    EXPECT_EQ(test::xyz_of(wave.contribution(0, 0, 0)), V3f(0));
    expect_appended(wave, 0, 1, 1);

    const f32x4 origin = wave.shadow_rays().at(SHADOW_ORIGIN, 0);
    const f32x4 to_light = wave.shadow_rays().at(SHADOW_DIRECTION, 0);
    EXPECT_EQ(test::bits(origin.w), bulb_sample * wave.capacity + 0);
    EXPECT_EQ(to_light.w, 1);
    EXPECT_GT(origin.y, 0) << "lifted off the floor";
    EXPECT_LT(origin.y, 1e-5f);
    EXPECT_LT((test::xyz_of(origin) + test::xyz_of(to_light) - BULB).length(), 1e-6f);

    const f32x4 point = wave.points().at(POINT_POSITION, 0);
    EXPECT_LT((test::xyz_of(point) - V3f(0, 0, -0.5f)).length(), 1e-6f);
    EXPECT_EQ(test::bits(point.w), 0U);
    EXPECT_EQ(test::xyz_of(wave.points().at(POINT_NORMAL, 0)), V3f(0, 1, 0));
    EXPECT_GT(wave.points().at(POINT_NORMAL, 0).w, 0);
    EXPECT_EQ(test::xyz_of(wave.points().at(POINT_SHADING, 0)), V3f(0, 1, 0));
    const f32x4 ambient = wave.paths().at(PATH_AMBIENT, 0);
    EXPECT_EQ(ambient.w, AMBIENT_TRACED);
    const V3f intensity = test::xyz_of(wave.frame.ambient);
    EXPECT_LT((test::xyz_of(ambient) - GREY * intensity).length(), 1e-6f * intensity.length());
}

TEST_F(ShadeStage, FirstHitIsDescribed) {
    test::StageBench wave = bench({FLOOR}, V3f(0.6f, -0.8f, 0));
    wave.run_shade(1, 0);
    EXPECT_LT((layer(wave, LAYER_POSITION, 0) - V3f(0, 0, -0.5f)).length(), 1e-6f);
    EXPECT_EQ(layer(wave, LAYER_NORMAL, 0), V3f(0, 1, 0));
    EXPECT_EQ(layer(wave, LAYER_SHADING, 0), V3f(0, 1, 0));
    EXPECT_EQ(layer(wave, LAYER_ALBEDO, 0), GREY);
}

// The back of the floor: the normals turn to the viewer, and the bulb is on the other side.
TEST_F(ShadeStage, BackSideIsShadedWithoutTheLightsOfTheFront) {
    test::StageBench wave = bench({FLOOR}, -DOWN);
    wave.run_shade(1, 0);
    EXPECT_EQ(layer(wave, LAYER_NORMAL, 0), V3f(0, -1, 0));
    expect_appended(wave, 0, 0, 1);
    EXPECT_EQ(test::xyz_of(wave.points().at(POINT_NORMAL, 0)), V3f(0, -1, 0));
}

TEST_F(ShadeStage, MirrorSendsTheRayOnAndHasNoDiffuseLight) {
    test::StageBench wave = bench({MIRROR}, V3f(0.6f, -0.8f, 0));
    wave.run_shade(1, 0);
    expect_appended(wave, 1, 0, 0);
    EXPECT_EQ(wave.paths().at(PATH_AMBIENT, 0).w, 0);
    const f32x4 origin = wave.next_rays().at(RAY_ORIGIN, 0);
    EXPECT_EQ(test::bits(origin.w), 0U);
    EXPECT_LT((test::xyz_of(origin) - V3f(3, 0, -0.5f)).length(), 1e-5f);
    EXPECT_GT(origin.y, 0);
    EXPECT_LT((test::xyz_of(wave.next_rays().at(RAY_DIRECTION, 0)) - V3f(0.6f, 0.8f, 0)).length(), 1e-6f);
    const f32x4 throughput = wave.paths().at(PATH_THROUGHPUT, 0);
    const V3f fresnel = GOLD + (V3f(1) - GOLD) * std::pow(0.2f, 5.0f);  // Schlick at cos = 0.8
    EXPECT_LT((test::xyz_of(throughput) - fresnel).length(), 1e-6f);
    EXPECT_EQ(throughput.w, 0) << "no density";
    EXPECT_TRUE(wave.next_rays().untouched(RAY_HIT, 0)) << "trace writes it";
}

TEST_F(ShadeStage, LastDepthSendsNothingOn) {
    test::StageBench wave = bench({MIRROR});
    wave.run_shade(1, 3);
    expect_appended(wave, 0, 0, 0);
}

// Every path appends what it may: the queues are exactly full, each slot is there once.
TEST_F(ShadeStage, ExactlyFullQueuesHoldEverySlotOnce) {
    constexpr uint32_t COUNT = 100;
    test::StageBench floor = bench(std::vector<float>(COUNT, FLOOR));
    floor.run_shade(COUNT, 0);
    expect_appended(floor, 0, COUNT, COUNT);
    std::set<uint32_t> points, results;
    for (uint32_t i = 0; i < COUNT; ++i) {
        points.insert(test::bits(floor.points().at(POINT_POSITION, i).w));
        results.insert(test::bits(floor.shadow_rays().at(SHADOW_ORIGIN, i).w));
    }
    EXPECT_EQ(points.size(), COUNT);
    EXPECT_EQ(*points.rbegin(), COUNT - 1);
    EXPECT_EQ(results.size(), COUNT);
    EXPECT_EQ(*results.begin(), COUNT) << "the samples of the second group";
    EXPECT_EQ(*results.rbegin(), 2 * COUNT - 1);
    EXPECT_TRUE(floor.guards_untouched());

    test::StageBench mirror = bench(std::vector<float>(COUNT, MIRROR));
    mirror.run_shade(COUNT, 0);
    expect_appended(mirror, COUNT, 0, 0);
    std::set<uint32_t> rays;
    for (uint32_t i = 0; i < COUNT; ++i)
        rays.insert(test::bits(mirror.next_rays().at(RAY_ORIGIN, i).w));
    EXPECT_EQ(rays.size(), COUNT);
    EXPECT_TRUE(mirror.guards_untouched());
}

TEST_F(ShadeStage, AppendsToWhatTheQueuesHold) {
    test::StageBench wave = bench({FLOOR, MIRROR, FLOOR, MIRROR, NOTHING, LIT});
    wave.counters[COUNT_POINTS] = 2;
    wave.counters[COUNT_SHADOWS] = 1;
    wave.counters[COUNT_RAYS] = 3;
    wave.run_shade(6, 0);
    expect_appended(wave, 5, 3, 4);
    for (uint32_t i = 0; i < 6; ++i) {
        EXPECT_EQ(wave.points().untouched(POINT_POSITION, i), i < 2 || i >= 4) << i;
        EXPECT_EQ(wave.next_rays().untouched(RAY_ORIGIN, i), i < 3 || i >= 5) << i;
        EXPECT_EQ(wave.shadow_rays().untouched(SHADOW_ORIGIN, i), i < 1 || i >= 3) << i;
    }
}

TEST_F(ShadeStage, ItemsBeyondTheCountStay) {
    test::StageBench wave = bench({FLOOR, FLOOR, FLOOR});
    wave.paths().at(PATH_AMBIENT, 0) = test::canary();
    wave.run_shade(2, 0);  // slots 2 and 1
    expect_appended(wave, 0, 2, 2);
    EXPECT_TRUE(wave.paths().untouched(PATH_AMBIENT, 0));
}

}  // namespace
}  // namespace obscura
