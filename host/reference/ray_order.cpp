// SPDX-License-Identifier: Apache-2.0
#include "reference/ray_order.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace obscura {
namespace {

constexpr uint32_t CELL_BITS = 10;  // per axis
constexpr float CELLS = 1 << CELL_BITS;

// Puts two zeros behind each of the low ten bits.
uint64_t spread_bits(uint32_t x) {
    x = (x | (x << 16)) & 0x030000ffu;
    x = (x | (x << 8)) & 0x0300f00fu;
    x = (x | (x << 4)) & 0x030c30c3u;
    x = (x | (x << 2)) & 0x09249249u;
    return x;
}

uint64_t sort_key(const TraceRay& ray, const Box3f& bounds) {
    uint64_t octant = 0;
    uint64_t morton = 0;
    for (int axis = 0; axis < 3; ++axis) {
        octant = octant << 1 | (std::signbit(ray.direction[axis]) ? 1u : 0u);
        const float size = bounds.max[axis] - bounds.min[axis];
        const float place = size > 0 ? (ray.origin[axis] - bounds.min[axis]) / size : 0;
        const auto cell = static_cast<uint32_t>(std::min(place * CELLS, CELLS - 1));
        morton |= spread_bits(cell) << axis;
    }
    return octant << (3 * CELL_BITS) | morton;
}

}  // namespace

std::vector<uint32_t> coherent_order(std::span<const TraceRay> rays) {
    Box3f bounds;
    for (const TraceRay& ray : rays)
        bounds.extendBy(ray.origin);
    std::vector<uint64_t> keys;
    keys.reserve(rays.size());
    for (const TraceRay& ray : rays)
        keys.push_back(sort_key(ray, bounds));
    std::vector<uint32_t> order(rays.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, {}, [&](uint32_t i) { return keys[i]; });
    return order;
}

}  // namespace obscura
