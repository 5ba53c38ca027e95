// SPDX-License-Identifier: Apache-2.0
// The stage camera: rays through their pixels, path slots in their first state, the same whatever the wave.
#include "support/device.h"
#include "support/kernel_queue.h"
#include "support/scene_builder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>
#include <vector>

namespace obscura {
namespace {

constexpr uint32_t WIDTH = 6, HEIGHT = 4, SPP = 4, PIXELS = WIDTH * HEIGHT, SAMPLES = PIXELS * SPP;
constexpr Wave ALL_SAMPLES{.pixel_count = PIXELS, .pass_count = SPP};
const std::vector<uint32_t> ORDER = tiled_pixel_order(WIDTH, HEIGHT);  // of the pixels in a queue
const V3d EYE(1, 2, 3), TARGET(0, 0.5, -1);

Scene scene_with_camera(bool orthographic = false) {
    test::SceneBuilder builder;
    builder.quad({-1, 0, -1}, {2, 0, 0}, {0, 2, 0}, builder.material(test::matte(Rgb(0.5f))));
    builder.camera(EYE, TARGET, 0.9);
    Scene scene = builder.finish();
    scene.cameras[0].orthographic = orthographic;
    scene.cameras[0].half_height = 0.75;
    return scene;
}

RenderSettings small_settings() {
    RenderSettings settings;
    settings.width = WIDTH;
    settings.height = HEIGHT;
    settings.spp = SPP;
    return settings;
}

// Where a ray passes the picture, in pixels from its upper left corner.
Imath::V2d pixel_position(const Camera& camera, const V3d& origin, const V3d& direction) {
    const M44d to_camera = camera.camera_to_world.inverse();
    V3d from, along;
    to_camera.multVecMatrix(origin, from);
    to_camera.multDirMatrix(direction, along);
    const double half_height = camera.orthographic ? camera.half_height : std::tan(camera.vertical_fov / 2);
    const double half_width = half_height * WIDTH / HEIGHT;
    const double x = camera.orthographic ? from.x : -along.x / along.z;
    const double y = camera.orthographic ? from.y : -along.y / along.z;
    return {(x / half_width + 1) / 2 * WIDTH, (1 - y / half_height) / 2 * HEIGHT};
}

class CameraStage : public test::DeviceTest {
  protected:
    test::StageBench bench(uint32_t capacity, const RenderSettings& settings = small_settings()) {
        return {device(), scene_, settings, capacity};
    }
    Imath::V2d position(test::StageBench& bench, uint32_t slot) const {
        const test::LaneQueue& rays = bench.rays();
        return pixel_position(scene_.cameras[0], V3d(test::xyz_of(rays.at(RAY_ORIGIN, slot))),
                              V3d(test::xyz_of(rays.at(RAY_DIRECTION, slot))));
    }

