// SPDX-License-Identifier: Apache-2.0
#include "sampling/lattice.h"

#include "base/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace obscura {
namespace {

// Square of the shortest non-zero vector of the lattice (j, g j) mod n, in units of 1 / n, by Gauss' reduction of
// the basis (1, g), (0, n).
double shortest_vector2(int64_t n, int64_t g) {
    const auto length2 = [](int64_t x, int64_t y) { return x * x + y * y; };
    int64_t ax = 0, ay = n, bx = 1, by = g % n;
    // b becomes the shorter of the two, until a has nothing left of b to give away.
    while (true) {
        if (length2(ax, ay) < length2(bx, by)) {
            std::swap(ax, bx);
            std::swap(ay, by);
        }
        const auto b2 = static_cast<double>(length2(bx, by));
        const auto m = std::llround(static_cast<double>(ax * bx + ay * by) / b2);
        ax -= m * bx;
        ay -= m * by;
        if (length2(ax, ay) >= length2(bx, by)) return b2;
    }
}

// Shortest vector relative to the best any lattice of n points can have (hexagonal): 0..1.
double quality(uint32_t n, uint32_t g) {
    const double best2 = 2.0 / std::sqrt(3.0) * n;
    return std::sqrt(shortest_vector2(n, g) / best2);
}

}  // namespace

uint32_t lattice_generator(uint32_t total, uint32_t stride) {
    OBSCURA_CHECK(total > 0 && stride > 0 && total % stride == 0, "{} points in steps of {}", total, stride);
    const uint32_t subset = total / stride;
    uint32_t best = 1;
    double best_quality = -1;
    // All generators for small sets; for large ones an even choice of 2048 of them is plenty.
    const uint32_t step = std::max(1u, total / 2 / 2048);
    for (uint32_t g = 1; g <= std::max(1u, total / 2); g += step) {
        if (std::gcd(g, total) != 1) continue;
        const double q = std::min(quality(total, g), subset > 1 ? quality(subset, g % subset) : 1.0);
        if (q > best_quality * (1 + 1e-9)) {
            best_quality = q;
            best = g;
        }
    }
    return best;
}

LatticeSteps lattice_steps(uint32_t total, uint32_t stride) {
    const double unit = std::ldexp(1.0, 32) / total;
    const uint32_t g = lattice_generator(total, stride);
    // One point needs no step: 2^32 wraps to 0.
    const auto step_of = [&](uint32_t multiple) {
        return static_cast<uint32_t>(static_cast<uint64_t>(std::llround(unit * multiple)) & 0xffffffffu);
    };
    return {step_of(1), step_of(g)};
}

}  // namespace obscura
