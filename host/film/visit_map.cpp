// SPDX-License-Identifier: Apache-2.0
#include "film/visit_map.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "film/magma.h"
#include "film/png.h"

namespace obscura {
namespace {

constexpr double BRIGHTER_SHARE = 0.01;  // of the pixels, beyond the scale's end

// Pixels of the bar and of the gap above it, for a picture of this height.
int32_t bar_height(int32_t picture_height) {
    return std::max(4, picture_height / 40);
}

VisitRange range_of(std::vector<float> values) {
    const auto end = values.begin() + static_cast<std::ptrdiff_t>(static_cast<double>(values.size() - 1) *
                                                                  (1 - BRIGHTER_SHARE));
    std::ranges::nth_element(values, end);
    // Every camera ray visits the root: nothing is 0 where there is a sample.
    return {std::max(1.0, static_cast<double>(*end)), static_cast<double>(std::ranges::max(values))};
}

}  // namespace

Layer visit_layer(std::vector<float> nodes_per_sample) {
    return {VISIT_LAYER, {"Y"}, std::move(nodes_per_sample)};
}

VisitRange write_visit_map_png(const Image& image, const std::vector<float>& nodes_per_sample,
                               const std::filesystem::path& path) {
    OBSCURA_CHECK(nodes_per_sample.size() == image.pixel_count(), "{} values for {} pixels",
                  nodes_per_sample.size(), image.pixel_count());
    const VisitRange range = range_of(nodes_per_sample);
    const int32_t bar = bar_height(image.full_height);
    PngCanvas canvas(image, static_cast<uint32_t>(2 * bar));
    const float* nodes = nodes_per_sample.data();
    for (int32_t y = image.y0; y < image.y1; ++y) {
        for (int32_t x = image.x0; x < image.x1; ++x)
            canvas.set(x, y, magma(std::min(1.0, static_cast<double>(*nodes++) / range.brightest)));
    }
    for (int32_t y = image.full_height + bar; y < image.full_height + 2 * bar; ++y) {
        for (int32_t x = 0; x < image.full_width; ++x)
            canvas.set(x, y, magma((x + 0.5) / image.full_width));
    }
    canvas.write(path);
    return range;
}

}  // namespace obscura
