// SPDX-License-Identifier: Apache-2.0
// A finished picture: named layers of float channels and the header's facts. The only parts of obscura that
// know OpenEXR are film/exr_read.cpp and film/exr_write.cpp.
#pragma once

#include "base/math.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace obscura {

// One layer, for example name "specular.direct" with channels R, G, B. The beauty layer has an empty name
// (channels R, G, B, A at the root of the EXR file). A layer named like its channel, "Z" with channel Z, also
// stands at the root, where EXR readers look for depth.
struct Layer {
    std::string name;
    std::vector<std::string> channels;
    std::vector<float> pixels;  // [(y * width + x) * channels.size() + channel], rows from the top

    size_t channel_count() const { return channels.size(); }
    // The channel's index, or channel_count() if there is none of that name.
    size_t find_channel(const std::string& channel) const;
    // Name and channel as the EXR file spells them: "R", "Z", "specular.direct.R".
    std::string channel_path(size_t channel) const;
    // The name for people: "beauty" for the empty one.
    std::string title() const { return name.empty() ? "beauty" : name; }
};

// The beauty layer's name among Blender's names (film/blender_names.h).
inline constexpr const char* BLENDER_BEAUTY = "ViewLayer.Combined";

using Attribute = std::variant<std::string, double, int64_t, V3d, M44d>;

// "0.5", "(1, 2, 3)": an attribute for messages.
std::string attribute_text(const Attribute& attribute);

struct Image {
    // The whole picture's size, and the part of it that is here: [x0, x1) x [y0, y1).
    int32_t full_width = 0;
    int32_t full_height = 0;
    int32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    std::vector<Layer> layers;
    std::map<std::string, Attribute> attributes;  // the names stand in film/attributes.h

    int32_t width() const { return x1 - x0; }
    int32_t height() const { return y1 - y0; }
    size_t pixel_count() const { return static_cast<size_t>(width()) * static_cast<size_t>(height()); }
    const Layer* find_layer(const std::string& name) const;  // nullptr if there is none
    const Layer* beauty() const;  // under either of its names; nullptr if there is none
};

// Float channels, ZIP-compressed scanlines, display window = the whole picture, data window = the part.
// half_color writes layers with channels R, G, B or Y alone as half, except variances; values beyond half's 65504 become
// infinite, with a warning. Integer attributes beyond 32 bits are written as decimal text, which read_exr
// turns back. Atomic. Throws InputError.
void write_exr(const Image& image, const std::filesystem::path& path, bool half_color = false);

// Beauty is the root's R, G, B, A or Y; layers follow in alphabetic order, channels as R G B A, X Y Z W, U V.
// Attributes of types that Attribute lacks are ignored. Throws InputError with the file's name for anything
// that is not a whole, single-part EXR of flat float or half channels with its data inside the display
// window.
Image read_exr(const std::filesystem::path& path);

// The beauty layer as an 8-bit PNG: exposure in stops, then the tone curve documented in film/preview.h.
// Pixels outside the data window are transparent black. Atomic. Throws InputError.
void write_preview_png(const Image& image, const std::filesystem::path& path, double exposure_stops);

// Parts of one picture (disjoint crops) into one, exactly. Throws InputError when sizes, layers or the facts
// that must agree (seed, spp, camera ...; see film/attributes.h) differ, when parts overlap, or when a pixel
// is missing. names: the parts' files, for the messages.
Image merge_images(const std::vector<Image>& parts, const std::vector<std::string>& names);

}  // namespace obscura
