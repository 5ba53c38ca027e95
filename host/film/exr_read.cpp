// SPDX-License-Identifier: Apache-2.0
// OpenEXR -> Image. Every file is suspect: what the header claims is checked before memory is taken for it.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTestFile.h>
#include <OpenEXR/ImfThreading.h>
#include <OpenEXR/ImfVecAttribute.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <tuple>

#include "base/error.h"
#include "base/file.h"
#include "film/exr.h"
#include "film/image.h"

namespace obscura {
namespace exr {

bool is_structural(const std::string& attribute_name) {
    constexpr std::array<std::string_view, 13> NAMES = {
        "channels",  "chunkCount", "compression",      "dataWindow",         "displayWindow",
        "lineOrder", "name",       "pixelAspectRatio", "screenWindowCenter", "screenWindowWidth",
        "tiles",     "type",       "version"};
    return std::find(NAMES.begin(), NAMES.end(), attribute_name) != NAMES.end();
}

void start_threads() {
    [[maybe_unused]] static const bool started = [] {
        Imf::setGlobalThreadCount(static_cast<int>(std::thread::hardware_concurrency()));
        return true;
    }();
}

}  // namespace exr

namespace {

// A file of n bytes can't hold more than this times n bytes of pixels. Far above what the compressors reach
// on a constant picture (deflate: 1032), far below what a damaged header may ask for.
constexpr double MAX_COMPRESSION = 65536;

// An integer that didn't fit into EXR's 32 bits when it was written.
std::optional<int64_t> parse_wide_integer(const std::string& text) {
    int64_t value = 0;
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    const bool is_wide =
        value > std::numeric_limits<int32_t>::max() || value < std::numeric_limits<int32_t>::min();
    if (error != std::errc{} || rest != end || !is_wide || fmt::format("{}", value) != text) return {};
    return value;
}

std::optional<Attribute> to_attribute(const Imf::Attribute& attribute) {
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute)) {
        if (const auto integer = parse_wide_integer(text->value())) return *integer;
        return text->value();
    }
    if (const auto* value = dynamic_cast<const Imf::DoubleAttribute*>(&attribute)) return value->value();
    if (const auto* value = dynamic_cast<const Imf::FloatAttribute*>(&attribute))
        return static_cast<double>(value->value());
    if (const auto* value = dynamic_cast<const Imf::IntAttribute*>(&attribute))
        return int64_t{value->value()};
    if (const auto* value = dynamic_cast<const Imf::V3dAttribute*>(&attribute)) return value->value();
    if (const auto* value = dynamic_cast<const Imf::V3fAttribute*>(&attribute)) return V3d(value->value());
    if (const auto* value = dynamic_cast<const Imf::M44dAttribute*>(&attribute)) return value->value();
    if (const auto* value = dynamic_cast<const Imf::M44fAttribute*>(&attribute)) return M44d(value->value());
    return {};
}

// Where a channel belongs: "a.b.R" to layer a.b; R, G, B, A and Y at the root to beauty; another root channel
// is a layer of its own.
std::pair<std::string, std::string> split_channel(const std::string& path) {
    const size_t dot = path.rfind('.');
    if (dot != std::string::npos && dot > 0 && dot + 1 < path.size()) {
        return {path.substr(0, dot), path.substr(dot + 1)};
    }
    const bool is_beauty = path.size() == 1 && std::string_view("RGBAY").find(path) != std::string_view::npos;
    return {is_beauty ? "" : path, path};
}

// EXR stores channels alphabetically; within a layer, colours and coordinates have their own order.
bool channel_before(const std::string& a, const std::string& b) {
    const auto key = [](const std::string& channel) {
        const size_t place =
            channel.size() == 1 ? std::string_view("RGBAXYZWUVuv").find(channel) : std::string_view::npos;
        return std::tuple(place, std::string_view(channel));
    };
    return key(a) < key(b);
}

