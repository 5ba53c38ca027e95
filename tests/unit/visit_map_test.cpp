// SPDX-License-Identifier: Apache-2.0
// The picture of visits: its scale, and where it is drawn.
#include "film/visit_map.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "support/images.h"
#include "support/temporary_folder.h"

namespace obscura {
namespace {

constexpr std::array BLACK{0, 0, 4, 255};
constexpr std::array PALE_YELLOW{252, 253, 191, 255};
constexpr std::array NOTHING{0, 0, 0, 0};

// 20 x 20 pixels, the lower right part of a picture of 40 x 40; their nodes run from 0 to 399.
Image corner() {
    Image image;
    image.full_width = image.full_height = 40;
    image.x0 = image.y0 = 20;
    image.x1 = image.y1 = 40;
    return image;
}

std::vector<float> ramp() {
    std::vector<float> nodes;
    for (int i = 0; i < 400; ++i)
        nodes.push_back(static_cast<float>(i));
    return nodes;
}

TEST(VisitMap, ScaleEndsWhereOnePercentIsBrighter) {
    const test::TemporaryFolder folder;
    const VisitRange range = write_visit_map_png(corner(), ramp(), folder.file("visits.png"));
    EXPECT_EQ(range.brightest, 395);
    EXPECT_EQ(range.most, 399);
    const test::Png png = test::read_png(folder.file("visits.png"));
    EXPECT_EQ(png.at(20, 20), BLACK);
    EXPECT_EQ(png.at(39, 39), PALE_YELLOW);
    EXPECT_EQ(png.at(35, 39), PALE_YELLOW);
    EXPECT_NE(png.at(34, 39), PALE_YELLOW);
    EXPECT_EQ(png.at(19, 30), NOTHING) << "not rendered";
}

TEST(VisitMap, BarBelowHasTheWholeScale) {
    const test::TemporaryFolder folder;
    write_visit_map_png(corner(), ramp(), folder.file("visits.png"));
    const test::Png png = test::read_png(folder.file("visits.png"));
    ASSERT_EQ(png.height, 48u);
    EXPECT_EQ(png.at(0, 43), NOTHING);
    for (uint32_t y = 44; y < 48; ++y) {
        EXPECT_LT(png.at(0, y)[0], 10);
        EXPECT_GT(png.at(39, y)[0], 250);
    }
}

TEST(VisitMap, PictureWithoutSamplesIsBlack) {
    const test::TemporaryFolder folder;
    const std::vector<float> nodes(400, 0);
    EXPECT_EQ(write_visit_map_png(corner(), nodes, folder.file("visits.png")).most, 0);
    EXPECT_EQ(test::read_png(folder.file("visits.png")).at(30, 30), BLACK);
}

}  // namespace
}  // namespace obscura
