// SPDX-License-Identifier: Apache-2.0
// The sums of a reference picture: its mean, the variance of that mean between independent sets, and a state that goes on
// exactly after any pass.
#include "reference/accumulator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace obscura::reference {
namespace {

constexpr size_t PIXELS = 50;
constexpr uint32_t PASSES_PER_SET = 4;

// Numbers of very different sizes, as radiances are.
std::vector<PathLight> random_pass(std::mt19937& random) {
    std::vector<PathLight> pixels(PIXELS);
    std::uniform_real_distribution<double> unit(0, 1);
    for (PathLight& pixel : pixels) {
        pixel.coverage = unit(random) < 0.5 ? 0 : 1;
        pixel.obscurance = RgbD(unit(random), unit(random), unit(random));
        for (RgbD& part : pixel.parts)
            part = std::exp2(40 * unit(random) - 30) * RgbD(unit(random), unit(random), unit(random));
    }
    return pixels;
}

Image developed(const Accumulator& accumulator) {
    Image image;
    image.x1 = PIXELS;
    image.y1 = 1;
    accumulator.develop(image, true);
    return image;
}

void expect_same(const Image& a, const Image& b) {
    ASSERT_EQ(a.layers.size(), b.layers.size());
    for (size_t i = 0; i < a.layers.size(); ++i) {
        EXPECT_EQ(a.layers[i].name, b.layers[i].name);
        EXPECT_EQ(a.layers[i].pixels, b.layers[i].pixels) << a.layers[i].name;
    }
}

TEST(Accumulator, MeanAndVarianceAreThoseOfTheSets) {
    std::mt19937 random(1);
    Accumulator accumulator(PIXELS, PASSES_PER_SET);
    constexpr int SETS = 5;
    std::vector<double> set_means, obscurance_means;  // red of the first pixel
    double emission = 0, coverage = 0;
    for (int set = 0; set < SETS; ++set) {
        double sum = 0, obscurance = 0;
        for (uint32_t pass = 0; pass < PASSES_PER_SET; ++pass) {
            const std::vector<PathLight> pixels = random_pass(random);
            accumulator.add_pass(pixels);
            for (const RgbD& part : pixels[0].parts)
                sum += part.x;
            emission += pixels[0].parts[LAYER_EMISSION].x;
            coverage += pixels[0].coverage;
            obscurance += pixels[0].obscurance.x;
        }
        set_means.push_back(sum / PASSES_PER_SET);
        obscurance_means.push_back(obscurance / PASSES_PER_SET);
    }
    const auto mean = [](const std::vector<double>& values) {
        double total = 0;
        for (const double value : values)
            total += value;
        return total / SETS;
    };
    const auto variance = [&](const std::vector<double>& values) {
        double deviations = 0;
        for (const double value : values)
            deviations += (value - mean(values)) * (value - mean(values));
        return deviations / (SETS - 1) / SETS;
    };
    const Image image = developed(accumulator);
    EXPECT_EQ(accumulator.finished_sets(), 5u);
    EXPECT_FLOAT_EQ(image.find_layer("")->pixels[0], static_cast<float>(mean(set_means)));
    EXPECT_FLOAT_EQ(image.find_layer("")->pixels[3], static_cast<float>(coverage / 20));
    EXPECT_FLOAT_EQ(image.find_layer("emission")->pixels[0], static_cast<float>(emission / 20));
    EXPECT_FLOAT_EQ(image.find_layer("obscurance")->pixels[0], static_cast<float>(mean(obscurance_means)));
    EXPECT_FLOAT_EQ(image.find_layer(VARIANCE_LAYER)->pixels[0], static_cast<float>(variance(set_means)));
    EXPECT_FLOAT_EQ(image.find_layer(OBSCURANCE_VARIANCE_LAYER)->pixels[0],
                    static_cast<float>(variance(obscurance_means)));
}

TEST(Accumulator, VarianceTakesTwoFinishedSets) {
    std::mt19937 random(2);
    Accumulator accumulator(PIXELS, PASSES_PER_SET);
    for (uint32_t pass = 1; pass <= 2 * PASSES_PER_SET; ++pass) {
        accumulator.add_pass(random_pass(random));
        EXPECT_EQ(developed(accumulator).find_layer("Variance") != nullptr, pass == 2 * PASSES_PER_SET);
    }
}

TEST(Accumulator, GoesOnExactlyAfterAnyPass) {
    std::mt19937 random(3);
    Accumulator unbroken(PIXELS, PASSES_PER_SET);
    Accumulator broken(PIXELS, PASSES_PER_SET);
    for (uint32_t pass = 1; pass <= 40 * PASSES_PER_SET; ++pass) {
        const std::vector<PathLight> pixels = random_pass(random);
        unbroken.add_pass(pixels);
        broken.add_pass(pixels);
        const Image picture = developed(broken);
        broken = Accumulator(PIXELS, PASSES_PER_SET);
        ASSERT_TRUE(broken.restore(picture, pass));
        expect_same(developed(broken), picture);
    }
    expect_same(developed(broken), developed(unbroken));
}

TEST(Accumulator, PictureWithoutStateIsNotRestored) {
    Accumulator accumulator(PIXELS, PASSES_PER_SET);
    Image picture = developed(accumulator);
    EXPECT_TRUE(accumulator.restore(picture, 1));
    EXPECT_FALSE(Accumulator(PIXELS + 1, PASSES_PER_SET).restore(picture, 1));
    picture.layers.pop_back();
    EXPECT_FALSE(accumulator.restore(picture, 1));
}

}  // namespace
}  // namespace obscura::reference
