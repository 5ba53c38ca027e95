// SPDX-License-Identifier: Apache-2.0
// Relative error per pixel as a picture; the scale is documented in metrics.h.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "film/magma.h"
#include "film/metrics.h"
#include "film/png.h"

namespace obscura {
namespace {

constexpr double DECADES = 4;  // the scale runs from 10^-4 to 1
constexpr Rgb8 NO_DISTANCE_COLOR = {0, 255, 255};

Rgb8 heat_color(double relative_error) {
    if (std::isnan(relative_error)) return NO_DISTANCE_COLOR;
    const double place = 1 + std::log10(relative_error) / DECADES;  // -inf for 0
    return magma(std::clamp(place, 0.0, 1.0));
}

}  // namespace

void write_heat_map_png(const Image& image, const Image& reference, const std::string& layer,
                        const std::filesystem::path& path) {
    const Layer* image_layer = image.find_layer(layer);
    const Layer* reference_layer = reference.find_layer(layer);
    OBSCURA_CHECK(image_layer != nullptr && reference_layer != nullptr, "no layer {}", layer);
    const auto channels = common_channels(*image_layer, *reference_layer);
    PngCanvas canvas(reference);
    const float* image_pixel = image_layer->pixels.data();
    const float* reference_pixel = reference_layer->pixels.data();
    for (int32_t y = reference.y0; y < reference.y1; ++y) {
        for (int32_t x = reference.x0; x < reference.x1; ++x) {
            double sum = 0;
            for (const auto& [i, r] : channels)
                sum += relative_error(image_pixel[i], reference_pixel[r]);
            canvas.set(x, y, heat_color(sum / static_cast<double>(channels.size())));
            image_pixel += image_layer->channel_count();
            reference_pixel += reference_layer->channel_count();
        }
    }
    canvas.write(path);
}

}  // namespace obscura
