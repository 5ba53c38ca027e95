// SPDX-License-Identifier: Apache-2.0
#include "sampling/filter.h"

#include <cmath>
#include <numbers>

namespace obscura {
namespace {

double filter_radius(PixelFilter filter) {
    switch (filter) {
        case PixelFilter::box:
            return 0.5;
        case PixelFilter::tent:
            return 1.0;
        case PixelFilter::gauss:
            return 1.5;
        case PixelFilter::blackman_harris:
            return 1.5;
    }
    return 0.5;
}

// Unnormalised density at offset x, |x| <= radius.
double filter_density(PixelFilter filter, double x) {
    const double radius = filter_radius(filter);
    switch (filter) {
        case PixelFilter::box:
            return 1;
        case PixelFilter::tent:
            return radius - std::abs(x);
        case PixelFilter::gauss: {
            const auto bell = [](double y) { return std::exp(-y * y / (2 * 0.5 * 0.5)); };
            return bell(x) - bell(radius);
        }
        case PixelFilter::blackman_harris: {
            // Harris 1978, four-term window with minimum side lobes.
            const double phase = 2 * std::numbers::pi * (x / radius * 0.5 + 0.5);
            return 0.35875 - 0.48829 * std::cos(phase) + 0.14128 * std::cos(2 * phase) -
                   0.01168 * std::cos(3 * phase);
        }
    }
    return 1;
}

}  // namespace

std::vector<float> inverse_filter_cdf(PixelFilter filter, uint32_t intervals) {
    constexpr int STEPS = 1 << 14;
    const double radius = filter_radius(filter);
    const double width = 2 * radius / STEPS;
    std::vector<double> cdf(STEPS + 1, 0.0);
    for (int i = 0; i < STEPS; ++i) {
        cdf[static_cast<size_t>(i) + 1] =
            cdf[static_cast<size_t>(i)] + filter_density(filter, -radius + (i + 0.5) * width);
    }
    std::vector<float> offsets(intervals + 1);
    size_t step = 0;
    for (uint32_t i = 0; i <= intervals; ++i) {
        const double target = cdf[STEPS] * i / intervals;
        while (step + 1 < STEPS && cdf[step + 1] < target)
            ++step;
        const double fraction = (target - cdf[step]) / (cdf[step + 1] - cdf[step]);
        offsets[i] = static_cast<float>(-radius + (static_cast<double>(step) + fraction) * width);
    }
    return offsets;
}

const char* filter_name(PixelFilter filter) {
    switch (filter) {
        case PixelFilter::box:
            return "box";
        case PixelFilter::tent:
            return "tent";
        case PixelFilter::gauss:
            return "gauss";
        case PixelFilter::blackman_harris:
            return "bh";
    }
    return "box";
}

}  // namespace obscura
