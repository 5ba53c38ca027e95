// SPDX-License-Identifier: Apache-2.0
// Small images with known pixels, and PNG files read back.
#pragma once

#include <gtest/gtest.h>
#include <png.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "film/image.h"

namespace obscura::test {

// A float that no other channel or pixel of the same picture has; exact in float, not in half.
inline float pixel_value(int32_t x, int32_t y, size_t channel) {
    return static_cast<float>(x) + 1000.0f * static_cast<float>(y) + static_cast<float>(channel) / 16.0f;
}

// The part [x0, x1) x [y0, y1) of a picture whose pixels depend only on their place in the whole.
inline Image make_image(int32_t full_width, int32_t full_height, std::array<int32_t, 4> window,
                        const std::vector<Layer>& layers) {
    const auto [x0, x1, y0, y1] = window;
    Image image{full_width, full_height, x0, y0, x1, y1, layers, {}};
    for (Layer& layer : image.layers) {
        layer.pixels.clear();
        for (int32_t y = y0; y < y1; ++y) {
            for (int32_t x = x0; x < x1; ++x) {
                for (size_t c = 0; c < layer.channel_count(); ++c)
                    layer.pixels.push_back(pixel_value(x, y, c));
            }
        }
    }
    return image;
}

// One row of RGB pixels as beauty.
inline Image make_row(const std::vector<std::array<float, 3>>& pixels) {
    const int32_t width = static_cast<int32_t>(pixels.size());
    Image image{width, 1, 0, 0, width, 1, {{"", {"R", "G", "B"}, {}}}, {}};
    for (const auto& pixel : pixels) {
        image.layers[0].pixels.insert(image.layers[0].pixels.end(), pixel.begin(), pixel.end());
    }
    return image;
}

struct Png {
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<uint8_t> rgba;

    std::array<int, 4> at(uint32_t x, uint32_t y) const {
        const uint8_t* pixel = &rgba[4 * (size_t{y} * width + x)];
        return {pixel[0], pixel[1], pixel[2], pixel[3]};
    }
};

inline Png read_png(const std::string& path) {
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    EXPECT_NE(png_image_begin_read_from_file(&header, path.c_str()), 0) << path << ": " << header.message;
    header.format = PNG_FORMAT_RGBA;
    Png png{header.width, header.height, std::vector<uint8_t>(PNG_IMAGE_SIZE(header))};
    EXPECT_NE(png_image_finish_read(&header, nullptr, png.rgba.data(), 0, nullptr), 0) << header.message;
    return png;
}

}  // namespace obscura::test
