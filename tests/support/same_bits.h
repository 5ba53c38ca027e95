// SPDX-License-Identifier: Apache-2.0
// Pictures that must be the same to the last bit, in every layer that there is.
#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "film/develop.h"
#include "film/image.h"

namespace obscura::test {

inline std::vector<std::string> every_layer() {
    std::vector<std::string> names;
    for (const LayerInfo& info : layer_table())
        names.emplace_back(info.name);
    return names;
}

// Every channel of every layer has the same bits: -0 differs from 0.
inline void expect_same_bits(const Image& image, const Image& expected) {
    ASSERT_EQ(image.layers.size(), expected.layers.size());
    for (size_t i = 0; i < image.layers.size(); ++i) {
        const Layer& layer = image.layers[i];
        ASSERT_EQ(layer.name, expected.layers[i].name);
        ASSERT_EQ(layer.pixels.size(), expected.layers[i].pixels.size());
        size_t different = 0;
        for (size_t p = 0; p < layer.pixels.size(); ++p) {
            different += std::bit_cast<uint32_t>(layer.pixels[p]) !=
                         std::bit_cast<uint32_t>(expected.layers[i].pixels[p]);
        }
        EXPECT_EQ(different, 0u) << "values of layer " << layer.title();
    }
}

}  // namespace obscura::test
