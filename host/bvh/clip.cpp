// SPDX-License-Identifier: Apache-2.0
// Sutherland-Hodgman clipping against axis-aligned planes and outward rounding of the result. Corners are
// computed in double from float input: their error is far below one float ulp and covered by the rounding.
#include "bvh/clip.h"

#include "base/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace obscura {
namespace {

// Outward rounding: a corner lerp(a, b, t) in double is wrong by a few of its ulps, its conversion to float
// by half an ulp, both of the largest coordinate: 2^-24 and a little. The second term is for denormal floats.
constexpr double ROUNDING = 0x1p-23;
constexpr double SMALLEST_FLOAT = 0x1p-149;

// Imath's boxes extend by branches, which are mispredicted half the time here.
struct Extent {
    V3d lower{std::numeric_limits<double>::infinity()};
    V3d upper{-std::numeric_limits<double>::infinity()};

    void extend(const V3d& point) {
        for (int axis = 0; axis < 3; ++axis) {
            lower[axis] = std::min(lower[axis], point[axis]);
            upper[axis] = std::max(upper[axis], point[axis]);
        }
    }
};

// The extent rounded outward, cut down to the cell. Empty if either is, or if they don't meet.
Box3f rounded(const Extent& extent, const Box3f& cell) {
    if (extent.lower.x > extent.upper.x) return Box3f();
    Box3f box;
    for (int axis = 0; axis < 3; ++axis) {
        const double largest = std::max(std::abs(extent.lower[axis]), std::abs(extent.upper[axis]));
        const double margin = ROUNDING * largest + SMALLEST_FLOAT;
        box.min[axis] = std::max(static_cast<float>(extent.lower[axis] - margin), cell.min[axis]);
        box.max[axis] = std::min(static_cast<float>(extent.upper[axis] + margin), cell.max[axis]);
    }
    const bool apart = box.min.x > box.max.x || box.min.y > box.max.y || box.min.z > box.max.z;
    return apart ? Box3f() : box;
}

}  // namespace

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
        extent.extend(part.corner[static_cast<size_t>(i)]);
    return rounded(extent, cell);
}

// The innermost function of a build with spatial splits: both sides in one pass over the edges.
SplitBounds split_bounds(const std::array<V3f, 3>& triangle, const Box3f& cell, int axis, float position) {
    const auto plane = static_cast<double>(position);
    const std::array<V3d, 3> corner{V3d(triangle[0]), V3d(triangle[1]), V3d(triangle[2])};
    Extent below;
    Extent above;
    for (size_t i = 0; i < 3; ++i) {
        const V3d& a = corner[i];
        const V3d& b = corner[i < 2 ? i + 1 : 0];
        const double from_a = a[axis] - plane;
        const double from_b = b[axis] - plane;
        if (from_a <= 0) below.extend(a);
        if (from_a >= 0) above.extend(a);
        if ((from_a < 0 && from_b > 0) || (from_a > 0 && from_b < 0)) {
            const V3d crossing = a + (b - a) * (from_a / (from_a - from_b));
            below.extend(crossing);
            above.extend(crossing);
        }
    }
    Box3f below_cell = cell;
    Box3f above_cell = cell;
    below_cell.max[axis] = std::min(cell.max[axis], position);
    above_cell.min[axis] = std::max(cell.min[axis], position);
    return {rounded(below, below_cell), rounded(above, above_cell)};
}

}  // namespace obscura
