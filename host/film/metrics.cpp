// SPDX-License-Identifier: Apache-2.0
// Sums in double, pixel after pixel in one order: the same images give the same numbers every time.
#include "film/metrics.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace obscura {
namespace {

bool same_bits(float a, float b) {
    return std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b);
}

// Adds one pair of values; mse, relmse, mape and bias hold sums until finish(). Returns the relative error.
double add_pair(LayerDifference& difference, float image, float reference) {
    ++difference.value_count;
    if (same_bits(image, reference)) return 0;
    difference.identical = false;
    const double relative = relative_error(image, reference);
    if (std::isnan(relative)) {
        ++difference.not_finite_count;
        return relative;
    }
    const double r = static_cast<double>(reference);
    const double error = static_cast<double>(image) - r;
    difference.max_abs = std::max(difference.max_abs, std::abs(error));
    difference.mse += error * error;
    difference.relmse += error * error / (r * r + RELATIVE_EPSILON);
    difference.mape += relative;
    difference.bias += error;
    return relative;
}

void finish(LayerDifference& difference) {
    const double count = static_cast<double>(difference.value_count - difference.not_finite_count);
    if (count > 0) {
        difference.mse /= count;
        difference.relmse /= count;
        difference.mape /= count;
        difference.bias /= count;
    }
    difference.rmse = std::sqrt(difference.mse);
}

LayerDifference compare_layers(const Layer& image, const Layer& reference) {
    LayerDifference difference;
    difference.title = reference.title();
    const auto channels = common_channels(image, reference);
    difference.pixel_count = reference.pixels.size() / reference.channel_count();
    for (size_t pixel = 0; pixel < difference.pixel_count; ++pixel) {
        const float* image_pixel = &image.pixels[pixel * image.channel_count()];
        const float* reference_pixel = &reference.pixels[pixel * reference.channel_count()];
        bool differs = false;
        for (const auto& [i, r] : channels) {
            const double relative = add_pair(difference, image_pixel[i], reference_pixel[r]);
            differs = differs || !(relative <= ROUNDING_ERROR);
        }
        if (differs) ++difference.differing_pixel_count;
    }
    finish(difference);
    return difference;
}

// The channels of a that b lacks.
std::vector<std::string> channels_missing(const Image& a, const Image& b) {
    std::vector<std::string> missing;
    for (const Layer& layer : a.layers) {
        const Layer* other = b.find_layer(layer.name);
        for (size_t channel = 0; channel < layer.channel_count(); ++channel) {
            const bool found =
                other != nullptr && other->find_channel(layer.channels[channel]) < other->channel_count();
            if (!found) missing.push_back(layer.channel_path(channel));
        }
    }
    return missing;
}

}  // namespace

double LayerDifference::value(Metric metric) const {
    switch (metric) {
        case Metric::rmse:
            return rmse;
        case Metric::relmse:
            return relmse;
        case Metric::mape:
            return mape;
        case Metric::max_abs:
            return max_abs;
    }
    OBSCURA_CHECK(false, "metric {}", static_cast<int>(metric));
}

bool LayerDifference::is_within(Metric metric, double bound) const {
    if (bound == 0) return identical;
    return not_finite_count == 0 && value(metric) <= bound;
}

double relative_error(float image, float reference) {
    if (same_bits(image, reference)) return 0;
    if (!std::isfinite(image) || !std::isfinite(reference)) return std::numeric_limits<double>::quiet_NaN();
    const double r = static_cast<double>(reference);
    return std::abs(static_cast<double>(image) - r) / (std::abs(r) + RELATIVE_EPSILON);
}

std::vector<std::array<size_t, 2>> common_channels(const Layer& image, const Layer& reference) {
    std::vector<std::array<size_t, 2>> channels;
    for (size_t r = 0; r < reference.channel_count(); ++r) {
        const size_t i = image.find_channel(reference.channels[r]);
        if (i < image.channel_count()) channels.push_back({i, r});
    }
    return channels;
}

ImageDifference compare_images(const Image& image, const Image& reference) {
    OBSCURA_CHECK(image.x0 == reference.x0 && image.y0 == reference.y0 && image.x1 == reference.x1 &&
                      image.y1 == reference.y1,
                  "images of different windows");
    ImageDifference difference;
    difference.only_in_image = channels_missing(image, reference);
    difference.only_in_reference = channels_missing(reference, image);
    for (const Layer& layer : reference.layers) {
        const Layer* other = image.find_layer(layer.name);
        if (other == nullptr || common_channels(*other, layer).empty()) continue;
        difference.layers.push_back(compare_layers(*other, layer));
    }
    return difference;
}

}  // namespace obscura
