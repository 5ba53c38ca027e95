// SPDX-License-Identifier: Apache-2.0
// Convex polygons cut by axis-aligned planes, in double: what spatial splits and the structural check need to
// know which part of a triangle lies in a box.
#pragma once

#include "base/math.h"

#include <array>

namespace obscura {

// A triangle cut by axis-aligned planes has at most 3 + 6 corners; the rest is room for corners that rounding
// duplicates.
struct Polygon {
    static constexpr int CAPACITY = 24;
    std::array<V3d, CAPACITY> corner;
    int count = 0;  // 0 = nothing left

    Polygon() = default;
    explicit Polygon(const std::array<V3f, 3>& triangle);

    void push(const V3d& point);
    double area() const;
};

enum class Side { below, above };  // coordinate <= position, coordinate >= position

// The part of the polygon on one side of the plane; new corners lie on the plane exactly.
Polygon clip(const Polygon& polygon, int axis, double position, Side side);

// Bounds of the triangle's part inside the cell, rounded outward, but never beyond the cell; empty when
// nothing of the triangle is inside.
Box3f clipped_bounds(const std::array<V3f, 3>& triangle, const Box3f& cell);

}  // namespace obscura