    Scene scene_ = scene_with_camera();
};

TEST_F(CameraStage, FillsAQueueExactlyWithRaysThroughTheirPixels) {
    test::StageBench wave = bench(SAMPLES);
    wave.run_camera(ALL_SAMPLES);
    for (uint32_t slot = 0; slot < SAMPLES; ++slot) {
        const uint32_t pixel = ORDER[slot / SPP];
        EXPECT_EQ(test::bits(wave.rays().at(RAY_ORIGIN, slot).w), slot);
        EXPECT_EQ(test::xyz_of(wave.rays().at(RAY_ORIGIN, slot)), V3f(EYE));
        EXPECT_NEAR(test::xyz_of(wave.rays().at(RAY_DIRECTION, slot)).length(), 1, 2e-7);
        const Imath::V2d at = position(wave, slot);
        EXPECT_NEAR(at.x, pixel % WIDTH + 0.5, 0.5 + 1e-5) << "slot " << slot;
        EXPECT_NEAR(at.y, pixel / WIDTH + 0.5, 0.5 + 1e-5) << "slot " << slot;
        EXPECT_TRUE(wave.rays().untouched(RAY_HIT, slot));
    }
    EXPECT_TRUE(wave.guards_untouched());
}

TEST_F(CameraStage, StartsPathsAndLeavesTheirLayersAlone) {
    test::StageBench wave = bench(SAMPLES);
    wave.run_camera(ALL_SAMPLES);
    std::set<uint32_t> seeds, samples;
    for (uint32_t slot = 0; slot < SAMPLES; ++slot) {
        EXPECT_EQ(test::bits(wave.paths().at(PATH_THROUGHPUT, slot)), test::bits(f32x4{1, 1, 1, 0}));
        const auto sample = test::bits(wave.paths().at(PATH_SAMPLE, slot));
        EXPECT_EQ(sample[2], ORDER[slot / SPP]);
        EXPECT_EQ(sample[3], 0U) << "flags";
        seeds.insert(sample[0]);
        if (slot / SPP == 5) samples.insert(sample[1]);
        EXPECT_TRUE(wave.paths().untouched(PATH_AMBIENT, slot)) << "shade writes it";
        for (uint32_t layer = 0; layer < BEAUTY_LAYERS; ++layer)
            EXPECT_TRUE(wave.paths().untouched(PATH_LAYERS + layer, slot)) << "layer " << layer;
    }
    EXPECT_EQ(seeds.size(), PIXELS) << "one seed per pixel";
    EXPECT_EQ(samples, (std::set<uint32_t>{0, 1, 2, 3})) << "all samples of a pixel";
}

// Two passes over some pixels, in a wave of their own with more room than they need.
TEST_F(CameraStage, WavesCutTheSamePicture) {
    test::StageBench whole = bench(SAMPLES);
    whole.run_camera(ALL_SAMPLES);
    test::StageBench part = bench(25);
    part.run_camera({.first_pixel = 7, .pixel_count = 11, .first_pass = 1, .pass_count = 2});
    for (uint32_t slot = 0; slot < 22; ++slot) {
        const uint32_t same = (7 + slot / 2) * SPP + 1 + slot % 2;
        for (const int lane : {RAY_ORIGIN, RAY_DIRECTION}) {
            const auto l = static_cast<uint32_t>(lane);
            EXPECT_EQ(test::xyz_of(part.rays().at(l, slot)), test::xyz_of(whole.rays().at(l, same)));
        }
        EXPECT_EQ(test::bits(part.paths().at(PATH_SAMPLE, slot)),
                  test::bits(whole.paths().at(PATH_SAMPLE, same)));
    }
    for (uint32_t slot = 22; slot < 25; ++slot) {
        EXPECT_TRUE(part.rays().untouched(RAY_ORIGIN, slot));
        EXPECT_TRUE(part.paths().untouched(PATH_THROUGHPUT, slot));
    }
}

TEST_F(CameraStage, CropHasTheRaysOfTheWholePicture) {
    test::StageBench whole = bench(PIXELS);
    whole.run_camera({.pixel_count = PIXELS, .pass_count = 1});
    RenderSettings settings = small_settings();
    settings.crop = {0.5, 1, 0.25, 0.75};  // columns 3..5, rows 1..2
    test::StageBench crop = bench(6, settings);
    crop.run_camera({.pixel_count = 6, .pass_count = 1});
    for (uint32_t slot = 0; slot < 6; ++slot) {
        const uint32_t pixel = tiled_pixel_order(3, 2)[slot];
        const uint32_t in_whole = (1 + pixel / 3) * WIDTH + 3 + pixel % 3;
        const auto same = static_cast<uint32_t>(std::ranges::find(ORDER, in_whole) - ORDER.begin());
        EXPECT_EQ(test::xyz_of(crop.rays().at(RAY_DIRECTION, slot)),
                  test::xyz_of(whole.rays().at(RAY_DIRECTION, same)));
        EXPECT_EQ(test::bits(crop.paths().at(PATH_SAMPLE, slot).x),
                  test::bits(whole.paths().at(PATH_SAMPLE, same).x));
    }
}

TEST_F(CameraStage, OrthographicRaysAreParallelAndStartInTheirPixels) {
    scene_ = scene_with_camera(true);
    test::StageBench wave = bench(PIXELS);
    wave.run_camera({.pixel_count = PIXELS, .pass_count = 1});
    const V3f forward((TARGET - EYE).normalized());
    for (uint32_t slot = 0; slot < PIXELS; ++slot) {
        EXPECT_LT((test::xyz_of(wave.rays().at(RAY_DIRECTION, slot)) - forward).length(), 2e-7);
        const Imath::V2d at = position(wave, slot);
        EXPECT_NEAR(at.x, ORDER[slot] % WIDTH + 0.5, 0.5 + 1e-5);
        EXPECT_NEAR(at.y, ORDER[slot] / WIDTH + 0.5, 0.5 + 1e-5);
    }
}

// A tent reaches one pixel from the centre: some rays leave their own pixel, none gets farther.
TEST_F(CameraStage, TentFilterSpreadsRaysOverItsRadius) {
    RenderSettings settings = small_settings();
    settings.filter = PixelFilter::tent;
    test::StageBench wave = bench(SAMPLES, settings);
    wave.run_camera(ALL_SAMPLES);
    double farthest = 0;
    for (uint32_t slot = 0; slot < SAMPLES; ++slot) {
        const double middle = ORDER[slot / SPP] % WIDTH + 0.5;
        farthest = std::max(farthest, std::abs(position(wave, slot).x - middle));
    }
    EXPECT_GT(farthest, 0.5);
    EXPECT_LE(farthest, 1 + 1e-5);
}

}  // namespace
}  // namespace obscura
