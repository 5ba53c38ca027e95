// SPDX-License-Identifier: Apache-2.0
// Image -> OpenEXR. The library writes through FileWriter, because its own stream and its destructor, which
// writes the table of line offsets last, both swallow a full disk.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfVecAttribute.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/log.h"
#include "base/units.h"
#include "film/attributes.h"
#include "film/exr.h"
#include "film/image.h"

namespace obscura {
namespace {

class FileStream : public Imf::OStream {
  public:
    FileStream(FileWriter& file, const std::string& name) : Imf::OStream(name.c_str()), file_(file) {}
    void write(const char bytes[], int count) override { file_.write(bytes, static_cast<size_t>(count)); }
    uint64_t tellp() override { return file_.position(); }
    void seekp(uint64_t position) override { file_.seek(position); }

  private:
    FileWriter& file_;
};

void check_image(const Image& image) {
    OBSCURA_CHECK(image.x0 >= 0 && image.x0 < image.x1 && image.x1 <= image.full_width && image.y0 >= 0 &&
                      image.y0 < image.y1 && image.y1 <= image.full_height,
                  "data window [{}, {}) x [{}, {}) in {} x {}", image.x0, image.x1, image.y0, image.y1,
                  image.full_width, image.full_height);
    std::set<std::string> paths;
    for (const Layer& layer : image.layers) {
        OBSCURA_CHECK(layer.pixels.size() == image.pixel_count() * layer.channel_count(),
                      "layer {} has {} values", layer.title(), layer.pixels.size());
        for (size_t channel = 0; channel < layer.channel_count(); ++channel) {
            const std::string path = layer.channel_path(channel);
            OBSCURA_CHECK(paths.insert(path).second, "two channels are called {}", path);
        }
    }
    OBSCURA_CHECK(!paths.empty(), "an image without channels");
}

// Colours, grey ones (Y alone) too, bear half's 11 bits; positions, normals, depths and the variances of z-tests don't.
bool is_color(const Layer& layer) {
    const size_t none = layer.channel_count();
    const bool is_rgb =
        layer.find_channel("R") < none && layer.find_channel("G") < none && layer.find_channel("B") < none;
    const bool is_grey = layer.channels == std::vector<std::string>{"Y"};
    return (is_rgb || is_grey) && layer.name.find("Variance") == std::string::npos;
}

void insert_integer(Imf::Header& header, const std::string& name, int64_t value) {
    using Limits = std::numeric_limits<int32_t>;
    if (value >= Limits::min() && value <= Limits::max()) {
        header.insert(name, Imf::IntAttribute(static_cast<int>(value)));
    } else {
        header.insert(name, Imf::StringAttribute(fmt::format("{}", value)));
    }
}

// The two matrices that OpenEXR defines are float there, and other programs look for them so.
void insert_matrix(Imf::Header& header, const std::string& name, const M44d& value) {
    if (name == attribute::WORLD_TO_CAMERA || name == attribute::WORLD_TO_NDC) {
        header.insert(name, Imf::M44fAttribute(Imath::M44f(value)));
    } else {
        header.insert(name, Imf::M44dAttribute(value));
    }
}

struct InsertAttribute {
    Imf::Header& header;
    const std::string& name;

    void operator()(const std::string& value) const { header.insert(name, Imf::StringAttribute(value)); }
    void operator()(double value) const { header.insert(name, Imf::DoubleAttribute(value)); }
    void operator()(int64_t value) const { insert_integer(header, name, value); }
    void operator()(const V3d& value) const { header.insert(name, Imf::V3dAttribute(value)); }
    void operator()(const M44d& value) const { insert_matrix(header, name, value); }
};

Imf::Header make_header(const Image& image) {
    const Imath::Box2i display({0, 0}, {image.full_width - 1, image.full_height - 1});
    const Imath::Box2i data({image.x0, image.y0}, {image.x1 - 1, image.y1 - 1});
    Imf::Header header(display, data, 1, {0, 0}, 1, Imf::INCREASING_Y, Imf::ZIP_COMPRESSION);
    for (const auto& [name, value] : image.attributes) {
        OBSCURA_CHECK(!exr::is_structural(name), "OpenEXR keeps the attribute name {} for itself", name);
        std::visit(InsertAttribute{header, name}, value);
    }
    return header;
}

std::vector<half> to_half(const Layer& layer, const std::filesystem::path& path) {
    std::vector<half> halves(layer.pixels.size());
    size_t overflow_count = 0;
    for (size_t i = 0; i < halves.size(); ++i) {
        halves[i] = half(layer.pixels[i]);
        if (halves[i].isInfinity() && std::isfinite(layer.pixels[i])) ++overflow_count;
    }
    if (overflow_count > 0) {
        log_warning(
            "{}: in the layer {}, {} beyond 65504, the largest half, became infinite; float channels keep "
            "such values.",
            path.string(), layer.title(), counted(overflow_count, "value"));
    }
    return halves;
}

// Adds the layer's interleaved values as slices; pixels must outlive the frame buffer.
template <typename Value>
void add_slices(const Layer& layer, const std::vector<Value>& pixels, Imf::PixelType type,
                Imf::Header& header, Imf::FrameBuffer& frame) {
    const size_t pixel_bytes = sizeof(Value) * layer.channel_count();
    const Imath::Box2i& window = header.dataWindow();
    const size_t row_bytes = pixel_bytes * static_cast<size_t>(window.max.x - window.min.x + 1);
    for (size_t channel = 0; channel < layer.channel_count(); ++channel) {
        const std::string path = layer.channel_path(channel);
        header.channels().insert(path, Imf::Channel(type));
        frame.insert(path, Imf::Slice::Make(type, &pixels[channel], window, pixel_bytes, row_bytes));
    }
}

}  // namespace

void write_exr(const Image& image, const std::filesystem::path& path, bool half_color) {
    check_image(image);
    exr::start_threads();
    Imf::Header header = make_header(image);
    Imf::FrameBuffer frame;
    std::vector<std::vector<half>> halves;
    halves.reserve(image.layers.size());  // the frame points into them
    for (const Layer& layer : image.layers) {
        if (half_color && is_color(layer)) {
            halves.push_back(to_half(layer, path));
            add_slices(layer, halves.back(), Imf::HALF, header, frame);
        } else {
            add_slices(layer, layer.pixels, Imf::FLOAT, header, frame);
        }
    }
    write_atomically(path, [&](const std::filesystem::path& temporary) {
        FileWriter file(temporary, path);
        {
            FileStream stream(file, path.string());
            Imf::OutputFile output(stream, header);
            output.setFrameBuffer(frame);
            output.writePixels(image.height());
        }
        file.close();
    });
}

}  // namespace obscura
