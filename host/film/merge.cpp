// SPDX-License-Identifier: Apache-2.0
// Disjoint crops into one picture: every pixel is copied from the one part that has it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "base/error.h"
#include "base/units.h"
#include "film/attributes.h"
#include "film/image.h"

namespace obscura {
namespace {

constexpr size_t NO_PART = static_cast<size_t>(-1);

std::string describe_channels(const Image& image) {
    std::vector<std::string> paths;
    for (const Layer& layer : image.layers) {
        for (size_t channel = 0; channel < layer.channel_count(); ++channel) {
            paths.push_back(layer.channel_path(channel));
        }
    }
    return fmt::format("{}", fmt::join(paths, " "));
}

void check_same_shape(const std::vector<Image>& parts, const std::vector<std::string>& names) {
    const Image& first = parts.front();
    for (size_t i = 1; i < parts.size(); ++i) {
        if (parts[i].full_width != first.full_width || parts[i].full_height != first.full_height) {
            throw InputError("{}: it is a part of a {} x {} picture, but {} is a part of a {} x {} picture",
                             names[i], parts[i].full_width, parts[i].full_height, names[0], first.full_width,
                             first.full_height);
        }
        const std::string channels = describe_channels(parts[i]);
        const std::string first_channels = describe_channels(first);
        if (channels != first_channels) {
            throw InputError("{}: its channels are {}, but those of {} are {}", names[i], channels, names[0],
                             first_channels);
        }
    }
}

// Every pixel of the picture belongs to exactly one part.
void check_partition(const std::vector<Image>& parts, const std::vector<std::string>& names) {
    const size_t width = static_cast<size_t>(parts.front().full_width);
    const size_t height = static_cast<size_t>(parts.front().full_height);
    std::vector<size_t> owners(width * height, NO_PART);
    for (size_t i = 0; i < parts.size(); ++i) {
        for (int32_t y = parts[i].y0; y < parts[i].y1; ++y) {
            for (int32_t x = parts[i].x0; x < parts[i].x1; ++x) {
                size_t& owner = owners[static_cast<size_t>(y) * width + static_cast<size_t>(x)];
                if (owner != NO_PART) {
                    throw InputError("{}: it overlaps {} at pixel ({}, {})", names[i], names[owner], x, y);
                }
                owner = i;
            }
        }
    }
    const auto missing = std::find(owners.begin(), owners.end(), NO_PART);
    if (missing == owners.end()) return;
    const size_t pixel = static_cast<size_t>(missing - owners.begin());
    const auto count = static_cast<uint64_t>(std::count(missing, owners.end(), NO_PART));
    throw InputError("{}: the parts leave {} of the picture empty, the first at ({}, {})", names[0],
                     counted(count, "pixel"), pixel % width, pixel / width);
}

// Adds b to a if both are real numbers.
bool add_to(Attribute& a, const Attribute& b) {
    auto* number = std::get_if<double>(&a);
    const auto* more = std::get_if<double>(&b);
    if (number == nullptr || more == nullptr) return false;
    *number += *more;
    return true;
}

// The merged value of one attribute that all parts have.
Attribute merge_attribute(const std::string& name, const std::vector<Image>& parts,
                          const std::vector<std::string>& names) {
    const MergeRule rule = merge_rule(name);
    Attribute merged = parts.front().attributes.at(name);
    std::set<std::string> listed = {attribute_text(merged)};
    for (size_t i = 1; i < parts.size(); ++i) {
        const Attribute& value = parts[i].attributes.at(name);
        const std::string text = attribute_text(value);
        if (rule == MergeRule::sum && add_to(merged, value)) continue;
        if (rule == MergeRule::list) {
            if (listed.insert(text).second) merged = attribute_text(merged) + ", " + text;
        } else if (value != merged) {
            throw InputError("{}: its {} is {}, but that of {} is {}", names[i], name, text, names[0],
                             attribute_text(merged));
        }
    }
    return merged;
}

void merge_attributes(const std::vector<Image>& parts, const std::vector<std::string>& names, Image& merged) {
    std::set<std::string> all;
    for (const Image& part : parts) {
        for (const auto& [name, value] : part.attributes)
            all.insert(name);
    }
    for (const std::string& name : all) {
        for (size_t i = 0; i < parts.size(); ++i) {
            if (parts[i].attributes.contains(name)) continue;
            throw InputError("{}: its header lacks {}, which other parts have", names[i], name);
        }
        merged.attributes[name] = merge_attribute(name, parts, names);
    }
}

void copy_part(const Image& part, size_t layer_index, Image& merged) {
    const Layer& from = part.layers[layer_index];
    Layer& to = merged.layers[layer_index];
    const size_t channels = from.channel_count();
    const size_t row_values = static_cast<size_t>(part.width()) * channels;
    for (int32_t y = part.y0; y < part.y1; ++y) {
        const size_t from_row = static_cast<size_t>(y - part.y0) * row_values;
        const size_t to_pixel =
            static_cast<size_t>(y) * static_cast<size_t>(merged.full_width) + static_cast<size_t>(part.x0);
        std::copy_n(&from.pixels[from_row], row_values, &to.pixels[to_pixel * channels]);
    }
}

}  // namespace

Image merge_images(const std::vector<Image>& parts, const std::vector<std::string>& names) {
    OBSCURA_CHECK(!parts.empty() && parts.size() == names.size(), "{} parts, {} names", parts.size(),
                  names.size());
    check_same_shape(parts, names);
    check_partition(parts, names);
    Image merged;
    merged.full_width = merged.x1 = parts.front().full_width;
    merged.full_height = merged.y1 = parts.front().full_height;
    merge_attributes(parts, names, merged);
    for (size_t i = 0; i < parts.front().layers.size(); ++i) {
        const Layer& layer = parts.front().layers[i];
        merged.layers.push_back(
            {layer.name, layer.channels, std::vector<float>(merged.pixel_count() * layer.channel_count())});
        for (const Image& part : parts)
            copy_part(part, i, merged);
    }
    return merged;
}

}  // namespace obscura
