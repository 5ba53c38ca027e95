// SPDX-License-Identifier: Apache-2.0
// The order in which the camera visits a picture's pixels.
#pragma once

#include <cstdint>
#include <vector>

namespace obscura {

// The pixels 0 .. width * height - 1, counted in rows, tile by tile: tiles of 32 × 32, of 16 × 16 in those, and so on. The
// rays of neighbours in this order, and those that scatter from where they hit, share much of their way down the tree.
std::vector<uint32_t> tiled_pixel_order(uint32_t width, uint32_t height);

}  // namespace obscura
