// SPDX-License-Identifier: Apache-2.0
// The plan is arithmetic: whatever the sizes, every sample is in exactly one wave and everything fits.
#include "wavefront/plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "support/errors.h"

namespace obscura {
namespace {

std::vector<Wave> waves_of(uint32_t capacity, uint32_t pixels, uint32_t first_pass, uint32_t end_pass) {
    std::vector<Wave> waves;
    const auto next = [&](const Wave& wave) { return wave_after(wave, capacity, pixels, end_pass); };
    for (Wave wave = next({.first_pass = first_pass}); wave.sample_count() > 0; wave = next(wave))
        waves.push_back(wave);
    return waves;
}

// Each pixel's in ascending order. On the way all have one sample before any has two, and none has sixteen more than another.
TEST(Plan, WavesCoverEverySampleOnce) {
    for (const uint32_t pixels : {1u, 7u, 64u, 1000u}) {
        for (const uint32_t spp : {1u, 3u, 8u, 37u}) {
            for (const uint32_t capacity : {1u, 3u, 64u, 999u, 100000u}) {
                const uint32_t first_pass = spp / 3;
                std::vector<uint32_t> passes(pixels, first_pass);
                for (const Wave& wave : waves_of(capacity, pixels, first_pass, spp)) {
                    EXPECT_LE(wave.sample_count(), capacity);
                    for (uint32_t i = 0; i < wave.pixel_count; ++i) {
                        uint32_t& pass = passes.at(wave.first_pixel + i);
                        ASSERT_EQ(pass, wave.first_pass);
                        pass += wave.pass_count;
                    }
                    const SampleCounts samples = samples_after(wave, pixels);
                    for (uint32_t pixel = 0; pixel < pixels; ++pixel)
                        ASSERT_EQ(samples.at(pixel), passes[pixel]);
                    const auto [fewest, most] = std::ranges::minmax(passes);
                    EXPECT_LE(most - fewest, fewest == 0 ? 1u : 16u);
                }
                EXPECT_EQ(passes, std::vector<uint32_t>(pixels, spp));
            }
        }
    }
}

TEST(Plan, PassesGoTogetherOnceThePictureHasSome) {
    const auto passes = [](uint32_t pixels) {
        std::vector<uint32_t> counts;
        for (const Wave& wave : waves_of(pixels / 2, pixels, 0, 50))
            if (wave.first_pixel == 0) counts.push_back(wave.pass_count);
        return counts;
    };
    EXPECT_EQ(passes(1000), (std::vector<uint32_t>{1, 16, 16, 16, 1}));
    EXPECT_EQ(passes(500'000), (std::vector<uint32_t>{1, 8, 8, 16, 16, 1})) << "four million samples";
    EXPECT_EQ(passes(5'000'000), (std::vector<uint32_t>{1, 1, 2, 4, 8, 16, 16, 2})) << "as many as before";
    EXPECT_EQ(waves_of(600, 200, 0, 6).size(), 2u) << "a wave holds three passes over all pixels";
}

TEST(Plan, WavesOfHugeRendersDontOverflow) {
    const uint32_t pixels = 65536u * 32767u;
    const Wave last{.first_pixel = pixels - 5, .pixel_count = 5, .first_pass = 992, .pass_count = 8};
    EXPECT_EQ(wave_after(last, 4096, pixels, 1000).sample_count(), 0u);
    const Wave before{.first_pixel = pixels - 517, .pixel_count = 512, .first_pass = 992, .pass_count = 8};
    EXPECT_EQ(wave_after(before, 4096, pixels, 1000).pixel_count, 5u);
}

TEST(Plan, CapacityFitsMemoryAndAllocationLimits) {
    const QueueShape shape{.layer_planes = 7,
                           .light_samples = 2,
                           .light_lobes = 2,
                           .obscurance_rays = 5,
                           .specular_paths = true};
    for (const uint64_t memory : {uint64_t{1} << 20, uint64_t{100} << 20, uint64_t{1} << 30}) {
        for (const uint64_t allocation : {uint64_t{1} << 20, uint64_t{256} << 20}) {
            const uint32_t capacity = wave_capacity(shape, 1u << 20, memory, allocation, uint64_t{1} << 40);
            EXPECT_LE(capacity * bytes_per_slot(shape), memory);
            EXPECT_LE(capacity * largest_bytes_per_slot(shape), allocation);
        }
    }
    EXPECT_EQ(wave_capacity(shape, 1u << 20, uint64_t{1} << 40, uint64_t{1} << 40, 100), 100u);
}

constexpr uint64_t PLENTY = uint64_t{1} << 50;

std::string capacity_error(const QueueShape& shape, uint64_t memory_bytes, uint64_t max_allocation_bytes) {
    return test::input_error([&] { wave_capacity(shape, 1024, memory_bytes, max_allocation_bytes, PLENTY); });
}

TEST(Plan, TooLittleMemoryAsksForMore) {
    const QueueShape shape{.obscurance_rays = 1024};
    EXPECT_EQ(
        capacity_error(shape, 20000, PLENTY),
        "19.53 KiB of queue memory hold 1 camera sample at 16.14 KiB each, 64 are the least: raise --memory "
        "or lower --obscurance-rays or --light-samples");
}

// More memory wouldn't help.
TEST(Plan, TooSmallBuffersAskForSmallerQueues) {
    EXPECT_EQ(
        capacity_error({.obscurance_rays = 2048}, PLENTY, 1 << 20),
        "the largest queue takes 32 KiB for each camera sample, and the 1 MiB that the device allows one "
        "buffer hold 32, 64 are the least: lower --obscurance-rays");
    EXPECT_EQ(
        capacity_error({.light_samples = 4096}, PLENTY, 1 << 20),
        "the largest queue takes 128 KiB for each camera sample, and the 1 MiB that the device allows one "
        "buffer hold 8, 64 are the least: lower --light-samples");
}

TEST(Plan, TooManyResultsForTheirIndicesAskForFewer) {
    EXPECT_EQ(
        capacity_error({.obscurance_rays = 1u << 27}, PLENTY, PLENTY),
        "the largest queue takes 2 GiB for each camera sample, and the 32 GiB that 31-bit indices reach "
        "hold 15, 64 are the least: lower --obscurance-rays");
}

TEST(Plan, IndicesIntoEveryQueueStayBelow31Bits) {
    const std::vector<std::pair<std::string_view, QueueShape>> largest{
        {"rays", {}},
        {"paths", {.light_samples = 64, .light_lobes = 2}},
        {"shadow_rays", {.light_samples = 64}},
        {"results", {.obscurance_rays = 1u << 16}},
    };
    for (const auto& [name, shape] : largest) {
        const uint64_t capacity = wave_capacity(shape, PLENTY, PLENTY, PLENTY, PLENTY);
        for (const QueueSize& size : queue_sizes(shape)) {
            const uint64_t elements = size.lanes * size.items * capacity;
            EXPECT_LE(elements, 0x7fffffffu) << size.name;
            if (size.name == name) {
                EXPECT_GE(elements, 0x7fff0000u) << name << ": fewer than the bound allows";
            }
        }
    }
}

TEST(Plan, ShapeHasLightSamplesForEachGroupOfLights) {
    RenderSettings settings;
    settings.light_samples = 3;
    const auto light_samples = [&](const Needs& needs) {
        return queue_shape(needs, settings, 1).light_samples;
    };
    Needs none;
    EXPECT_EQ(light_samples(none), 0u);
    Needs area;
    area.area_lights = true;
    EXPECT_EQ(light_samples(area), 3u);
    for (bool Needs::*const kind : {&Needs::point_lights, &Needs::spot_lights, &Needs::directional_lights}) {
        Needs punctual;
        punctual.*kind = true;
        EXPECT_EQ(light_samples(punctual), 3u);
        Needs both = area;
        both.*kind = true;
        EXPECT_EQ(light_samples(both), 6u);
    }
    Needs all_punctual;
    all_punctual.point_lights = all_punctual.spot_lights = all_punctual.directional_lights = true;
    EXPECT_EQ(light_samples(all_punctual), 3u) << "they are one group";
}

TEST(Plan, ShapeHasOnlyWhatTheSceneNeeds) {
    RenderSettings settings;
    settings.obscurance_rays = 5;
    const QueueShape least = queue_shape({}, settings, 4);
    EXPECT_EQ(least.layer_planes, 4u);
    EXPECT_EQ(least.light_lobes, 1u);
    EXPECT_EQ(least.obscurance_rays, 0u);
    EXPECT_FALSE(least.specular_paths);
    Needs needs;
    needs.glossy = needs.obscurance = needs.specular_paths = true;
    const QueueShape shape = queue_shape(needs, settings, 4);
    EXPECT_EQ(shape.light_lobes, 2u);
    EXPECT_EQ(shape.obscurance_rays, 5u);
    EXPECT_TRUE(shape.specular_paths);
}

TEST(Plan, CropsTileThePictureLikePbrt) {
    const PixelRect left = crop_pixels({0, 0.5, 0, 1}, 801, 600);
    const PixelRect right = crop_pixels({0.5, 1, 0, 1}, 801, 600);
    EXPECT_EQ(left.x0, 0u);
    EXPECT_EQ(left.x1, 401u);
    EXPECT_EQ(right.x0, left.x1);
    EXPECT_EQ(right.x1, 801u);
    EXPECT_THROW(crop_pixels({0.501, 0.509, 0, 1}, 100, 100), InputError);  // between two pixels
}

TEST(Plan, FilmBandsCoverTheRectangleWithinTheLimit) {
    const PixelRect rect{10, 20, 110, 220};
    for (const uint64_t limit : {uint64_t{1}, uint64_t{100} * 7 * sizeof(FilmSum) * 3, uint64_t{1} << 40}) {
        uint32_t y = rect.y0;
        for (const PixelRect& band : film_bands(rect, 7, limit)) {
            EXPECT_EQ(band.y0, y);
            EXPECT_EQ(band.width(), rect.width());
            EXPECT_TRUE(band.height() == 1 || band.pixel_count() * 7 * sizeof(FilmSum) <= limit);
            y = band.y1;
        }
        EXPECT_EQ(y, rect.y1);
    }
}

TEST(Plan, BandsOfTheLargestPictureHaveCountablePixels) {
    const PixelRect rect = crop_pixels({}, 65536, 65536);
    EXPECT_EQ(rect.pixel_count(), uint64_t{1} << 32);
    uint64_t pixels = 0;
    for (const PixelRect& band : film_bands(rect, 1, uint64_t{1} << 50)) {
        EXPECT_LT(band.pixel_count(), uint64_t{1} << 31);
        pixels += band.pixel_count();
    }
    EXPECT_EQ(pixels, rect.pixel_count());
}

}  // namespace
}  // namespace obscura
