// SPDX-License-Identifier: Apache-2.0
// How far an image is from a reference, layer by layer, on linear values. With I the image, R the reference
// and the means over all values (pixels x common channels) of a layer:
//
//   mse = mean (I - R)^2      relmse = mean (I - R)^2 / (R^2 + 0.01)     (Rousselle et al. 2011)
//   rmse = sqrt(mse)          mape = mean |I - R| / (|R| + 0.01)
//   bias = mean (I - R)
//
// A pair of values of which one or both are NaN or infinite, and whose bits differ, has no distance: it is
// left out of the means, counted, and never within any bound. Pairs with equal bits have distance 0 whatever
// they hold.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "film/image.h"

namespace obscura {

// Keeps relative errors finite where the reference is black.
inline constexpr double RELATIVE_EPSILON = 1e-2;
// A pixel with a value whose relative error (as in mape) is larger differs by more than rounding explains: on another
// device one of its rays went another way.
inline constexpr double ROUNDING_ERROR = 1e-4;

enum class Metric { rmse, relmse, mape, max_abs };

struct LayerDifference {
    std::string title;      // "beauty", "specular.direct"
    bool identical = true;  // every common channel has the same bits
    double max_abs = 0;
    double mse = 0;
    double rmse = 0;
    double relmse = 0;
    double mape = 0;
    double bias = 0;
    uint64_t pixel_count = 0;
    uint64_t differing_pixel_count = 0;  // by more than ROUNDING_ERROR, or without a distance
    uint64_t value_count = 0;
    uint64_t not_finite_count = 0;  // pairs without a distance

    double value(Metric metric) const;
    // Bound 0 asks for identical bits, where 0 and -0 differ too.
    bool is_within(Metric metric, double bound) const;
};

struct ImageDifference {
    std::vector<LayerDifference> layers;  // those that both have, in the reference's order
    // Channels that only one of the two has, as "specular.direct.R".
    std::vector<std::string> only_in_image;
    std::vector<std::string> only_in_reference;
};

// The images must have the same size and data window.
ImageDifference compare_images(const Image& image, const Image& reference);

// Per pixel the mean over the common channels of |I - R| / (|R| + 0.01), in the colours of matplotlib's
// "magma" on a logarithmic scale: black is 1e-4 or less, pale yellow 1 or more. Cyan marks pixels with a pair
// that has no distance. layer is a name that both have. Atomic. Throws InputError.
void write_heat_map_png(const Image& image, const Image& reference, const std::string& layer,
                        const std::filesystem::path& path);

// |I - R| / (|R| + 0.01) of a pair of values; NaN if it has no distance.
double relative_error(float image, float reference);

// Indices of the channels that both layers have: {in image, in reference}.
std::vector<std::array<size_t, 2>> common_channels(const Layer& image, const Layer& reference);

}  // namespace obscura
