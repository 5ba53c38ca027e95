// SPDX-License-Identifier: Apache-2.0
#include "reference/sweep_errors.h"

#include "base/error.h"
#include "film/metrics.h"

#include <cmath>

namespace obscura {
namespace {

constexpr size_t COLORS = 3;

size_t pixel_count(const Layer& layer) {
    return layer.pixels.size() / layer.channel_count();
}

// Calls visit(value of each layer ...) for every pixel and color. In all layers of renders R, G, B come first.
template <typename Visit, typename... Layers>
void for_each_value(const Visit& visit, const Layer& first, const Layers&... others) {
    const auto is_alike = [&](const Layer& layer) {
        return layer.find_channel("R") == 0 && layer.find_channel("G") == 1 && layer.find_channel("B") == 2 &&
               pixel_count(layer) == pixel_count(first);
    };
    OBSCURA_CHECK(is_alike(first) && (is_alike(others) && ...), "layers of different kinds");
    const auto value = [](const Layer& layer, size_t pixel, size_t color) {
        return static_cast<double>(layer.pixels[pixel * layer.channel_count() + color]);
    };
    for (size_t pixel = 0; pixel < pixel_count(first); ++pixel) {
        for (size_t color = 0; color < COLORS; ++color)
            visit(value(first, pixel, color), value(others, pixel, color)...);
    }
}

double value_count(const Layer& layer) {
    return static_cast<double>(COLORS * pixel_count(layer));
}

double relative_square(double square, double reference) {
    return square / (reference * reference + RELATIVE_EPSILON);
}

}  // namespace

LayerErrors measure_errors(const Layer& render, const Layer& reference) {
    LayerErrors errors;
    for_each_value(
        [&](double i, double r) {
            const double error = i - r;
            errors.mse += error * error;
            errors.relmse += relative_square(error * error, r);
            errors.mape += std::abs(error) / (std::abs(r) + RELATIVE_EPSILON);
            errors.bias += error;
        },
        render, reference);
    const double count = value_count(render);
    return {errors.mse / count, errors.relmse / count, errors.mape / count, errors.bias / count};
}

CommonErrors measure_common_errors(const Layer& render, const Layer& other, const Layer& reference) {
    CommonErrors common;
    for_each_value(
        [&](double i, double j, double r) {
            common.mse += (i - r) * (j - r);
            common.relmse += relative_square((i - r) * (j - r), r);
        },
        render, other, reference);
    const double count = value_count(render);
    return {common.mse / count, common.relmse / count};
}

ReferenceNoise measure_noise(const Layer& reference, const Layer& variance) {
    ReferenceNoise noise;
    for_each_value(
        [&](double r, double v) {
            noise.mse += v;
            noise.relmse += relative_square(v, r);
        },
        reference, variance);
    const double count = value_count(reference);
    noise.mse /= count;
    noise.relmse /= count;
    // Pixels are independent; a pixel's channels are taken to err all in the same direction.
    noise.mean_error = std::sqrt(noise.mse / static_cast<double>(pixel_count(reference)));
    return noise;
}

}  // namespace obscura
