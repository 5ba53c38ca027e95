// SPDX-License-Identifier: Apache-2.0
// A canvas of the whole picture's size for 8-bit PNG files. Internal to film.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "film/image.h"

namespace obscura {

using Rgb8 = std::array<uint8_t, 3>;  // sRGB encoded

class PngCanvas {
  public:
    // All pixels start transparent black; below the picture there may be more rows.
    explicit PngCanvas(const Image& image, uint32_t rows_below = 0);

    // Sets an opaque pixel; x and y count from the whole picture's corner.
    void set(int32_t x, int32_t y, const Rgb8& color);
    // Atomic. Throws InputError.
    void write(const std::filesystem::path& path) const;

  private:
    uint32_t width_;
    uint32_t height_;
    std::vector<uint8_t> rgba_;
};

}  // namespace obscura
