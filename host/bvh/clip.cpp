// SPDX-License-Identifier: Apache-2.0
// Sutherland-Hodgman clipping against axis-aligned planes. Corners are computed in double from float input: their error is
// far below one float ulp and covered by the rounding of the bounds.
#include "bvh/clip.h"

#include "base/error.h"
#include "bvh/split_bounds.h"

namespace obscura {

Polygon::Polygon(const std::array<V3f, 3>& triangle) {
    for (const V3f& vertex : triangle)
        push(V3d(vertex));
}

void Polygon::push(const V3d& point) {
    OBSCURA_CHECK(count < CAPACITY, "a clipped triangle has more than {} corners", CAPACITY);
    corner[static_cast<size_t>(count++)] = point;
}

double Polygon::area() const {
    V3d twice(0, 0, 0);
    for (size_t i = 2; i < static_cast<size_t>(count); ++i)
        twice += (corner[i - 1] - corner[0]).cross(corner[i] - corner[0]);
    return 0.5 * twice.length();
}

Polygon clip(const Polygon& polygon, int axis, double position, Side side) {
    const double sign = side == Side::below ? -1 : 1;
    Polygon result;
    for (int i = 0; i < polygon.count; ++i) {
        const V3d& a = polygon.corner[static_cast<size_t>(i)];
        const V3d& b = polygon.corner[static_cast<size_t>(i + 1 < polygon.count ? i + 1 : 0)];
        const double from_a = sign * (a[axis] - position);  // >= 0: on the side that stays
        const double from_b = sign * (b[axis] - position);
        if (from_a >= 0) result.push(a);
        if ((from_a < 0 && from_b > 0) || (from_a > 0 && from_b < 0)) {
            V3d crossing = a + (b - a) * (from_a / (from_a - from_b));
            crossing[axis] = position;
            result.push(crossing);
        }
    }
    return result;
}

Box3f clipped_bounds(const std::array<V3f, 3>& triangle, const Box3f& cell) {
    Polygon part(triangle);
    for (int axis = 0; axis < 3; ++axis) {
        part = clip(part, axis, static_cast<double>(cell.min[axis]), Side::above);
        part = clip(part, axis, static_cast<double>(cell.max[axis]), Side::below);
    }
    Extent extent;
    for (int i = 0; i < part.count; ++i)
        extent.extend(Extent(LanePoint(part.corner[static_cast<size_t>(i)])));
    return rounded(extent, Extent(cell));
}

}  // namespace obscura
