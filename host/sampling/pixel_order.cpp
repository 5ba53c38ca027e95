// SPDX-License-Identifier: Apache-2.0
#include "sampling/pixel_order.h"

#include <cstddef>
#include <utility>

namespace obscura {
namespace {

constexpr uint32_t LARGEST_TILE = 32;

class TileWalk {
  public:
    TileWalk(uint32_t width, uint32_t height) : width_(width), height_(height) {
        order_.reserve(std::size_t{width} * height);
    }

    // Appends the pixels of the size × size tile at (x, y) that lie in the picture. size: a power of two.
    void visit(uint32_t x, uint32_t y, uint32_t size) {
        if (x >= width_ || y >= height_) return;
        if (size == 1) {
            order_.push_back(y * width_ + x);
            return;
        }
        const uint32_t half = size / 2;
        visit(x, y, half);
        visit(x + half, y, half);
        visit(x, y + half, half);
        visit(x + half, y + half, half);
    }

    std::vector<uint32_t> take() { return std::move(order_); }

  private:
    uint32_t width_, height_;
    std::vector<uint32_t> order_;
};

}  // namespace

std::vector<uint32_t> tiled_pixel_order(uint32_t width, uint32_t height) {
    TileWalk walk(width, height);
    for (uint32_t y = 0; y < height; y += LARGEST_TILE)
        for (uint32_t x = 0; x < width; x += LARGEST_TILE)
            walk.visit(x, y, LARGEST_TILE);
    return walk.take();
}

}  // namespace obscura
