// SPDX-License-Identifier: Apache-2.0
// Colour of textures on the host: samples, and exact means over triangles of texture space. The conventions
// are those of the kernels' sampler: texel (i, j) covers [i, i+1) x [j, j+1) in units of texels, its value
// stands at the centre, colours are decoded before they are filtered.
#pragma once

#include "scene/scene.h"

#include <array>
#include <vector>

namespace obscura {

// Integrals of one texture's linear colour over regions of texture space, with its wrap and filter modes.
// Keeps a reference to the texture.
class TextureIntegral {
  public:
    explicit TextureIntegral(const Texture& texture);

    // Mean colour over the triangle with these corners in uv: exact but for rounding. A triangle without area
    // in uv (a line, a point) is sampled; one beyond 2^31 texels, where float uv mean nothing, gets the mean
    // of the whole texture.
    RgbD mean(const std::array<V2f, 3>& uv) const;

    // The filtered colour at one point; x = u * width, y = v * height.
    RgbD sample(double x, double y) const;

  private:
    using Point = Imath::V2d;

    RgbD texel(int64_t i, int64_t j) const;
    RgbD prefix(int64_t j, int64_t i) const;
    RgbD row_integral(int64_t i, int64_t j, double x) const;
    RgbD area_integral(int64_t i, int64_t j, const Point& at) const;
    RgbD edge_integral(const Point& from, const Point& to) const;
    RgbD mean_by_sampling(const std::array<Point, 3>& corners) const;

    const Texture& texture_;
    int64_t width_, height_;
    bool linear_;
    std::vector<RgbD> prefixes_;  // per row width + 1 sums: of the first 0, 1, ... texels
};

}  // namespace obscura
