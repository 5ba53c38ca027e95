// SPDX-License-Identifier: Apache-2.0
// The stage film: each pixel adds its own slots, in ascending order, to what it holds.
#include "film/develop.h"
#include "support/device.h"
#include "support/kernel_queue.h"
#include "support/scene_builder.h"

#include <algorithm>
#include <limits>
#include <random>
#include <span>
#include <utility>
#include <vector>

namespace obscura {
namespace {

constexpr uint32_t PIXELS = 6;

class FilmStage : public test::DeviceTest {
  protected:
    static Scene one_quad() {
        test::SceneBuilder builder;
        builder.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, builder.material(test::matte(Rgb(0.5f))));
        return builder.finish();
    }
    static RenderSettings settings_of_picture() {
        RenderSettings settings;
        settings.width = 3;
        settings.height = 2;
        settings.spp = 8;
        return settings;
    }

    // A wave over a picture of 3 x 2 pixels, which has had passes already; slot s holds values of which the order of summation shows.
    test::StageBench film_bench(uint32_t capacity) {
        test::StageBench bench(device(), one_quad(), settings_of_picture(), capacity);
        for (uint32_t slot = 0; slot < capacity; ++slot) {
            for (uint32_t layer = 0; layer < BEAUTY_LAYERS; ++layer)
                bench.layer(layer, slot) = value(layer, slot);
        }
        for (uint32_t pixel = 0; pixel < PIXELS; ++pixel) {
            for (uint32_t layer = 0; layer < BEAUTY_LAYERS; ++layer) {
                bench.film_layer(layer, pixel) = {1, 2, static_cast<float>(pixel), 0};
                bench.film_excess(layer, pixel) = {};
            }
        }
        return bench;
    }

    static f32x4 value(uint32_t layer, uint32_t slot) {
        const float x = 0.1f * static_cast<float>(slot + 1) + static_cast<float>(layer);
        return {x, 1e7f * x, 1 / x, 1};
    }

    // A float's sum with what it is too large by (Kahan).
    struct Sum {
        float sum, excess = 0;
        void add(float value) {
            const float corrected = value - excess;
            const float next = sum + corrected;
            excess = (next - sum) - corrected;
            sum = next;
        }
    };
    // The sums that the contract asks for, and their excess.
    static std::pair<f32x4, f32x4> expected(uint32_t layer, uint32_t pixel, const Wave& wave) {
        const float before = wave.first_pass > 0 ? 1.0f : 0.0f;
        Sum x{before}, y{2 * before}, z{static_cast<float>(pixel) * before}, w{0};
        for (uint32_t slot = 0; slot < wave.sample_count(); ++slot) {
            if (wave.first_pixel + slot / wave.pass_count != pixel) continue;
            const f32x4 v = value(layer, slot);
            x.add(v.x), y.add(v.y), z.add(v.z), w.add(v.w);
        }
        return {{x.sum, y.sum, z.sum, w.sum}, {x.excess, y.excess, z.excess, w.excess}};
    }

