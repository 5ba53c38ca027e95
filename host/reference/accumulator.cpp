// SPDX-License-Identifier: Apache-2.0
// Every number is kept as the sum of two floats, 48 bits: that is what the picture can hold. So it makes no difference
// whether a run is interrupted and continued.
#include "reference/accumulator.h"

#include "base/error.h"
#include "film/develop.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>

namespace obscura::reference {
namespace {

// The numbers of a pixel.
constexpr size_t PARTS = 0;                      // rgb of each part: sum over all passes
constexpr size_t COVERAGE = 3 * BEAUTY_LAYERS;   // sum over all passes
constexpr size_t SET = COVERAGE + 1;             // rgb of beauty: sum over the unfinished set
constexpr size_t SET_MEAN = SET + 3;             // rgb: mean of the finished sets' means
constexpr size_t SET_DEVIATIONS = SET_MEAN + 3;  // rgb: sum of their squared deviations from it
constexpr size_t VALUE_COUNT = SET_DEVIATIONS + 3;

constexpr const char* HIGH_LAYER = "state.high";
constexpr const char* LOW_LAYER = "state.low";

// Rounded to the 48 bits of two floats; what is so small that the second float would lose bits counts as nothing. By its
// bits, as GCC 12 drops the rounding of a conversion to float and back where it vectorises one.
double storable(double x) {
    constexpr uint64_t UNIT = uint64_t{1} << (53 - 48);
    if (std::abs(x) < 0x1p-100) return 0;
    return std::bit_cast<double>((std::bit_cast<uint64_t>(x) + UNIT / 2) & ~(UNIT - 1));
}

void add(double& sum, double value) {
    sum = storable(sum + value);
}

std::vector<std::string> state_channels() {
    std::vector<std::string> names;
    for (size_t i = 0; i < VALUE_COUNT; ++i)
        names.push_back(fmt::format("{:02}", i));
    return names;
}

}  // namespace

Accumulator::Accumulator(size_t pixel_count, uint32_t passes_per_set)
    : passes_per_set_(passes_per_set), values_(pixel_count * VALUE_COUNT) {}

uint64_t Accumulator::bytes_per_pixel() {
    constexpr uint64_t CHANNELS = 4 + 3 * BEAUTY_LAYERS + 3 + 2 * VALUE_COUNT;  // see develop()
    return VALUE_COUNT * sizeof(double) + CHANNELS * sizeof(float);
}

void Accumulator::add_pass(std::span<const PathLight> pixels) {
    OBSCURA_CHECK(pixels.size() * VALUE_COUNT == values_.size(), "{} pixels for {} numbers", pixels.size(),
                  values_.size());
    ++passes_;
    for (size_t p = 0; p < pixels.size(); ++p) {
        double* const pixel = &values_[p * VALUE_COUNT];
        RgbD beauty(0);
        for (size_t part = 0; part < BEAUTY_LAYERS; ++part) {
            const RgbD& value = pixels[p].parts[part];
            beauty += value;
            for (size_t c = 0; c < 3; ++c)
                add(pixel[PARTS + 3 * part + c], value[static_cast<int>(c)]);
        }
        add(pixel[COVERAGE], pixels[p].coverage);
        for (size_t c = 0; c < 3; ++c)
            add(pixel[SET + c], beauty[static_cast<int>(c)]);
        if (passes_ % passes_per_set_ == 0) close_set(pixel);
    }
}

// Welford 1962.
void Accumulator::close_set(double* pixel) const {
    for (size_t c = 0; c < 3; ++c) {
        const double value = pixel[SET + c] / passes_per_set_;
        const double before = value - pixel[SET_MEAN + c];
        add(pixel[SET_MEAN + c], before / static_cast<double>(finished_sets()));
        add(pixel[SET_DEVIATIONS + c], before * (value - pixel[SET_MEAN + c]));
        pixel[SET + c] = 0;
    }
}

void Accumulator::develop(Image& image, bool parts) const {
    const auto n = static_cast<double>(passes_);
    const auto sets = static_cast<double>(finished_sets());
    const bool known_variance = finished_sets() >= 2;
    Layer beauty{"", {"R", "G", "B", "A"}, {}};
    Layer variance{"Variance", {"R", "G", "B"}, {}};
    Layer high{HIGH_LAYER, state_channels(), {}};
    Layer low{LOW_LAYER, state_channels(), {}};
    std::vector<Layer> part_layers;
    for (uint32_t part = 0; part < BEAUTY_LAYERS; ++part) {
        const LayerInfo& info = layer_table()[part];
        OBSCURA_CHECK(info.layer == part, "layer {} is {}", part, info.name);
        part_layers.push_back({info.name, info.channels, {}});
    }
    for (size_t start = 0; start < values_.size(); start += VALUE_COUNT) {
        const double* const pixel = &values_[start];
        for (size_t c = 0; c < 3; ++c) {
            double sum = 0;
            for (size_t part = 0; part < BEAUTY_LAYERS; ++part) {
                const double value = pixel[PARTS + 3 * part + c];
                sum += value;
                part_layers[part].pixels.push_back(static_cast<float>(value / n));
            }
            beauty.pixels.push_back(static_cast<float>(sum / n));
            if (known_variance)
                variance.pixels.push_back(static_cast<float>(pixel[SET_DEVIATIONS + c] / (sets - 1) / sets));
        }
        beauty.pixels.push_back(static_cast<float>(pixel[COVERAGE] / n));
        for (size_t i = 0; i < VALUE_COUNT; ++i) {
            high.pixels.push_back(static_cast<float>(pixel[i]));
            low.pixels.push_back(static_cast<float>(pixel[i] - static_cast<double>(high.pixels.back())));
        }
    }
    image.layers.push_back(std::move(beauty));
    if (parts) std::ranges::move(part_layers, std::back_inserter(image.layers));
    if (known_variance) image.layers.push_back(std::move(variance));
    image.layers.push_back(std::move(high));
    image.layers.push_back(std::move(low));
}

bool Accumulator::restore(const Image& image, uint64_t passes) {
    const Layer* const high = image.find_layer(HIGH_LAYER);
    const Layer* const low = image.find_layer(LOW_LAYER);
    for (const Layer* layer : {high, low}) {
        if (layer == nullptr || layer->channels != state_channels()) return false;
        if (layer->pixels.size() != values_.size()) return false;
    }
    for (size_t i = 0; i < values_.size(); ++i)
        values_[i] = static_cast<double>(high->pixels[i]) + static_cast<double>(low->pixels[i]);
    passes_ = passes;
    return true;
}

}  // namespace obscura::reference
