// SPDX-License-Identifier: Apache-2.0
// From the film's sums, in the order of visits, to the picture's rows.
#include "film/develop.h"
#include "shared/frame.h"

#include <gtest/gtest.h>

#include <span>
#include <string>
#include <vector>

namespace obscura {
namespace {

// One pixel wide, with the layer emission.
Image black_column(int32_t height) {
    Image image;
    image.x1 = 1;
    image.y1 = height;
    add_layers(std::vector<std::string>{"emission"}, image);
    return image;
}

// Three pixels, visited as 2, 0, 1, of which the first has two samples more than the others.
TEST(Develop, PutsSumsWhereTheirPixelsAreAndCountsTheirSamples) {
    const std::vector<FilmSum> sums{{{8, 12, 16, 4}, {}}, {{4, 2, 8, 2}, {}}, {{10, 0, 1, 0}, {}}};
    const std::vector<uint32_t> order{2, 0, 1};
    FilmSums film{.planes = {},
                  .sums = sums,
                  .pixel_order = order,
                  .samples = {.passes = 2, .pixels_ahead = 1, .passes_ahead = 2}};
    film.planes.fill(NO_PLANE);
    film.planes[LAYER_EMISSION] = 0;
    Image image = black_column(3);
    develop(film, image);
    EXPECT_EQ(image.layers[0].pixels, (std::vector<float>{2, 1, 4, 1, 5, 0, 0.5f, 0, 2, 3, 4, 1}));
    EXPECT_EQ(image.layers[1].pixels, (std::vector<float>{2, 1, 4, 5, 0, 0.5f, 2, 3, 4}));
}

// A picture of two bands. Of the upper one only half of the pixels have been rendered.
TEST(Develop, PutsPartsOfBandsWhereTheyBelongAndLeavesTheRestBlack) {
    const std::vector<FilmSum> upper{{{1, 1, 1, 1}, {}}, {{2, 2, 2, 1}, {}}};
    const std::vector<FilmSum> lower{{{3, 3, 3, 1}, {}}};
    const std::vector<uint32_t> upper_order{3, 1, 0, 2}, lower_order{0};
    FilmSums film{.planes = {},
                  .sums = upper,
                  .pixel_order = std::span(upper_order).first(2),
                  .samples = {.passes = 1}};
    film.planes.fill(NO_PLANE);
    film.planes[LAYER_EMISSION] = 0;
    Image image = black_column(5);
    develop(film, image);
    film.sums = lower;
    film.pixel_order = lower_order;
    film.first_pixel = 4;
    develop(film, image);
    EXPECT_EQ(image.layers[1].pixels, (std::vector<float>{0, 0, 0, 2, 2, 2, 0, 0, 0, 1, 1, 1, 3, 3, 3}));
}

}  // namespace
}  // namespace obscura
