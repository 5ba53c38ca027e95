// SPDX-License-Identifier: Apache-2.0
// Images survive a round trip through OpenEXR bit for bit; damaged and foreign files are refused by name.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "base/file.h"
#include "film/image.h"
#include "support/errors.h"
#include "support/images.h"
#include "support/temporary_folder.h"

namespace obscura {
namespace {

using test::make_image;
using test::TemporaryFolder;

const std::vector<Layer> LAYERS = {{"", {"R", "G", "B", "A"}, {}},
                                   {"N", {"X", "Y", "Z"}, {}},
                                   {"Variance", {"R", "G", "B"}, {}},
                                   {"Z", {"Z"}, {}},
                                   {"ao", {"Y"}, {}},
                                   {"obscurance", {"R", "G", "B", "W"}, {}},
                                   {"specular.direct", {"R", "G", "B"}, {}}};

void expect_same_pixels(const Image& a, const Image& b) {
    ASSERT_EQ(a.layers.size(), b.layers.size());
    for (size_t i = 0; i < a.layers.size(); ++i) {
        EXPECT_EQ(a.layers[i].name, b.layers[i].name);
        EXPECT_EQ(a.layers[i].channels, b.layers[i].channels);
        EXPECT_EQ(a.layers[i].pixels, b.layers[i].pixels) << a.layers[i].name;
    }
}

Image round_trip(const Image& image, bool half_color = false) {
    const TemporaryFolder folder;
    write_exr(image, folder.file("image.exr"), half_color);
    EXPECT_EQ(folder.entry_count(), 1u);
    return read_exr(folder.file("image.exr"));
}

TEST(Exr, RoundTripKeepsPixelsLayersAndWindow) {
    // More than one block of 16 lines, and a crop whose edges fall inside blocks.
    for (const std::array<int32_t, 4> window : {std::array{0, 37, 0, 50}, {5, 30, 7, 41}, {36, 37, 49, 50}}) {
        const Image image = make_image(37, 50, window, LAYERS);
        const Image read = round_trip(image);
        EXPECT_EQ(read.full_width, 37);
        EXPECT_EQ(read.full_height, 50);
        EXPECT_EQ((std::array{read.x0, read.x1, read.y0, read.y1}), window);
        expect_same_pixels(image, read);
    }
}

TEST(Exr, RoundTripKeepsSpecialFloatsBitForBit) {
    using Limits = std::numeric_limits<float>;
    Image image = make_image(6, 1, {0, 6, 0, 1}, {{"ao", {"Y"}, {}}});
    image.layers[0].pixels = {
        -0.0f, Limits::denorm_min(), Limits::max(), Limits::infinity(), Limits::quiet_NaN(), 0.1f};
    const Image read = round_trip(image);
    for (size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(std::bit_cast<uint32_t>(image.layers[0].pixels[i]),
                  std::bit_cast<uint32_t>(read.layers[0].pixels[i]));
    }
}

TEST(Exr, RoundTripKeepsAttributes) {
    Image image = make_image(2, 2, {0, 2, 0, 2}, {LAYERS[0]});
    M44d matrix;
    matrix[3][1] = 0.1;
    image.attributes = {{"rho", std::string("exp")},
                        {"empty", std::string()},
                        {"d_max", std::numeric_limits<double>::infinity()},
                        {"renderTimeSeconds", 0.1},
                        {"spp", int64_t{8}},
                        {"negative", int64_t{-5}},
                        {"seed", int64_t{0x123456789abcdef0}},
                        {"smallest", std::numeric_limits<int64_t>::min()},
                        {"digits", std::string("007")},
                        {"I_A", V3d(0.1, 0.2, 0.3)},
                        {"objectToWorld", matrix}};
    EXPECT_EQ(round_trip(image).attributes, image.attributes);
}

TEST(Exr, StandardMatricesAreFloat) {
    Image image = make_image(2, 2, {0, 2, 0, 2}, {LAYERS[0]});
    M44d matrix;
    matrix[3][0] = 0.1;
    image.attributes = {{"worldToCamera", matrix}};
    const Attribute read = round_trip(image).attributes.at("worldToCamera");
    EXPECT_EQ(std::get<M44d>(read)[3][0], static_cast<double>(0.1f));
}

TEST(Exr, HalfColorRoundsColoursOnly) {
    const Image image = make_image(37, 50, {0, 37, 0, 50}, LAYERS);
    const Image read = round_trip(image, true);
    ASSERT_EQ(read.layers.size(), LAYERS.size());
    for (size_t i = 0; i < LAYERS.size(); ++i) {
        const std::string& name = LAYERS[i].name;
        const bool is_color =
            name.empty() || name == "ao" || name == "obscurance" || name == "specular.direct";
        EXPECT_EQ(read.layers[i].pixels != image.layers[i].pixels, is_color) << name;
        for (size_t v = 0; v < image.layers[i].pixels.size(); ++v) {
            const float value = image.layers[i].pixels[v];
            EXPECT_NEAR(read.layers[i].pixels[v], value, value / 2048);  // half a unit of 11 bits
        }
    }
}

TEST(Exr, HalfColorWarnsOfOverflow) {
    Image image = test::make_row({{1, 2, 70000}});
    testing::internal::CaptureStderr();
    const Image read = round_trip(image, true);
    const std::string printed = testing::internal::GetCapturedStderr();
    EXPECT_TRUE(std::isinf(read.layers[0].pixels[2]));
    EXPECT_NE(printed.find("in the layer beauty, 1 value beyond 65504"), std::string::npos) << printed;
}

TEST(Exr, EveryTruncationIsRefused) {
    const TemporaryFolder folder;
    const std::string path = folder.file("image.exr");
    write_exr(make_image(20, 40, {0, 20, 0, 40}, LAYERS), path);
    const std::vector<std::byte> whole = read_bytes(path);
    const std::string cut = folder.file("cut.exr");
    for (size_t length = 0; length < whole.size(); length += length < 64 ? 1 : 97) {
        write_bytes(cut, {whole.begin(), whole.begin() + static_cast<ptrdiff_t>(length)});
        EXPECT_INPUT_ERROR(read_exr(cut), "cut.exr: ");
    }
    write_bytes(cut, {whole.begin(), whole.end() - 1});
    EXPECT_INPUT_ERROR(read_exr(cut), "cut.exr: ");
}

// A flipped byte may go unseen (a pixel, an attribute), but it must never do worse than an InputError.
TEST(Exr, DamagedBytesNeverCrash) {
    const TemporaryFolder folder;
    const std::string path = folder.file("image.exr");
    write_exr(make_image(8, 20, {0, 8, 0, 20}, {LAYERS[0], LAYERS[4]}), path);
    const std::vector<std::byte> whole = read_bytes(path);
    size_t refused_count = 0;
    for (size_t i = 0; i < whole.size(); ++i) {
        std::vector<std::byte> damaged = whole;
        damaged[i] ^= std::byte{0x80};
        write_bytes(path, damaged);
        try {
            read_exr(path);
        } catch (const InputError& error) {
            EXPECT_EQ(std::string(error.what()).find(path), 0u) << error.what();
            ++refused_count;
        }
    }
    EXPECT_GT(refused_count, whole.size() / 10);
}

TEST(Exr, AHugeSizeInTheHeaderIsRefusedBeforeMemoryIsTaken) {
    const TemporaryFolder folder;
    const std::string path = folder.file("image.exr");
    write_exr(make_image(3, 3, {0, 3, 0, 3}, {LAYERS[0]}), path);
    std::string bytes = read_text(path);
    for (const std::string name : {"dataWindow", "displayWindow"}) {
        // name, 0, "box2i", 0, size (4 bytes), then x0 y0 x1 y1: x1 becomes 2^29 - 1.
        const size_t x1 = bytes.find(name) + name.size() + 1 + 6 + 4 + 8;
        bytes.replace(x1, 4, "\xff\xff\xff\x1f");
    }
    write_text(path, bytes);
    EXPECT_INPUT_ERROR(read_exr(path), "image.exr: ");
}

TEST(Exr, ForeignAndMissingFilesAreRefused) {
    const TemporaryFolder folder;
    write_text(folder.file("text.exr"),
               "This is not an image, but it is long enough to be mistaken for one.");
    EXPECT_INPUT_ERROR(read_exr(folder.file("text.exr")), "text.exr: can't be read as an OpenEXR image");
    EXPECT_INPUT_ERROR(read_exr(folder.file("none.exr")), "none.exr: there is no such file");
    EXPECT_INPUT_ERROR(read_exr(folder.path()), "it is a folder");
}

TEST(Exr, FullDiskAndMissingFolderAreInputErrors) {
    const Image image = make_image(20, 40, {0, 20, 0, 40}, LAYERS);
    EXPECT_INPUT_ERROR(write_exr(image, "/dev/full"), "/dev/full: can't be written: No space left on device");
    const TemporaryFolder folder;
    EXPECT_INPUT_ERROR(write_exr(image, folder.file("no/image.exr")), "does not exist");
    EXPECT_EQ(folder.entry_count(), 0u);
}

TEST(ExrDeathTest, ABrokenImageIsABug) {
    Image image = make_image(2, 2, {0, 2, 0, 2}, {LAYERS[0]});
    image.attributes["version"] = std::string("0.1");
    EXPECT_DEATH(write_exr(image, "/dev/null"), "OpenEXR keeps the attribute name version for itself");
    image = make_image(2, 2, {0, 2, 0, 2}, {LAYERS[0], LAYERS[0]});
    EXPECT_DEATH(write_exr(image, "/dev/null"), "two channels are called R");
}

}  // namespace
}  // namespace obscura
