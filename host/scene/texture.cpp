// SPDX-License-Identifier: Apache-2.0
// The mean of a texture f over a triangle T of texture space, exactly. By Green's theorem the integral of f
// over T is the integral of F dy along its edges, F(x, y) = int_0^x f(s, y) ds. Prefix sums of each row give
// F in constant time, so the work grows with the edges' length in texels, not with the area. Between lines of
// the texel grid F is a polynomial of degree <= 3 along an edge: two-point Gauss quadrature integrates it
// exactly.
#include "scene/texture.h"

#include <algorithm>
#include <cmath>

namespace obscura {

namespace {

constexpr int64_t MOST_CUTS = 1 << 16;  // beyond: equal pieces, since float uv can't resolve texels there
constexpr double LARGEST_COORDINATE = 0x1p31;  // texels
constexpr double MOST_SAMPLES_PER_SIDE = 64;   // of triangles without area in uv
const double GAUSS_OFFSET = 0.5 / std::sqrt(3.0);

int64_t floor_index(double x) {
    return static_cast<int64_t>(std::floor(x));
}

int64_t floor_division(int64_t a, int64_t b) {
    return a / b - (a % b < 0 ? 1 : 0);
}

int64_t wrap_index(Wrap wrap, int64_t i, int64_t size) {
    if (i >= 0 && i < size) return i;  // nearly always; divisions are slow
    if (wrap == Wrap::clamp_to_edge) return std::clamp<int64_t>(i, 0, size - 1);
    const int64_t period = wrap == Wrap::repeat ? size : 2 * size;
    const int64_t rest = i - floor_division(i, period) * period;
    return rest < size ? rest : period - 1 - rest;
}

RgbD linear_color(const uint8_t* code) {
    return {srgb_to_linear(code[0]), srgb_to_linear(code[1]), srgb_to_linear(code[2])};
}

// Parameters in (0, 1) at which an edge crosses the lines of the texel grid, with 0 and 1, ascending.
std::vector<double> grid_cuts(const Imath::V2d& from, const Imath::V2d& to) {
    std::vector<double> cuts{0, 1};
    for (int axis = 0; axis < 2; ++axis) {
        const double low = std::min(from[axis], to[axis]);
        const double high = std::max(from[axis], to[axis]);
        for (double line = std::floor(low) + 1; line < high; ++line)
            cuts.push_back((line - from[axis]) / (to[axis] - from[axis]));
    }
    std::sort(cuts.begin(), cuts.end());
    return cuts;
}

std::vector<double> equal_cuts() {
    std::vector<double> cuts(MOST_CUTS + 1);
    for (size_t i = 0; i < cuts.size(); ++i)
        cuts[i] = static_cast<double>(i) / MOST_CUTS;
    return cuts;
}

}  // namespace

TextureIntegral::TextureIntegral(const Texture& texture)
    : texture_(texture),
      width_(texture.width),
      height_(texture.height),
      linear_(texture.filter == TextureFilter::linear) {
    prefixes_.reserve(static_cast<size_t>((width_ + 1) * height_));
    for (int64_t j = 0; j < height_; ++j) {
        RgbD sum(0, 0, 0);
        prefixes_.push_back(sum);
        const uint8_t* const row = texture.rgba.data() + 4 * j * width_;
        for (int64_t i = 0; i < width_; ++i)
            prefixes_.push_back(sum += linear_color(row + 4 * i));
    }
}

RgbD TextureIntegral::texel(int64_t i, int64_t j) const {
    const int64_t column = wrap_index(texture_.wrap_u, i, width_);
    const int64_t row = wrap_index(texture_.wrap_v, j, height_);
    return linear_color(texture_.rgba.data() + 4 * (row * width_ + column));
}

// Sum of the texels 0 .. i-1 of row j; minus the texels i .. -1 for negative i.
RgbD TextureIntegral::prefix(int64_t j, int64_t i) const {
    const RgbD* row = prefixes_.data() + wrap_index(texture_.wrap_v, j, height_) * (width_ + 1);
    const auto real = [](int64_t n) { return static_cast<double>(n); };
    if (texture_.wrap_u == Wrap::clamp_to_edge) {
        if (i < 0) return real(i) * texel(0, j);
        if (i > width_) return row[width_] + real(i - width_) * texel(width_ - 1, j);
        return row[i];
    }
    const int64_t period = texture_.wrap_u == Wrap::repeat ? width_ : 2 * width_;
    const int64_t periods = floor_division(i, period);
    const int64_t rest = i - periods * period;
    const RgbD whole = real(periods) * real(period / width_) * row[width_];
    // The second half of a mirrored period runs backwards through the row.
    return whole + (rest <= width_ ? row[rest] : 2.0 * row[width_] - row[period - rest]);
}

// Integral of row j's filtered colour over [0, x], x in cell i.
RgbD TextureIntegral::row_integral(int64_t i, int64_t j, double x) const {
    const double u = x - static_cast<double>(i);
    if (!linear_) return prefix(j, i) + u * texel(i, j);
    const RgbD left = texel(i, j);
    const RgbD right = texel(i + 1, j);
    const RgbD whole_cells = 0.5 * (prefix(j, i) + prefix(j, i + 1) - prefix(j, 1));
    return whole_cells + u * left + (u * u / 2) * (right - left);
}

// F at a point of cell (i, j).
RgbD TextureIntegral::area_integral(int64_t i, int64_t j, const Point& at) const {
    if (!linear_) return row_integral(i, j, at.x);
    const double v = at.y - static_cast<double>(j);
    return (1 - v) * row_integral(i, j, at.x) + v * row_integral(i, j + 1, at.x);
}

RgbD TextureIntegral::edge_integral(const Point& from, const Point& to) const {
    const Point along = to - from;
    RgbD sum(0, 0, 0);
    if (along.y == 0) return sum;
    const bool few = std::abs(along.x) + std::abs(along.y) < static_cast<double>(MOST_CUTS);
    const std::vector<double> cuts = few ? grid_cuts(from, to) : equal_cuts();
    for (size_t piece = 0; piece + 1 < cuts.size(); ++piece) {
        const double length = cuts[piece + 1] - cuts[piece];
        const double middle = cuts[piece] + length / 2;
        const Point center = from + middle * along;
        const int64_t i = floor_index(center.x);
        const int64_t j = floor_index(center.y);
        for (const double offset : {-GAUSS_OFFSET, GAUSS_OFFSET})
            sum += (length / 2) * area_integral(i, j, from + (middle + offset * length) * along);
    }
    return sum * along.y;
}

RgbD TextureIntegral::sample(double x, double y) const {
    if (!linear_) return texel(floor_index(x), floor_index(y));
    const int64_t i = floor_index(x - 0.5);
    const int64_t j = floor_index(y - 0.5);
    const double u = x - 0.5 - static_cast<double>(i);
    const double v = y - 0.5 - static_cast<double>(j);
    return (1 - v) * ((1 - u) * texel(i, j) + u * texel(i + 1, j)) +
           v * ((1 - u) * texel(i, j + 1) + u * texel(i + 1, j + 1));
}

// Mean over the centroids of n * n congruent parts, n growing with the longest side in texels.
RgbD TextureIntegral::mean_by_sampling(const std::array<Point, 3>& corners) const {
    const double longest = std::max({(corners[1] - corners[0]).length(), (corners[2] - corners[1]).length(),
                                     (corners[0] - corners[2]).length()});
    const int n = static_cast<int>(std::clamp(std::ceil(4 * longest), 1.0, MOST_SAMPLES_PER_SIDE));
    RgbD sum(0, 0, 0);
    const auto add = [&](double a, double b) {
        const Point at =
            corners[0] + (a / n) * (corners[1] - corners[0]) + (b / n) * (corners[2] - corners[0]);
        sum += sample(at.x, at.y);
    };
    for (int i = 0; i < n; ++i) {
        for (int j = 0; i + j < n; ++j) {
            add(i + 1.0 / 3, j + 1.0 / 3);
            if (i + j + 1 < n) add(i + 2.0 / 3, j + 2.0 / 3);
        }
    }
    return sum / (static_cast<double>(n) * n);
}

RgbD TextureIntegral::mean(const std::array<V2f, 3>& uv) const {
    std::array<Point, 3> corners;
    double largest = 1;
    for (size_t k = 0; k < 3; ++k) {
        corners[k] = Point(static_cast<double>(uv[k].x) * texture_.width,
                           static_cast<double>(uv[k].y) * texture_.height);
        largest = std::max({largest, std::abs(corners[k].x), std::abs(corners[k].y)});
    }
    if (!(largest < LARGEST_COORDINATE)) {
        RgbD sum(0, 0, 0);
        for (int64_t j = 0; j < height_; ++j)
            sum += prefix(j, width_);
        return sum / static_cast<double>(width_ * height_);
    }
    const Point a = corners[1] - corners[0];
    const Point b = corners[2] - corners[0];
    const double area = 0.5 * (a.x * b.y - a.y * b.x);
    // Rounding of the edge integrals is about 1e-16 * largest * length; below this area it would show.
    if (std::abs(area) <= 1e-10 * largest * std::max(a.length(), b.length()))
        return mean_by_sampling(corners);
    const Point shift = linear_ ? Point(0.5, 0.5) : Point(0, 0);  // cells between texel centres
    RgbD sum(0, 0, 0);
    for (size_t k = 0; k < 3; ++k)
        sum += edge_integral(corners[k] - shift, corners[(k + 1) % 3] - shift);
    return sum / area;
}

}  // namespace obscura
