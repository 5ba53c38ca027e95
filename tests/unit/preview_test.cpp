// SPDX-License-Identifier: Apache-2.0
// The preview's pixels for known inputs, and the properties of its tone curve.
#include "film/preview.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "support/errors.h"
#include "support/images.h"
#include "support/temporary_folder.h"

namespace obscura {
namespace {

using test::make_row;
using test::TemporaryFolder;

test::Png preview(const Image& image, double exposure_stops = 0) {
    const TemporaryFolder folder;
    write_preview_png(image, folder.file("preview.png"), exposure_stops);
    EXPECT_EQ(folder.entry_count(), 1u);
    return test::read_png(folder.file("preview.png"));
}

TEST(ToneCurve, KeepsWhatIsBelowTheShoulder) {
    for (const Rgb& color : {Rgb(0), Rgb(0.18f), Rgb(0.5f, 0.1f, 0)})
        EXPECT_EQ(tone_curve(color), color);
}

TEST(ToneCurve, RisesSmoothlyToOne) {
    float last = 0.5f;
    for (float peak = 0.501f; peak < 1000; peak *= 1.01f) {
        const float shown = tone_curve(Rgb(peak)).x;
        EXPECT_GT(shown, last);
        EXPECT_LE(shown - last, 0.01f * peak);  // never steeper than the straight line
        last = shown;
    }
    EXPECT_NEAR(tone_curve(Rgb(1)).x, 0.75f, 1e-6f);
    EXPECT_NEAR(tone_curve(Rgb(1e6f)).x, 1, 1e-5f);
    EXPECT_EQ(tone_curve(Rgb(std::numeric_limits<float>::max())).x, 1);
}

// Hue as (middle - least) / (largest - least) of the channels, which mixing with white keeps.
TEST(ToneCurve, KeepsHueAndFadesToWhite) {
    float last_saturation = 1;
    for (const float scale : {0.25f, 1.0f, 4.0f, 16.0f, 256.0f}) {
        const Rgb shown = tone_curve(Rgb(4, 2, 1) * scale);
        EXPECT_NEAR((shown.y - shown.z) / (shown.x - shown.z), 1.0f / 3, 1e-4f);
        const float saturation = (shown.x - shown.z) / shown.x;
        EXPECT_LT(saturation, last_saturation);
        last_saturation = saturation;
    }
    EXPECT_LT(last_saturation, 0.01f);
}

TEST(Preview, ShowsKnownValues) {
    // sRGB of 0.18 is 117.7 and of 0.5 is 187.5 of 255: the dithering picks a neighbour. 1 is shown as 0.75:
    // 224.9.
    const test::Png png = preview(make_row(
        {{0, 0, 0}, {0.18f, 0.18f, 0.18f}, {0.5f, 0, 0.5f}, {1, 1, 1}, {1e9f, 1e9f, 1e9f}, {-1, -1, -1}}));
    EXPECT_EQ(png.width, 6u);
    EXPECT_EQ(png.height, 1u);
    EXPECT_EQ(png.at(0, 0), (std::array{0, 0, 0, 255}));
    EXPECT_NEAR(png.at(1, 0)[0], 117.7, 1);
    EXPECT_NEAR(png.at(2, 0)[0], 187.5, 1);
    EXPECT_EQ(png.at(2, 0)[1], 0);
    EXPECT_NEAR(png.at(3, 0)[1], 224.9, 1);
    EXPECT_EQ(png.at(4, 0), (std::array{255, 255, 255, 255}));
    EXPECT_EQ(png.at(5, 0), (std::array{0, 0, 0, 255}));
}

TEST(Preview, ExposureIsInStops) {
    const Image dark = make_row({{0.01f, 0.02f, 0.05f}});
    const Image bright = make_row({{0.04f, 0.08f, 0.2f}});
    EXPECT_EQ(preview(dark, 2).rgba, preview(bright).rgba);
    EXPECT_NE(preview(dark, 0).rgba, preview(bright).rgba);
    for (const double stops : {std::nan(""), 1000.0, -1000.0}) {
        EXPECT_INPUT_ERROR(write_preview_png(dark, "/dev/null", stops), "exposure");
    }
}

TEST(Preview, DitheringKeepsTheMeanAndExactValues) {
    Image image = test::make_image(64, 64, {0, 64, 0, 64}, {{"", {"R", "G", "B"}, {}}});
    std::fill(image.layers[0].pixels.begin(), image.layers[0].pixels.end(), 0.18f);
    const test::Png png = preview(image);
    double sum = 0;
    for (uint32_t y = 0; y < 64; ++y) {
        for (uint32_t x = 0; x < 64; ++x) {
            sum += png.at(x, y)[0];
            EXPECT_NEAR(png.at(x, y)[0], 117.5, 0.6);  // only the two neighbours
        }
    }
    EXPECT_NEAR(sum / (64 * 64), static_cast<double>(255 * srgb_encode(0.18f)), 1.0 / 64);
    // Every 8-bit level comes back as it was, wherever the pixel is.
    for (int level = 0; level < 256; level += 5) {
        const float encoded = static_cast<float>(level) / 255;
        const float linear =
            encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
        if (linear > 0.5f) break;
        for (int place = 0; place < 64; ++place) {
            // Thresholds lie 1/128 away from whole levels, far more than the rounding of pow.
            EXPECT_EQ(preview_color(Rgb(linear), 1, place % 8, place / 8)[0], level);
        }
    }
}

TEST(Preview, CropIsInItsPlaceAndTheRestTransparent) {
    const std::vector<Layer> layers = {{"", {"R", "G", "B", "A"}, {}}};
    const auto scaled = [&](std::array<int32_t, 4> window) {
        Image image = test::make_image(20, 10, window, layers);
        for (float& value : image.layers[0].pixels)
            value *= 1e-4f;
        return preview(image);
    };
    const test::Png whole = scaled({0, 20, 0, 10});
    const test::Png part = scaled({3, 11, 2, 7});
    ASSERT_EQ(part.rgba.size(), whole.rgba.size());
    for (uint32_t y = 0; y < 10; ++y) {
        for (uint32_t x = 0; x < 20; ++x) {
            const bool inside = x >= 3 && x < 11 && y >= 2 && y < 7;
            EXPECT_EQ(part.at(x, y), inside ? whole.at(x, y) : (std::array{0, 0, 0, 0}));
        }
    }
}

TEST(Preview, NotFinitePixelsAreMagenta) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float inf = std::numeric_limits<float>::infinity();
    const test::Png png = preview(make_row({{0, nan, 0}, {inf, 0, 0}, {0, 0, -inf}, {0, 0, 0}}));
    for (uint32_t x = 0; x < 3; ++x)
        EXPECT_EQ(png.at(x, 0), (std::array{255, 0, 255, 255}));
    EXPECT_EQ(png.at(3, 0), (std::array{0, 0, 0, 255}));
}

TEST(Preview, ALoneLuminanceIsGrey) {
    Image image{1, 1, 0, 0, 1, 1, {{"", {"Y"}, {0.2f}}}, {}};
    const auto [r, g, b, a] = preview(image).at(0, 0);
    EXPECT_EQ(r, g);
    EXPECT_EQ(g, b);
    EXPECT_GT(r, 100);
}

TEST(Preview, BeautyIsFoundAmongBlendersNames) {
    Image image = make_row({{0.1f, 0.2f, 0.3f}});
    image.layers.insert(image.layers.begin(), {"ViewLayer.AO", {"R", "G", "B"}, {1, 1, 1}});
    const auto pixel = preview(make_row({{0.1f, 0.2f, 0.3f}})).at(0, 0);
    image.layers[1].name = BLENDER_BEAUTY;
    EXPECT_EQ(preview(image).at(0, 0), pixel);
}

TEST(Preview, WhatCannotBeShownOrWrittenIsSaid) {
    const Image image = make_row({{0, 0, 0}});
    Image without_beauty = image;
    without_beauty.layers[0].name = "direct";
    EXPECT_INPUT_ERROR(write_preview_png(without_beauty, "/dev/null", 0), "no beauty layer");
    Image depth = image;
    depth.layers[0].channels = {"A", "X", "Z"};
    EXPECT_INPUT_ERROR(write_preview_png(depth, "/dev/null", 0), "neither R, G, B nor Y");
    EXPECT_INPUT_ERROR(write_preview_png(image, "/dev/full", 0), "No space left on device");
    EXPECT_INPUT_ERROR(write_preview_png(image, "/no/such/folder/a.png", 0), "does not exist");
}

}  // namespace
}  // namespace obscura
