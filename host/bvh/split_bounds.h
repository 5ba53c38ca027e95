// SPDX-License-Identifier: Apache-2.0
// Extents of points in double, rounded outward to boxes of floats, and the innermost function of a build with spatial splits,
// which a build of 30 000 triangles calls three million times: in vectors of two doubles, which any processor has, and here, so
// that the builder's callback takes it in.
#pragma once

#include "base/math.h"

#include <array>
#include <cstddef>
#include <limits>

namespace obscura {

constexpr double ENDLESS = std::numeric_limits<double>::infinity();

using Lanes = double __attribute__((vector_size(16)));

inline Lanes least(const Lanes& a, const Lanes& b) {
    return a < b ? a : b;
}
inline Lanes most(const Lanes& a, const Lanes& b) {
    return a > b ? a : b;
}

// A point, or one of the two ends of an extent.
struct LanePoint {
    Lanes xy, z;  // the last lane means nothing

    LanePoint() = default;
    LanePoint(const Lanes& first, const Lanes& last) : xy(first), z(last) {}
    explicit LanePoint(const V3d& v) : xy{v.x, v.y}, z{v.z, 0} {}
    explicit LanePoint(const V3f& v) : LanePoint(V3d(v)) {}

    // Without a store of one lane, which a load of both would have to wait for.
    static LanePoint with(int axis, double value, double others) {
        const auto index = static_cast<double>(axis);
        return {Lanes{index, index} == Lanes{0, 1} ? Lanes{value, value} : Lanes{others, others},
                Lanes{index, index} == Lanes{2, 2} ? Lanes{value, value} : Lanes{others, others}};
    }
};

inline LanePoint least(const LanePoint& a, const LanePoint& b) {
    return {least(a.xy, b.xy), least(a.z, b.z)};
}
inline LanePoint most(const LanePoint& a, const LanePoint& b) {
    return {most(a.xy, b.xy), most(a.z, b.z)};
}

// The smallest box of points.
struct Extent {
    LanePoint lower{V3d(ENDLESS)};
    LanePoint upper{V3d(-ENDLESS)};

    Extent() = default;
    explicit Extent(const LanePoint& point) : lower(point), upper(point) {}
    Extent(const LanePoint& a, const LanePoint& b) : lower(least(a, b)), upper(most(a, b)) {}

    explicit Extent(const Box3f& box) : lower(box.min), upper(box.max) {}

    bool is_empty() const { return lower.xy[0] > upper.xy[0]; }
    void extend(const Extent& other) {
        lower = least(lower, other.lower);
        upper = most(upper, other.upper);
    }
};

// Outward rounding: a corner lerp(a, b, t) in double is wrong by a few of its ulps, its conversion to float
// by half an ulp, both of the largest coordinate: 2^-24 and a little. The second term is for denormal floats.
inline Lanes rounding_margin(const Lanes& lower, const Lanes& upper) {
    return 0x1p-23 * most(most(lower, -lower), most(upper, -upper)) + 0x1p-149;
}

// The extent rounded outward, cut down to the cell. Empty if either is, or if they don't meet.
inline Box3f rounded(const Extent& extent, const Extent& cell) {
    if (extent.is_empty()) return Box3f();
    const Lanes margin_xy = rounding_margin(extent.lower.xy, extent.upper.xy);
    const Lanes margin_z = rounding_margin(extent.lower.z, extent.upper.z);
    // Conversion to float is monotonic and leaves the cell's floats as they are, so it may come last.
    const Lanes lower_xy = most(extent.lower.xy - margin_xy, cell.lower.xy);
    const Lanes lower_z = most(extent.lower.z - margin_z, cell.lower.z);
    const Lanes upper_xy = least(extent.upper.xy + margin_xy, cell.upper.xy);
    const Lanes upper_z = least(extent.upper.z + margin_z, cell.upper.z);
    const V3f lower(static_cast<float>(lower_xy[0]), static_cast<float>(lower_xy[1]),
                    static_cast<float>(lower_z[0]));
    const V3f upper(static_cast<float>(upper_xy[0]), static_cast<float>(upper_xy[1]),
                    static_cast<float>(upper_z[0]));
    const bool apart = lower.x > upper.x || lower.y > upper.y || lower.z > upper.z;
    return apart ? Box3f() : Box3f(lower, upper);
}

// Bounds of a triangle's parts on both sides of one plane, cut down to the cell. They hold what clipped_bounds() (clip.h) of
// the two halves of the cell would, and may be larger.
struct SplitBounds {
    Box3f below;
    Box3f above;
};

__attribute__((always_inline)) inline SplitBounds split_bounds(const std::array<V3f, 3>& triangle,
                                                               const Box3f& cell, int axis, float position) {
    const auto plane = static_cast<double>(position);
    std::array<double, 3> from_plane;
    for (size_t i = 0; i < 3; ++i)
        from_plane[i] = static_cast<double>(triangle[i][axis]) - plane;
    Extent below, above;
    const size_t corners_above =
        size_t{from_plane[0] > 0} | size_t{from_plane[1] > 0} << 1 | size_t{from_plane[2] > 0} << 2;
    if (corners_above == 0 || corners_above == 7) {  // not cut; corners in the plane are on both sides
        for (size_t i = 0; i < 3; ++i) {
            const Extent corner{LanePoint(triangle[i])};
            if (from_plane[i] <= 0) below.extend(corner);
            if (from_plane[i] >= 0) above.extend(corner);
        }
    } else {
        // One corner is alone on its side. An edge that ends in the plane crosses it in that very corner.
        constexpr std::array<size_t, 7> ALONE{0, 0, 1, 2, 2, 1, 0};
        const size_t alone = ALONE[corners_above];
        const size_t next = alone < 2 ? alone + 1 : 0;
        const size_t last = alone > 0 ? alone - 1 : 2;
        const LanePoint a(triangle[alone]), b(triangle[next]), c(triangle[last]);
        const auto crossing = [](const LanePoint& from, const LanePoint& to, double from_distance,
                                 double to_distance) {
            if (from_distance == 0) return from;
            if (to_distance == 0) return to;
            const double t = from_distance / (from_distance - to_distance);
            return LanePoint(from.xy + (to.xy - from.xy) * t, from.z + (to.z - from.z) * t);
        };
        const Extent cut(crossing(a, b, from_plane[alone], from_plane[next]),
                         crossing(c, a, from_plane[last], from_plane[alone]));
        const bool is_above = (corners_above & (corners_above - 1)) == 0;
        (is_above ? above : below) = Extent(a);
        (is_above ? below : above) = Extent(b, c);
        above.extend(cut);
        below.extend(cut);
    }
    Extent below_cell(cell), above_cell(cell);
    below_cell.upper = least(below_cell.upper, LanePoint::with(axis, plane, ENDLESS));
    above_cell.lower = most(above_cell.lower, LanePoint::with(axis, plane, -ENDLESS));
    return {rounded(below, below_cell), rounded(above, above_cell)};
}

}  // namespace obscura