// The layers of the file, without pixels, sorted by name: a beauty without one comes first.
std::vector<Layer> list_layers(const Imf::ChannelList& channels, const std::string& file) {
    std::map<std::string, std::vector<std::string>> grouped;
    for (auto it = channels.begin(); it != channels.end(); ++it) {
        const Imf::Channel& channel = it.channel();
        if (channel.type != Imf::FLOAT && channel.type != Imf::HALF) {
            throw InputError("{}: channel {}: only float and half channels can be read", file, it.name());
        }
        if (channel.xSampling != 1 || channel.ySampling != 1) {
            throw InputError("{}: channel {}: subsampled channels can't be read", file, it.name());
        }
        const auto [layer, leaf] = split_channel(it.name());
        auto& leaves = grouped[layer];
        if (std::find(leaves.begin(), leaves.end(), leaf) != leaves.end()) {
            throw InputError("{}: the channels {} and {}.{} stand for the same layer", file, leaf, layer,
                             leaf);
        }
        leaves.push_back(leaf);
    }
    if (grouped.empty()) throw InputError("{}: there are no channels in it", file);
    std::vector<Layer> layers;
    for (auto& [name, leaves] : grouped) {
        std::sort(leaves.begin(), leaves.end(), channel_before);
        layers.push_back({name, leaves, {}});
    }
    return layers;
}

// Sizes and layers, checked against each other and against the file's length.
Image read_frame(const Imf::Header& header, const std::filesystem::path& path) {
    const std::string file = path.string();
    if (header.hasType() && Imf::isDeepData(header.type())) {
        throw InputError("{}: deep images can't be read", file);
    }
    const Imath::Box2i& display = header.displayWindow();
    const Imath::Box2i& data = header.dataWindow();
    if (data.min.x < display.min.x || data.min.y < display.min.y || data.max.x > display.max.x ||
        data.max.y > display.max.y) {
        throw InputError("{}: its data window reaches beyond its display window, which can't be read", file);
    }
    Image image;
    // The library has checked that the windows' corners lie within half of int's range.
    image.full_width = display.max.x - display.min.x + 1;
    image.full_height = display.max.y - display.min.y + 1;
    image.x0 = data.min.x - display.min.x;
    image.y0 = data.min.y - display.min.y;
    image.x1 = data.max.x - display.min.x + 1;
    image.y1 = data.max.y - display.min.y + 1;
    image.layers = list_layers(header.channels(), file);

    double pixel_bytes = 0;
    for (const Layer& layer : image.layers)
        pixel_bytes += static_cast<double>(sizeof(float) * layer.channel_count());
    const double bytes = pixel_bytes * image.width() * image.height();
    if (bytes > MAX_COMPRESSION * static_cast<double>(std::filesystem::file_size(path))) {
        throw InputError("{}: it is too short for the {} x {} pixels that its header announces", file,
                         image.width(), image.height());
    }
    return image;
}

void read_pixels(Imf::MultiPartInputFile& file, Image& image) {
    Imf::InputPart part(file, 0);
    const Imath::Box2i& window = part.header().dataWindow();
    Imf::FrameBuffer frame;
    for (Layer& layer : image.layers) {
        layer.pixels.resize(image.pixel_count() * layer.channel_count());
        const size_t pixel_bytes = sizeof(float) * layer.channel_count();
        const size_t row_bytes = pixel_bytes * static_cast<size_t>(image.width());
        for (size_t channel = 0; channel < layer.channel_count(); ++channel) {
            frame.insert(layer.channel_path(channel), Imf::Slice::Make(Imf::FLOAT, &layer.pixels[channel],
                                                                       window, pixel_bytes, row_bytes));
        }
    }
    part.setFrameBuffer(frame);
    part.readPixels(window.min.y, window.max.y);
}

Image read_image(const std::filesystem::path& path) {
    Imf::MultiPartInputFile file(path.c_str());
    if (file.parts() != 1) {
        throw InputError("{}: it has {} parts; only single-part files can be read", path.string(),
                         file.parts());
    }
    if (!file.partComplete(0)) throw InputError("{}: it is truncated: scanlines are missing", path.string());
    const Imf::Header& header = file.header(0);
    Image image = read_frame(header, path);
    for (auto it = header.begin(); it != header.end(); ++it) {
        if (exr::is_structural(it.name())) continue;
        if (auto value = to_attribute(it.attribute())) image.attributes.emplace(it.name(), std::move(*value));
    }
    read_pixels(file, image);
    return image;
}

}  // namespace

Image read_exr(const std::filesystem::path& path) {
    exr::start_threads();
    std::error_code error;
    if (std::filesystem::is_directory(path, error)) throw InputError("{}: it is a folder", path.string());
    if (!std::filesystem::exists(path, error)) throw InputError("{}: there is no such file", path.string());
    try {
        return read_image(path);
    } catch (const InputError&) {
        throw;
    } catch (const std::exception& reason) {  // the library's own words, which name the file or not
        throw InputError("{}: can't be read as an OpenEXR image: {}", path.string(), reason.what());
    }
}

}  // namespace obscura
