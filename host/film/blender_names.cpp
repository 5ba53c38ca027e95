// SPDX-License-Identifier: Apache-2.0
// Blender splits a channel's name at its last two dots into layer, pass and channel (imb_exr_split_channel_name in its
// source): a pass has no dot in its name.
#include "film/blender_names.h"

#include <algorithm>

#include "base/error.h"
#include "film/develop.h"
#include "film/visit_map.h"

namespace obscura {
namespace {

constexpr const char* VIEW_LAYER = "ViewLayer.";  // Blender's name for a scene's only layer

// Appends a copy of another layer's channel; from may be the layer itself.
void add_channel(Layer& layer, const std::string& name, const Layer& from, size_t from_channel) {
    const size_t pixel_count = layer.pixels.size() / layer.channel_count();
    std::vector<float> pixels;
    pixels.reserve(pixel_count * (layer.channel_count() + 1));
    for (size_t pixel = 0; pixel < pixel_count; ++pixel) {
        for (size_t channel = 0; channel < layer.channel_count(); ++channel)
            pixels.push_back(layer.pixels[pixel * layer.channel_count() + channel]);
        pixels.push_back(from.pixels[pixel * from.channel_count() + from_channel]);
    }
    layer.pixels = std::move(pixels);
    layer.channels.push_back(name);
}

// Blender's UV pass is U, V and A, and its reader knows passes of one, three or four channels: both coordinates become
// one layer, with the picture's coverage.
void join_texture_coordinates(Image& image) {
    const auto find = [&](const char* name) { return std::ranges::find(image.layers, name, &Layer::name); };
    const auto u = find("u");
    const auto v = find("v");
    if (u == image.layers.end() || v == image.layers.end()) return;
    const auto beauty = find("");
    OBSCURA_CHECK(beauty != image.layers.end(), "an image without the layer beauty");
    const size_t alpha = beauty->find_channel("A");
    OBSCURA_CHECK(alpha < beauty->channel_count(), "the layer beauty is without coverage");
    add_channel(*u, "V", *v, 0);
    add_channel(*u, "A", *beauty, alpha);
    image.layers.erase(v);
}

void rename(Layer& layer) {
    if (layer.name.empty()) {
        layer.name = BLENDER_BEAUTY;
        return;
    }
    if (layer.name == VISIT_LAYER) {  // no layer of the film
        layer.name = std::string(VIEW_LAYER) + "Visits";
        return;
    }
    const LayerInfo& info = layer_info(layer.name);
    for (size_t channel = 0; channel < info.blender_channels.size(); ++channel) {
        if (channel == layer.channel_count()) add_channel(layer, "", layer, 0);
        layer.channels[channel] = info.blender_channels[channel];
    }
    layer.name = std::string(VIEW_LAYER) + info.blender_pass;
}

}  // namespace

void use_blender_names(Image& image) {
    join_texture_coordinates(image);
    std::ranges::for_each(image.layers, rename);
}

}  // namespace obscura
