// SPDX-License-Identifier: Apache-2.0
// The steps of preview.h, one function each, applied to the beauty layer.
#include "film/preview.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "film/image.h"

namespace obscura {
namespace {

constexpr float SHOULDER = 0.5f;       // where compression starts; (1 - SHOULDER)^2 is the 0.25 of preview.h
constexpr float DESATURATION = 0.15f;  // Khronos PBR Neutral's value

// Bayer's matrix by interleaving bits of x ^ y and y, as a threshold in (0, 1).
float dither_threshold(int32_t x, int32_t y) {
    uint32_t rank = 0;
    for (uint32_t bit = 0; bit < 3; ++bit) {
        const uint32_t y_bit = (static_cast<uint32_t>(y) >> bit) & 1;
        const uint32_t x_bit = (static_cast<uint32_t>(x) >> bit) & 1;
        rank = rank << 2 | (x_bit ^ y_bit) << 1 | y_bit;
    }
    return (static_cast<float>(rank) + 0.5f) / 64;
}

bool is_finite(const Rgb& color) {
    return std::isfinite(color.x) && std::isfinite(color.y) && std::isfinite(color.z);
}

// The indices of the channels shown as red, green and blue.
std::array<size_t, 3> color_channels(const Layer& layer, const std::filesystem::path& path) {
    const size_t none = layer.channel_count();
    const std::array<size_t, 3> rgb = {layer.find_channel("R"), layer.find_channel("G"),
                                       layer.find_channel("B")};
    if (*std::max_element(rgb.begin(), rgb.end()) < none) return rgb;
    const size_t grey = layer.find_channel("Y");
    if (grey < none) return {grey, grey, grey};
    throw InputError("{}: can't be written: the layer {} has neither R, G, B nor Y to show", path.string(),
                     layer.title());
}

}  // namespace

Rgb tone_curve(const Rgb& linear) {
    const float peak = std::max({linear.x, linear.y, linear.z});
    if (peak <= SHOULDER) return linear;
    constexpr float RANGE = 1 - SHOULDER;
    const float new_peak = 1 - RANGE * RANGE / (peak + RANGE - SHOULDER);
    const float whiteness = 1 - 1 / (1 + DESATURATION * (peak - new_peak));
    return linear * (new_peak / peak) * (1 - whiteness) + Rgb(new_peak) * whiteness;
}

float srgb_encode(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

Rgb8 preview_color(const Rgb& radiance, float scale, int32_t x, int32_t y) {
    const Rgb exposed(std::max(0.0f, radiance.x * scale), std::max(0.0f, radiance.y * scale),
                      std::max(0.0f, radiance.z * scale));
    if (!is_finite(radiance) || !is_finite(exposed)) return NOT_FINITE_COLOR;
    const Rgb display = tone_curve(exposed);
    const float threshold = dither_threshold(x, y);
    Rgb8 color{};
    for (int channel = 0; channel < 3; ++channel) {
        const float level = std::floor(255 * srgb_encode(display[channel]) + threshold);
        color[static_cast<size_t>(channel)] = static_cast<uint8_t>(std::clamp(level, 0.0f, 255.0f));
    }
    return color;
}

void write_preview_png(const Image& image, const std::filesystem::path& path, double exposure_stops) {
    const Layer* beauty = image.beauty();
    if (beauty == nullptr)
        throw InputError("{}: can't be written: the image has no beauty layer", path.string());
    const float scale = static_cast<float>(std::exp2(exposure_stops));
    if (!std::isfinite(scale) || scale <= 0) {
        throw InputError("The exposure of {} stops is out of range", exposure_stops);
    }
    const auto [r, g, b] = color_channels(*beauty, path);
    PngCanvas canvas(image);
    const float* pixel = beauty->pixels.data();
    for (int32_t y = image.y0; y < image.y1; ++y) {
        for (int32_t x = image.x0; x < image.x1; ++x, pixel += beauty->channel_count()) {
            canvas.set(x, y, preview_color({pixel[r], pixel[g], pixel[b]}, scale, x, y));
        }
    }
    canvas.write(path);
}

}  // namespace obscura
