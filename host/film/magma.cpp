// SPDX-License-Identifier: Apache-2.0
#include "film/magma.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace obscura {
namespace {

// Every 16th colour of matplotlib's magma (Smith, van der Walt 2015, CC0): perceptually uniform, and linear
// interpolation stays within 3/255 of the full map.
constexpr std::array<Rgb8, 17> MAGMA = {{{0, 0, 4},
                                         {10, 8, 34},
                                         {29, 17, 71},
                                         {54, 16, 107},
                                         {81, 18, 124},
                                         {106, 28, 129},
                                         {131, 38, 129},
                                         {156, 46, 127},
                                         {183, 55, 121},
                                         {208, 65, 111},
                                         {231, 82, 99},
                                         {245, 107, 92},
                                         {252, 137, 97},
                                         {254, 167, 114},
                                         {254, 196, 136},
                                         {253, 226, 163},
                                         {252, 253, 191}}};

}  // namespace

Rgb8 magma(double place) {
    const double position = place * static_cast<double>(MAGMA.size() - 1);
    const size_t index = std::min(static_cast<size_t>(position), MAGMA.size() - 2);
    const double weight = position - static_cast<double>(index);
    Rgb8 color{};
    for (size_t channel = 0; channel < 3; ++channel) {
        const double value = std::lerp(1.0 * MAGMA[index][channel], 1.0 * MAGMA[index + 1][channel], weight);
        color[channel] = static_cast<uint8_t>(std::lround(value));
    }
    return color;
}

}  // namespace obscura
