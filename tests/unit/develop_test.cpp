// SPDX-License-Identifier: Apache-2.0
// From the film's sums, in the order of visits, to the picture's rows.
#include "film/develop.h"
#include "shared/frame.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace obscura {
namespace {

// Three pixels, visited as 2, 0, 1, of which the first has a sample more than the others.
TEST(Develop, PutsSumsWhereTheirPixelsAreAndCountsTheirSamples) {
    const std::vector<FilmSum> sums{{{6, 9, 12, 3}, {}}, {{4, 2, 8, 2}, {}}, {{10, 0, 1, 0}, {}}};
    const std::vector<uint32_t> order{2, 0, 1};
    FilmSums film{.planes = {}, .sums = sums, .pixel_order = order, .samples = 2, .pixels_ahead = 1};
    film.planes.fill(NO_PLANE);
    film.planes[LAYER_EMISSION] = 0;
    Image image;
    const std::vector<std::string> wanted{"emission"};
    develop_band(film, wanted, image);
    EXPECT_EQ(image.layers[0].pixels, (std::vector<float>{2, 1, 4, 1, 5, 0, 0.5f, 0, 2, 3, 4, 1}));
    EXPECT_EQ(image.layers[1].pixels, (std::vector<float>{2, 1, 4, 5, 0, 0.5f, 2, 3, 4}));
}

TEST(Develop, AppendsBandsBelowOneAnother) {
    const std::vector<FilmSum> upper{{{1, 1, 1, 1}, {}}, {{2, 2, 2, 1}, {}}};
    const std::vector<FilmSum> lower{{{3, 3, 3, 1}, {}}};
    const std::vector<uint32_t> two{1, 0}, one{0};
    FilmSums film{.planes = {}, .sums = upper, .pixel_order = two, .samples = 1};
    film.planes.fill(NO_PLANE);
    film.planes[LAYER_EMISSION] = 0;
    Image image;
    const std::vector<std::string> wanted{"emission"};
    develop_band(film, wanted, image);
    film.sums = lower;
    film.pixel_order = one;
    develop_band(film, wanted, image);
    EXPECT_EQ(image.layers[1].pixels, (std::vector<float>{2, 2, 2, 1, 1, 1, 3, 3, 3}));
}

}  // namespace
}  // namespace obscura
