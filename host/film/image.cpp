// SPDX-License-Identifier: Apache-2.0
// Looking things up in an image, and attributes as text.
#include "film/image.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>
#include <type_traits>

namespace obscura {

size_t Layer::find_channel(const std::string& channel) const {
    return static_cast<size_t>(std::find(channels.begin(), channels.end(), channel) - channels.begin());
}

std::string Layer::channel_path(size_t channel) const {
    const std::string& leaf = channels[channel];
    return name.empty() || name == leaf ? leaf : name + "." + leaf;
}

std::string attribute_text(const Attribute& attribute) {
    return std::visit(
        [](const auto& value) {
            using Value = std::decay_t<decltype(value)>;
            if constexpr (std::is_same_v<Value, V3d>) {
                return fmt::format("({}, {}, {})", value.x, value.y, value.z);
            } else if constexpr (std::is_same_v<Value, M44d>) {
                return fmt::format("({})", fmt::join(std::span(value.getValue(), 16), ", "));
            } else {
                return fmt::format("{}", value);
            }
        },
        attribute);
}

const Layer* Image::find_layer(const std::string& name) const {
    const auto found =
        std::find_if(layers.begin(), layers.end(), [&](const Layer& layer) { return layer.name == name; });
    return found == layers.end() ? nullptr : &*found;
}

const Layer* Image::beauty() const {
    const Layer* const unnamed = find_layer("");
    return unnamed != nullptr ? unnamed : find_layer(BLENDER_BEAUTY);
}

}  // namespace obscura
