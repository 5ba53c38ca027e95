// SPDX-License-Identifier: Apache-2.0
// Crops merge into the very picture that they were cut from, or the message says why they don't.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "film/attributes.h"
#include "film/image.h"
#include "support/errors.h"
#include "support/images.h"

namespace obscura {
namespace {

using test::make_image;

const std::vector<Layer> LAYERS = {{"", {"R", "G", "B", "A"}, {}}, {"ao", {"Y"}, {}}};
const std::vector<std::string> NAMES = {"a.exr", "b.exr", "c.exr"};

// A 10 x 8 picture in three crops.
std::vector<Image> make_parts() {
    return {make_image(10, 8, {0, 4, 0, 8}, LAYERS), make_image(10, 8, {4, 10, 0, 3}, LAYERS),
            make_image(10, 8, {4, 10, 3, 8}, LAYERS)};
}

TEST(Merge, PartsGiveTheWholeExactlyInAnyOrder) {
    const Image whole = make_image(10, 8, {0, 10, 0, 8}, LAYERS);
    std::vector<Image> parts = make_parts();
    for (int rotation = 0; rotation < 3; ++rotation) {
        const Image merged = merge_images(parts, NAMES);
        EXPECT_EQ((std::array{merged.full_width, merged.x0, merged.x1}), (std::array{10, 0, 10}));
        EXPECT_EQ((std::array{merged.full_height, merged.y0, merged.y1}), (std::array{8, 0, 8}));
        ASSERT_EQ(merged.layers.size(), 2u);
        for (size_t i = 0; i < 2; ++i) {
            EXPECT_EQ(merged.layers[i].channels, LAYERS[i].channels);
            EXPECT_EQ(merged.layers[i].pixels, whole.layers[i].pixels);
        }
        std::rotate(parts.begin(), parts.begin() + 1, parts.end());
    }
}

TEST(Merge, AttributesAreSummedListedOrKept) {
    std::vector<Image> parts = make_parts();
    for (size_t i = 0; i < 3; ++i) {
        parts[i].attributes = {{attribute::SECONDS, 0.5 + static_cast<double>(i)},
                               {attribute::DEVICE, std::string(i == 1 ? "gpu" : "cpu")},
                               {attribute::SEED, int64_t{7}},
                               {"ambientIntensity", V3d(1, 2, 3)}};
    }
    const auto attributes = merge_images(parts, NAMES).attributes;
    EXPECT_EQ(attributes.at(attribute::SECONDS), Attribute(4.5));
    EXPECT_EQ(attributes.at(attribute::DEVICE), Attribute(std::string("cpu, gpu")));
    EXPECT_EQ(attributes.at(attribute::SEED), Attribute(int64_t{7}));
    EXPECT_EQ(attributes.at("ambientIntensity"), Attribute(V3d(1, 2, 3)));
    EXPECT_EQ(attributes.size(), 4u);
}

TEST(Merge, FactsThatDisagreeAreNamedWithTheirFiles) {
    std::vector<Image> parts = make_parts();
    for (Image& part : parts)
        part.attributes[attribute::SEED] = int64_t{7};
    parts[2].attributes[attribute::SEED] = int64_t{8};
    EXPECT_INPUT_ERROR(merge_images(parts, NAMES), "c.exr: its seed is 8, but that of a.exr is 7");
    parts[2].attributes[attribute::SEED] = std::string("7");  // another type is another value
    EXPECT_INPUT_ERROR(merge_images(parts, NAMES), "c.exr: its seed is 7, but that of a.exr is 7");
    parts[2].attributes.erase(attribute::SEED);
    EXPECT_INPUT_ERROR(merge_images(parts, NAMES), "c.exr: its header lacks seed, which other parts have");
    parts = make_parts();
    parts[1].attributes["ambientIntensity"] = V3d(0);
    EXPECT_INPUT_ERROR(merge_images(parts, NAMES), "a.exr: its header lacks ambientIntensity");
}

TEST(Merge, OverlapsGapsAndOtherShapesAreRefused) {
    std::vector<Image> parts = make_parts();
    parts[1] = make_image(10, 8, {3, 10, 0, 3}, LAYERS);
    EXPECT_INPUT_ERROR(merge_images(parts, NAMES), "b.exr: it overlaps a.exr at pixel (3, 0)");
    parts[1] = make_image(10, 8, {4, 9, 0, 3}, LAYERS);
    EXPECT_INPUT_ERROR(merge_images(parts, NAMES),
                       "the parts leave 3 pixels of the picture empty, the first at (9, 0)");
    parts[1] = make_image(10, 9, {4, 10, 0, 3}, LAYERS);
    EXPECT_INPUT_ERROR(merge_images(parts, NAMES), "b.exr: it is a part of a 10 x 9 picture, but a.exr");
    parts[1] = make_image(10, 8, {4, 10, 0, 3}, {LAYERS[0]});
    EXPECT_INPUT_ERROR(merge_images(parts, NAMES),
                       "b.exr: its channels are R G B A, but those of a.exr are R G B A ao.Y");
}

}  // namespace
}  // namespace obscura
