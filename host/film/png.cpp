// SPDX-License-Identifier: Apache-2.0
// Encodes through libpng's simplified interface: in memory, without setjmp; it tags the file as sRGB.
#include "film/png.h"

#include <png.h>

#include <algorithm>

#include "base/error.h"
#include "base/file.h"

namespace obscura {

PngCanvas::PngCanvas(const Image& image, uint32_t rows_below)
    : width_(static_cast<uint32_t>(image.full_width)),
      height_(static_cast<uint32_t>(image.full_height) + rows_below),
      rgba_(size_t{4} * width_ * height_) {}

void PngCanvas::set(int32_t x, int32_t y, const Rgb8& color) {
    const size_t pixel = static_cast<size_t>(y) * width_ + static_cast<size_t>(x);
    std::copy(color.begin(), color.end(), &rgba_[4 * pixel]);
    rgba_[4 * pixel + 3] = 255;
}

void PngCanvas::write(const std::filesystem::path& path) const {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = width_;
    png.height = height_;
    png.format = PNG_FORMAT_RGBA;
    png_alloc_size_t byte_count = PNG_IMAGE_PNG_SIZE_MAX(png);
    std::vector<std::byte> encoded(byte_count);
    const int done =
        png_image_write_to_memory(&png, encoded.data(), &byte_count, 0, rgba_.data(), 0, nullptr);
    if (done == 0) throw InputError("{}: can't be written as PNG: {}", path.string(), png.message);
    encoded.resize(byte_count);
    write_bytes(path, encoded);
}

}  // namespace obscura
