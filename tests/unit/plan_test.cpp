// SPDX-License-Identifier: Apache-2.0
// The plan is arithmetic: whatever the sizes, every sample is in exactly one wave and everything fits.
#include "wavefront/plan.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/error.h"

namespace obscura {
namespace {

TEST(Plan, WavesCoverEverySampleOnceInOrder) {
    for (const uint32_t pixels : {1u, 7u, 64u, 1000u}) {
        for (const uint32_t spp : {1u, 3u, 8u}) {
            for (const uint32_t capacity : {64u, 65u, 999u, 100000u}) {
                uint64_t next = 0;
                for (uint64_t index = 0;; ++index) {
                    const Wave wave = wave_at(index, capacity, pixels, spp);
                    if (wave.count == 0) break;
                    EXPECT_EQ(uint64_t{wave.first_pass} * pixels + wave.first_pixel, next);
                    EXPECT_LE(wave.count, capacity);
                    next += wave.count;
                }
                EXPECT_EQ(next, uint64_t{pixels} * spp);
            }
        }
    }
}

TEST(Plan, WavesOfHugeRendersDontOverflow) {
    const uint32_t pixels = 65536u * 32768u;
    const uint64_t last = (uint64_t{pixels} * 1000 - 1) / 4096;
    const Wave wave = wave_at(last, 4096, pixels, 1000);
    EXPECT_EQ(wave.first_pass, 999u);
    EXPECT_EQ(wave_at(last + 1, 4096, pixels, 1000).count, 0u);
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

TEST(Plan, TooLittleMemoryIsAnInputError) {
    const QueueShape shape{.obscurance_rays = 1u << 20};
    EXPECT_THROW(wave_capacity(shape, 1024, 1 << 20, 1 << 20, 1000), InputError);
}

TEST(Plan, ResultIndicesStayBelow31Bits) {
    const QueueShape shape{.obscurance_rays = 1u << 16};
    const uint64_t plenty = uint64_t{1} << 50;
    EXPECT_LE(uint64_t{wave_capacity(shape, 1u << 31, plenty, plenty, plenty)} * (1u << 16), 0x7fffffffu);
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
    for (const uint64_t limit : {uint64_t{1}, uint64_t{100} * 7 * 16 * 3, uint64_t{1} << 40}) {
        uint32_t y = rect.y0;
        for (const PixelRect& band : film_bands(rect, 7, limit)) {
            EXPECT_EQ(band.y0, y);
            EXPECT_EQ(band.width(), rect.width());
            EXPECT_TRUE(band.height() == 1 || band.pixel_count() * 7 * 16 <= limit);
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