    static void expect_sums(test::StageBench& bench, const Wave& wave, uint32_t first, uint32_t end) {
        for (uint32_t pixel = first; pixel < end; ++pixel) {
            for (uint32_t layer = 0; layer < BEAUTY_LAYERS; ++layer) {
                const auto [sum, excess] = expected(layer, pixel, wave);
                EXPECT_EQ(test::bits(bench.film_layer(layer, pixel)), test::bits(sum))
                    << "pixel " << pixel << ", layer " << layer;
                EXPECT_EQ(test::bits(bench.film_excess(layer, pixel)), test::bits(excess))
                    << "pixel " << pixel << ", layer " << layer;
            }
        }
    }
};

TEST_F(FilmStage, AddsSlotsOfAFullWaveInAscendingOrder) {
    test::StageBench bench = film_bench(3 * PIXELS);
    const Wave wave{.pixel_count = PIXELS, .first_pass = 1, .pass_count = 3};
    bench.run_film(wave);
    expect_sums(bench, wave, 0, PIXELS);
    EXPECT_TRUE(bench.guards_untouched());
    EXPECT_EQ(bench.counters[STATUS_CODE], STATUS_OK);
}

TEST_F(FilmStage, PixelsOutsideOfTheWaveStay) {
    test::StageBench bench = film_bench(16);
    const Wave wave{.first_pixel = 2, .pixel_count = 3, .first_pass = 4, .pass_count = 4};
    bench.run_film(wave);
    expect_sums(bench, wave, 0, PIXELS);
}

// Without a pass before, the sums are what the film's memory happened to hold.
TEST_F(FilmStage, FirstPassReplacesWhatTheFilmHolds) {
    test::StageBench bench = film_bench(16);
    const Wave wave{.first_pixel = 1, .pixel_count = 4, .pass_count = 3};
    bench.run_film(wave);
    expect_sums(bench, wave, 1, 5);
    for (const uint32_t pixel : {0u, 5u})
        EXPECT_EQ(bench.film_layer(LAYER_DIRECT, pixel).y, 2) << "outside of the wave";
}

TEST_F(FilmStage, InfiniteContributionIsReported) {
    test::StageBench bench = film_bench(8);
    bench.layer(LAYER_DIRECT, 3).y = std::numeric_limits<float>::infinity();
    bench.run_film({.pixel_count = 4, .pass_count = 2});
    EXPECT_EQ(bench.counters[STATUS_CODE], STATUS_NOT_FINITE);
    EXPECT_EQ(bench.counters[STATUS_STAGE], STAGE_FILM);
    EXPECT_EQ(bench.counters[STATUS_ITEM], 3U);
}

// Two samples of each pixel and then three, or all five at once: the same bits, and the variance of the beauty.
TEST_F(FilmStage, DeviationsDontDependOnTheCut) {
    constexpr uint32_t SAMPLES = 5;
    const auto sample = [](uint32_t layer, uint32_t pixel, uint32_t pass) {
        const auto x = static_cast<float>((pixel * 7 + pass * 9 + layer * 3) % 11);
        return f32x4{100 + x, 0.001f * x, 3, 0};
    };
    const auto rendered = [&](std::initializer_list<uint32_t> waves) {
        test::StageBench wave(device(), one_quad(), settings_of_picture(), SAMPLES * PIXELS,
                              {LAYER_VARIANCE});
        for (uint32_t layer = 0; layer < LAYER_COUNT; ++layer) {
            for (uint32_t pixel = 0; pixel < PIXELS && wave.plane(layer) != NO_PLANE; ++pixel)
                wave.film_layer(layer, pixel) = {1e6f, 1, 1, 1};  // of no meaning
        }
        uint32_t first_pass = 0;
        for (const uint32_t passes : waves) {
            for (uint32_t slot = 0; slot < passes * PIXELS; ++slot) {
                wave.layer(LAYER_VARIANCE, slot) = {};
                for (uint32_t layer = 0; layer < BEAUTY_LAYERS; ++layer)
                    wave.layer(layer, slot) = sample(layer, slot / passes, first_pass + slot % passes);
            }
            wave.run_film({.pixel_count = PIXELS, .first_pass = first_pass, .pass_count = passes});
            first_pass += passes;
        }
        return wave;
    };
    test::StageBench whole = rendered({SAMPLES});
    test::StageBench cut = rendered({2, 3});
    for (uint32_t pixel = 0; pixel < PIXELS; ++pixel) {
        double sum = 0, squares = 0;
        for (uint32_t s = 0; s < SAMPLES; ++s) {
            double beauty = 0;
            for (uint32_t layer = 0; layer < BEAUTY_LAYERS; ++layer)
                beauty += static_cast<double>(sample(layer, pixel, s).x);
            sum += beauty;
            squares += beauty * beauty;
        }
        const f32x4 deviations = whole.film_layer(LAYER_VARIANCE, pixel);
        const double expected = squares - sum * sum / SAMPLES;
        EXPECT_GT(expected, 1);
        EXPECT_NEAR(static_cast<double>(deviations.x), expected, 1e-4 * expected) << "pixel " << pixel;
        EXPECT_NEAR(static_cast<double>(deviations.y), 1e-6 * expected, 1e-10 * expected)
            << "pixel " << pixel;
        EXPECT_EQ(deviations.z, 0) << "no sample differs";
        EXPECT_EQ(test::bits(cut.film_layer(LAYER_VARIANCE, pixel)), test::bits(deviations));
        EXPECT_EQ(test::bits(cut.film_excess(LAYER_VARIANCE, pixel)),
                  test::bits(whole.film_excess(LAYER_VARIANCE, pixel)));
    }
}

// One pixel of 2^26 samples, the same wave 64 times over: its mean and the deviations from it. A plain float sum of them
// stalls half-way.
TEST_F(FilmStage, ManySamplesKeepTheirMeanAndVariance) {
    constexpr uint32_t SLOTS = 1 << 20, WAVES = 64;
    constexpr uint32_t EMISSION = 0, VARIANCE = 1, PLANES = 2;
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<f32x4> paths(size_t{PATH_LAYERS + PLANES} * SLOTS);
    double sum = 0, squares = 0;
    for (uint32_t slot = 0; slot < SLOTS; ++slot) {
        const float x = unit(random);
        paths[size_t{PATH_LAYERS + EMISSION} * SLOTS + slot] = {x, 1, 1000 * x, 1};
        sum += static_cast<double>(x);
        squares += static_cast<double>(x) * static_cast<double>(x);
    }
    const double mean = sum / SLOTS, variance = squares / SLOTS - mean * mean;

    Frame one_pixel{};
    one_pixel.crop = {1, 1, 1, SLOTS};
    auto* planes = reinterpret_cast<uint32_t*>(one_pixel.plane);
    std::fill_n(planes, LAYER_COUNT, NO_PLANE);
    planes[LAYER_EMISSION] = EMISSION;
    planes[LAYER_VARIANCE] = VARIANCE;
    planes[LAYER_COUNT] = PLANES;
    const Buffer frame = Buffer::holding(device(), "frame", "test", std::span(&one_pixel, 1));
    const Buffer path_buffer = Buffer::holding(device(), "paths", "test", paths);
    Buffer film(device(), "film", "test", PLANES * sizeof(FilmSum));
    Buffer counters(device(), "counters", "test", sizeof(DeviceStatus));
    counters.clear();
    ProgramLibrary library(device());
    const cl::Kernel kernel = library.kernel("film");
    const uint32_t first_pixel = 0, pixel_count = 1, pass_count = SLOTS;
    for (uint32_t wave = 0; wave < WAVES; ++wave) {
        const uint32_t first_pass = wave * SLOTS;
        launch(device(), kernel, "film", 1, library.local_size(), frame, path_buffer, film, counters,
               first_pixel, pixel_count, first_pass, pass_count);
    }

    Image image;
    image.x1 = image.y1 = 1;
    add_layers(std::vector<std::string>{"emission", "Variance"}, image);
    FilmSums sums{};
    std::copy_n(planes, LAYER_COUNT, sums.planes.begin());
    const std::vector<FilmSum> found = film.contents<FilmSum>();
    sums.sums = found;
    const std::vector<uint32_t> order{0};
    sums.pixel_order = order;
    sums.samples.passes = uint64_t{SLOTS} * WAVES;
    develop(sums, image);
    const std::vector<float>& emission = image.layers.at(1).pixels;
    EXPECT_NEAR(static_cast<double>(emission.at(0)), mean, 1e-6 * mean);
    EXPECT_EQ(emission.at(1), 1);
    EXPECT_NEAR(static_cast<double>(emission.at(2)), 1000 * mean, 1e-6 * 1000 * mean);
    const std::vector<float>& found_variance = image.layers.at(2).pixels;
    EXPECT_NEAR(static_cast<double>(found_variance.at(0)), variance, 1e-5 * variance);
    EXPECT_EQ(found_variance.at(1), 0);
}

}  // namespace
}  // namespace obscura
