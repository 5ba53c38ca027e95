// SPDX-License-Identifier: Apache-2.0
// Metrics against values computed by hand.
#include "film/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "support/images.h"
#include "support/temporary_folder.h"

namespace obscura {
namespace {

using test::make_row;
using test::TemporaryFolder;

constexpr float NOT_A_NUMBER = std::numeric_limits<float>::quiet_NaN();
constexpr float INFINITE = std::numeric_limits<float>::infinity();

LayerDifference beauty_difference(const Image& image, const Image& reference) {
    const ImageDifference difference = compare_images(image, reference);
    EXPECT_EQ(difference.layers.size(), 1u);
    return difference.layers.at(0);
}

TEST(Metrics, AgreeWithHandComputedValues) {
    // Errors 0, 0.5, -2 against references 1, 0, 3 in each of two pixels' channels, then zeros.
    const LayerDifference d =
        beauty_difference(make_row({{1, 0.5f, 1}, {0, 0, 0}}), make_row({{1, 0, 3}, {0, 0, 0}}));
    EXPECT_FALSE(d.identical);
    EXPECT_EQ(d.value_count, 6u);
    EXPECT_EQ(d.not_finite_count, 0u);
    EXPECT_DOUBLE_EQ(d.max_abs, 2);
    EXPECT_DOUBLE_EQ(d.mse, 4.25 / 6);
    EXPECT_DOUBLE_EQ(d.rmse, std::sqrt(4.25 / 6));
    EXPECT_DOUBLE_EQ(d.relmse, (0.25 / 0.01 + 4 / 9.01) / 6);
    EXPECT_DOUBLE_EQ(d.mape, (0.5 / 0.01 + 2 / 3.01) / 6);
    EXPECT_DOUBLE_EQ(d.bias, (0.5 - 2) / 6);
}

TEST(Metrics, PixelsDifferByMoreThanRounding) {
    const Image reference = make_row({{1, 1, 1}, {1, 1, 1}, {0, 0, 0}, {1, 1, 1}});
    const LayerDifference d = beauty_difference(
        make_row({{1, 1, 1}, {1.00009f, 1, 1}, {1e-5f, -1e-5f, 0}, {1, 1, NOT_A_NUMBER}}), reference);
    EXPECT_EQ(d.pixel_count, 4u);
    EXPECT_EQ(d.differing_pixel_count, 2u) << "the third and the last";
}

TEST(Metrics, EqualBitsAreIdenticalWhateverTheyHold) {
    const Image image = make_row({{1, NOT_A_NUMBER, -INFINITE}});
    const LayerDifference d = beauty_difference(image, image);
    EXPECT_TRUE(d.identical);
    EXPECT_EQ(d.rmse, 0);
    EXPECT_EQ(d.not_finite_count, 0u);
    EXPECT_TRUE(d.is_within(Metric::rmse, 0));
}

TEST(Metrics, SignOfZeroBreaksIdentityButHasNoError) {
    const LayerDifference d = beauty_difference(make_row({{0, 0, 0}}), make_row({{0, -0.0f, 0}}));
    EXPECT_FALSE(d.identical);
    EXPECT_EQ(d.max_abs, 0);
    EXPECT_FALSE(d.is_within(Metric::max_abs, 0));
    EXPECT_TRUE(d.is_within(Metric::max_abs, 1e-30));
}

TEST(Metrics, NotFinitePairsAreCountedAndNeverWithinABound) {
    const LayerDifference d = beauty_difference(make_row({{NOT_A_NUMBER, 1, 3}, {INFINITE, 0, 0}}),
                                                make_row({{0, 1, 1}, {-INFINITE, 0, 0}}));
    EXPECT_EQ(d.not_finite_count, 2u);
    EXPECT_EQ(d.value_count, 6u);
    EXPECT_DOUBLE_EQ(d.mse, 4.0 / 4);  // over the four pairs that have a distance
    EXPECT_DOUBLE_EQ(d.max_abs, 2);
    EXPECT_FALSE(d.is_within(Metric::rmse, 1e30));
    const LayerDifference all =
        beauty_difference(make_row({{NOT_A_NUMBER, NOT_A_NUMBER, NOT_A_NUMBER}}), make_row({{0, 0, 0}}));
    EXPECT_EQ(all.rmse, 0);
    EXPECT_EQ(all.not_finite_count, 3u);
}

TEST(Metrics, EachMetricHasItsBound) {
    LayerDifference d;
    d.identical = false;
    d.rmse = 1;
    d.relmse = 2;
    d.mape = 3;
    d.max_abs = 4;
    for (const auto& [metric, value] :
         {std::pair{Metric::rmse, 1}, {Metric::relmse, 2}, {Metric::mape, 3}, {Metric::max_abs, 4}}) {
        EXPECT_EQ(d.value(metric), value);
        EXPECT_TRUE(d.is_within(metric, value));
        EXPECT_FALSE(d.is_within(metric, value - 0.01));
    }
}

TEST(Metrics, OnlyCommonChannelsAreCompared) {
    Image image = make_row({{1, 2, 3}});
    image.layers.push_back({"ao", {"Y"}, {0.5f}});
    Image reference = make_row({{1, 2, 3}});
    reference.layers[0] = {"", {"B", "A", "R", "G"}, {3, 1, 1, 2}};
    reference.layers.push_back({"direct", {"R"}, {1}});
    const ImageDifference d = compare_images(image, reference);
    ASSERT_EQ(d.layers.size(), 1u);
    EXPECT_TRUE(d.layers[0].identical);
    EXPECT_EQ(d.layers[0].value_count, 3u);
    EXPECT_EQ(d.only_in_image, std::vector<std::string>{"ao.Y"});
    EXPECT_EQ(d.only_in_reference, (std::vector<std::string>{"A", "direct.R"}));
}

TEST(HeatMap, GoesFromBlackToYellowByDecades) {
    // Relative errors 0, below the scale, 0.01 (the middle of the scale), 1, above it, and none.
    const float reference = 0.99f;  // + 0.01 = 1
    std::vector<std::array<float, 3>> pixels;
    for (const float error : {0.0f, 1e-6f, 0.01f, 1.0f, 50.0f, NOT_A_NUMBER}) {
        pixels.push_back({reference + error, reference + error, reference + error});
    }
    const Image image = make_row(pixels);
    const Image plain = make_row(std::vector<std::array<float, 3>>(6, {reference, reference, reference}));
    const TemporaryFolder folder;
    write_heat_map_png(image, plain, "", folder.file("heat.png"));
    const test::Png png = test::read_png(folder.file("heat.png"));
    EXPECT_EQ(png.at(0, 0), (std::array{0, 0, 4, 255}));
    EXPECT_EQ(png.at(1, 0), (std::array{0, 0, 4, 255}));
    EXPECT_EQ(png.at(2, 0), (std::array{183, 55, 121, 255}));
    EXPECT_EQ(png.at(3, 0), (std::array{252, 253, 191, 255}));
    EXPECT_EQ(png.at(4, 0), (std::array{252, 253, 191, 255}));
    EXPECT_EQ(png.at(5, 0), (std::array{0, 255, 255, 255}));
}

}  // namespace
}  // namespace obscura
