// SPDX-License-Identifier: Apache-2.0
// --exr-names blender: every layer of the table gets a name that Blender's reader takes apart as it was meant.
#include "film/blender_names.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "film/develop.h"
#include "support/images.h"
#include "support/temporary_folder.h"

namespace obscura {
namespace {

using test::make_image;

// Beauty and the layers of these names, or all; 3 x 2 pixels, of which no two channels have the same.
Image developed(const std::vector<std::string>& names = {}) {
    std::vector<Layer> layers{{"", {"R", "G", "B", "A"}, {}}};
    for (const LayerInfo& info : layer_table()) {
        if (names.empty() || std::ranges::find(names, info.name) != names.end())
            layers.push_back({info.name, info.channels, {}});
    }
    Image image = make_image(3, 2, {0, 3, 0, 2}, layers);
    for (size_t i = 0; i < image.layers.size(); ++i) {
        for (float& value : image.layers[i].pixels)
            value += static_cast<float>(i) / 512;
    }
    return image;
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
    // All but ao, u and v, which have tests of their own.
    const std::map<std::string, std::string> passes{
        {"emission", "Emit"},
        {"direct", "Direct"},
        {"ambient", "Ambient"},
        {"specular.emission", "SpecularEmission"},
        {"specular.direct", "SpecularDirect"},
        {"specular.ambient", "SpecularAmbient"},
        {"obscurance", "Obscurance"},
        {"P", "Position"},
        {"Z", "Depth"},
        {"N", "GeometricNormal"},
        {"Ns", "Normal"},
        {"Albedo", "DiffCol"},
        {"Variance", "Variance"},
        {"RelativeVariance", "RelativeVariance"},
    };
    EXPECT_EQ(passes.size() + 3, layer_table().size());
    for (const auto& [name, pass] : passes) {
        const Layer* const layer = image.find_layer("ViewLayer." + pass);
        ASSERT_NE(layer, nullptr) << pass;
        EXPECT_EQ(layer->pixels, plain.find_layer(name)->pixels) << name;
    }
    ASSERT_NE(image.beauty(), nullptr);
    EXPECT_EQ(image.beauty()->name, BLENDER_BEAUTY);
    EXPECT_EQ(image.beauty()->pixels, plain.beauty()->pixels);
}

TEST(BlenderNames, AmbientOcclusionIsGrey) {
    const Image plain = developed({"ao"});
    const Image image = renamed({"ao"});
    const Layer* const ao = image.find_layer("ViewLayer.AO");
    ASSERT_NE(ao, nullptr);
    ASSERT_EQ(ao->pixels.size(), 3 * image.pixel_count());
    for (size_t value = 0; value < ao->pixels.size(); ++value)
        EXPECT_EQ(ao->pixels[value], plain.find_layer("ao")->pixels[value / 3]);
}

TEST(BlenderNames, TextureCoordinatesShareAPassWithCoverage) {
    const Image plain = developed({"u", "v"});
    const Image image = renamed({"u", "v"});
    const Layer* const uv = image.find_layer("ViewLayer.UV");
    ASSERT_NE(uv, nullptr);
    ASSERT_EQ(uv->pixels.size(), 3 * image.pixel_count());
    for (size_t pixel = 0; pixel < image.pixel_count(); ++pixel) {
        EXPECT_EQ(uv->pixels[3 * pixel], plain.find_layer("u")->pixels[pixel]);
        EXPECT_EQ(uv->pixels[3 * pixel + 1], plain.find_layer("v")->pixels[pixel]);
        EXPECT_EQ(uv->pixels[3 * pixel + 2], plain.beauty()->pixels[4 * pixel + 3]);
    }
}

TEST(BlenderNames, TextureCoordinatesWithoutCoverageAbort) {
    Image image = make_image(1, 1, {0, 1, 0, 1}, {{"u", {"u"}, {}}, {"v", {"v"}, {}}});
    EXPECT_DEATH(use_blender_names(image), "without the layer beauty");
    image = make_image(1, 1, {0, 1, 0, 1}, {{"", {"R", "G", "B"}, {}}, {"u", {"u"}, {}}, {"v", {"v"}, {}}});
    EXPECT_DEATH(use_blender_names(image), "beauty is without coverage");
}

// Its table of layers has the layer in the first column, Blender's name in the last.
TEST(BlenderNames, AreThoseOfTheReadme) {
    std::set<std::pair<std::string, std::string>> expected{{"(none)", "Combined"}};
    for (const LayerInfo& info : layer_table())
        expected.insert({info.name, info.blender_pass});
    std::set<std::pair<std::string, std::string>> documented;
    std::ifstream readme(OBSCURA_SOURCE_DIR "/README.md");
    const std::regex row(R"(\| (?:`([\w.]+)`|(\(none\))) \|.*\| `(\w+)` \|)");
    std::smatch cells;
    for (std::string line; std::getline(readme, line);) {
        if (std::regex_match(line, cells, row))
            documented.insert({cells.str(1) + cells.str(2), cells.str(3)});
    }
    EXPECT_EQ(documented, expected);
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
