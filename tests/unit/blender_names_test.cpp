// SPDX-License-Identifier: Apache-2.0
// --exr-names blender: every layer of the table gets a name that Blender's reader takes apart as it was meant.
#include "film/blender_names.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "film/develop.h"
#include "support/images.h"
#include "support/temporary_folder.h"

namespace obscura {
namespace {

using test::make_image;
using test::pixel_value;

// Beauty and the layers of these names, or all; 3 x 2 pixels.
Image developed(const std::vector<std::string>& names = {}) {
    std::vector<Layer> layers{{"", {"R", "G", "B", "A"}, {}}};
    for (const LayerInfo& info : layer_table()) {
        if (names.empty() || std::ranges::find(names, info.name) != names.end())
            layers.push_back({info.name, info.channels, {}});
    }
    return make_image(3, 2, {0, 3, 0, 2}, layers);
}

Image renamed(const std::vector<std::string>& names = {}) {
    Image image = developed(names);
    use_blender_names(image);
    return image;
}

// Channels in their order, as one word: "RGB".
std::map<std::string, std::string> channels_by_layer(const Image& image) {
    std::map<std::string, std::string> channels;
    for (const Layer& layer : image.layers) {
        std::string& word = channels[layer.name];
        for (const std::string& channel : layer.channels)
            word += channel;
    }
    return channels;
}

TEST(BlenderNames, AreThoseOfBlendersPasses) {
    const std::map<std::string, std::string> expected{
        {"ViewLayer.Combined", "RGBA"},
        {"ViewLayer.Emit", "RGB"},
        {"ViewLayer.Direct", "RGB"},
        {"ViewLayer.Ambient", "RGB"},
        {"ViewLayer.SpecularEmission", "RGB"},
        {"ViewLayer.SpecularDirect", "RGB"},
        {"ViewLayer.SpecularAmbient", "RGB"},
        {"ViewLayer.Obscurance", "RGB"},
        {"ViewLayer.AO", "RGB"},
        {"ViewLayer.Position", "XYZ"},
        {"ViewLayer.Depth", "Z"},
        {"ViewLayer.GeometricNormal", "XYZ"},
        {"ViewLayer.Normal", "XYZ"},
        {"ViewLayer.UV", "UVA"},
        {"ViewLayer.DiffCol", "RGB"},
        {"ViewLayer.Variance", "RGB"},
        {"ViewLayer.RelativeVariance", "RGB"},
    };
    EXPECT_EQ(channels_by_layer(renamed()), expected);
}

TEST(BlenderNames, OfTheTableAreUniqueAndWithoutDots) {
    std::set<std::string> paths;
    for (const LayerInfo& info : layer_table()) {
        const std::string pass = info.blender_pass;
        EXPECT_EQ(pass.find('.'), std::string::npos) << pass;
        EXPECT_GE(info.blender_channels.size(), info.channels.size()) << info.name;
        for (const std::string& channel : info.blender_channels) {
            EXPECT_EQ(channel.size(), 1u) << pass << "." << channel;
            EXPECT_TRUE(paths.insert(pass + "." + channel).second) << pass << "." << channel;
        }
    }
}

TEST(BlenderNames, KeepThePixels) {
    const Image plain = developed();
    const Image image = renamed();
    for (const LayerInfo& info : layer_table()) {
        if (info.layer == LAYER_UV || info.name == std::string("ao")) continue;
        const Layer* const pass = image.find_layer(std::string("ViewLayer.") + info.blender_pass);
        ASSERT_NE(pass, nullptr) << info.name;
        EXPECT_EQ(pass->pixels, plain.find_layer(info.name)->pixels) << info.name;
    }
    ASSERT_NE(image.beauty(), nullptr);
    EXPECT_EQ(image.beauty()->name, BLENDER_BEAUTY);
    EXPECT_EQ(image.beauty()->pixels, plain.beauty()->pixels);
}

TEST(BlenderNames, AmbientOcclusionIsGrey) {
    const Image image = renamed({"ao"});
    const Layer* const ao = image.find_layer("ViewLayer.AO");
    ASSERT_NE(ao, nullptr);
    ASSERT_EQ(ao->pixels.size(), 3 * image.pixel_count());
    for (size_t value = 0; value < ao->pixels.size(); ++value) {
        const auto pixel = static_cast<int32_t>(value / 3);
        EXPECT_EQ(ao->pixels[value], pixel_value(pixel % 3, pixel / 3, 0));
    }
}

TEST(BlenderNames, TextureCoordinatesShareAPassWithCoverage) {
    Image image = developed({"u", "v"});
    for (float& value : image.layers[2].pixels)
        value += 0.5f;
    use_blender_names(image);
    const Layer* const uv = image.find_layer("ViewLayer.UV");
    ASSERT_NE(uv, nullptr);
    ASSERT_EQ(uv->pixels.size(), 3 * image.pixel_count());
    for (size_t pixel = 0; pixel < image.pixel_count(); ++pixel) {
        const auto x = static_cast<int32_t>(pixel % 3);
        const auto y = static_cast<int32_t>(pixel / 3);
        EXPECT_EQ(uv->pixels[3 * pixel], pixel_value(x, y, 0));
        EXPECT_EQ(uv->pixels[3 * pixel + 1], pixel_value(x, y, 0) + 0.5f);
        EXPECT_EQ(uv->pixels[3 * pixel + 2], pixel_value(x, y, 3));
    }
}

TEST(BlenderNames, ALoneTextureCoordinateIsAPassOfOneChannel) {
    const std::map<std::string, std::string> u{{"ViewLayer.Combined", "RGBA"}, {"ViewLayer.UV", "U"}};
    const std::map<std::string, std::string> v{{"ViewLayer.Combined", "RGBA"}, {"ViewLayer.UV", "V"}};
    EXPECT_EQ(channels_by_layer(renamed({"u"})), u);
    EXPECT_EQ(channels_by_layer(renamed({"v"})), v);
}

TEST(BlenderNames, HalfColoursSpareVariancesAndCoordinates) {
    Image image = renamed();
    for (Layer& layer : image.layers) {
        for (float& value : layer.pixels)
            value += 1.0f / 8192;  // too fine for half
    }
    const test::TemporaryFolder folder;
    write_exr(image, folder.file("half.exr"), true);
    const Image read = read_exr(folder.file("half.exr"));
    const std::set<std::string> exact{
        "ViewLayer.Position", "ViewLayer.Depth",    "ViewLayer.GeometricNormal", "ViewLayer.Normal",
        "ViewLayer.UV",       "ViewLayer.Variance", "ViewLayer.RelativeVariance"};
    EXPECT_EQ(read.layers.size(), image.layers.size());
    for (const Layer& layer : image.layers) {
        const Layer* const read_layer = read.find_layer(layer.name);
        ASSERT_NE(read_layer, nullptr) << layer.name;
        std::vector<float> values = read_layer->pixels;  // the file has its own order of channels
        std::vector<float> wanted = layer.pixels;
        std::ranges::sort(values);
        std::ranges::sort(wanted);
        EXPECT_EQ(values == wanted, exact.contains(layer.name)) << layer.name;
    }
}

}  // namespace
}  // namespace obscura
