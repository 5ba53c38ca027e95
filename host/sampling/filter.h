// SPDX-License-Identifier: Apache-2.0
// Pixel filters as tables of their inverse cdf: the camera draws offsets from them with equal weights (filter
// importance sampling; Ernst, Stamminger, Greiner 2006).
#pragma once

#include "scene/settings.h"

#include <vector>

namespace obscura {

// Offsets from the pixel's centre, in pixels, at probabilities i / intervals, i = 0 .. intervals. box: +-0.5; tent:
// radius 1; gauss: standard deviation 0.5, cut at 1.5; blackman_harris: radius 1.5.
std::vector<float> inverse_filter_cdf(PixelFilter filter, uint32_t intervals);

const char* filter_name(PixelFilter filter);

}  // namespace obscura
