// SPDX-License-Identifier: Apache-2.0
// The silhouette of the scene seen along a direction, rasterised. Light that passes the scene's outermost
// surfaces doesn't count again, so a sun on a roof doesn't light the room below it.
#include "scene/radiometry.h"

#include <algorithm>
#include <cmath>

namespace obscura {

namespace {

constexpr int RASTER_SIZE = 1024;

using Point = Imath::V2d;

class Raster {
  public:
    Raster(const Point& low, const Point& high)
        : low_(low), pixel_((high - low) / RASTER_SIZE), covered_(size_t{RASTER_SIZE} * RASTER_SIZE, false) {}

    // Marks the pixels whose centres lie in the triangle.
    void fill(const std::array<Point, 3>& triangle) {
        std::array<Point, 3> p;
        for (size_t k = 0; k < 3; ++k)
            p[k] = Point((triangle[k].x - low_.x) / pixel_.x, (triangle[k].y - low_.y) / pixel_.y);
        const auto [bottom, top] = std::minmax({p[0].y, p[1].y, p[2].y});
        for (int row = first_center(bottom); row <= last_center(top); ++row)
            fill_row(row, p);
    }

    double covered_area() const {
        return static_cast<double>(std::count(covered_.begin(), covered_.end(), true)) * pixel_.x * pixel_.y;
    }

  private:
    // Pixels of a row or column whose centres lie at or after, at or before x.
    static int first_center(double x) {
        return static_cast<int>(std::clamp(std::ceil(x - 0.5), 0.0, 1.0 * RASTER_SIZE));
    }
    static int last_center(double x) {
        return static_cast<int>(std::clamp(std::floor(x - 0.5), -1.0, RASTER_SIZE - 1.0));
    }

    // The span between the crossings of the triangle's edges with the row's centre line.
    void fill_row(int row, const std::array<Point, 3>& p) {
        const double y = row + 0.5;
        double left = RASTER_SIZE, right = 0;
        for (size_t k = 0; k < 3; ++k) {
            const Point& a = p[k];
            const Point& b = p[(k + 1) % 3];
            if (y < std::min(a.y, b.y) || y > std::max(a.y, b.y) || a.y == b.y) continue;
            const double x = a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
            left = std::min(left, x);
            right = std::max(right, x);
        }
        const auto begin = covered_.begin() + static_cast<std::ptrdiff_t>(row) * RASTER_SIZE;
        for (int column = first_center(left); column <= last_center(right); ++column)
            begin[column] = true;
    }

    Point low_, pixel_;
    std::vector<bool> covered_;
};

}  // namespace

double lit_area(const Scene& scene, const V3f& direction) {
    const V3d forward = V3d(direction).normalized();
    const V3d helper = std::abs(forward.y) < 0.9 ? V3d(0, 1, 0) : V3d(1, 0, 0);
    const V3d right = helper.cross(forward).normalized();
    const V3d up = forward.cross(right);
    const auto project = [&](const V3f& position) {
        return Point(V3d(position).dot(right), V3d(position).dot(up));
    };
    Imath::Box2d bounds;
    for (uint32_t i = 0; i < scene.triangles.size(); ++i) {
        for (int k = 0; k < 3; ++k)
            bounds.extendBy(project(scene.corner(i, k).position));
    }
    if (bounds.isEmpty() || !(bounds.size().x > 0) || !(bounds.size().y > 0)) return 0;
    Raster raster(bounds.min, bounds.max);
    for (uint32_t i = 0; i < scene.triangles.size(); ++i)
        raster.fill({project(scene.corner(i, 0).position), project(scene.corner(i, 1).position),
                     project(scene.corner(i, 2).position)});
    return raster.covered_area();
}

}  // namespace obscura
