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
constexpr size_t OBSCURANCE = COVERAGE + 1;      // rgb: sum over all passes
constexpr size_t BEAUTY_SETS = OBSCURANCE + 3;   // of beauty, SET_VALUES numbers
constexpr size_t SET = 0;                        // rgb: sum over the unfinished set
constexpr size_t SET_MEAN = SET + 3;             // rgb: mean of the finished sets' means
constexpr size_t SET_DEVIATIONS = SET_MEAN + 3;  // rgb: sum of their squared deviations from it
constexpr size_t SET_VALUES = SET_DEVIATIONS + 3;
constexpr size_t DIFFUSE_SETS =
    BEAUTY_SETS + SET_VALUES;  // the same of the diffuse light, and of the obscurance
constexpr size_t OBSCURANCE_SETS = DIFFUSE_SETS + SET_VALUES;
constexpr size_t VALUE_COUNT = OBSCURANCE_SETS + SET_VALUES;

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

void add(double* sums, const RgbD& value) {
    for (size_t c = 0; c < 3; ++c)
        add(sums[c], value[static_cast<int>(c)]);
}

// As PathLight::diffuse().
double diffuse_sum(const double* pixel, size_t channel) {
    double sum = 0;
    for (const auto part : {LAYER_DIRECT, LAYER_AMBIENT, LAYER_SPECULAR_DIRECT, LAYER_SPECULAR_AMBIENT})
        sum += pixel[PARTS + 3 * static_cast<size_t>(part) + channel];
    return sum;
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
    constexpr uint64_t CHANNELS = 4 + 3 * (BEAUTY_LAYERS + 5) + 2 * VALUE_COUNT;  // see develop()
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
            beauty += pixels[p].parts[part];
            add(&pixel[PARTS + 3 * part], pixels[p].parts[part]);
        }
        add(pixel[COVERAGE], pixels[p].coverage);
        add(&pixel[OBSCURANCE], pixels[p].obscurance);
        add(&pixel[BEAUTY_SETS + SET], beauty);
        add(&pixel[DIFFUSE_SETS + SET], pixels[p].diffuse());
        add(&pixel[OBSCURANCE_SETS + SET], pixels[p].obscurance);
        if (passes_ % passes_per_set_ != 0) continue;
        close_set(&pixel[BEAUTY_SETS]);
        close_set(&pixel[DIFFUSE_SETS]);
        close_set(&pixel[OBSCURANCE_SETS]);
    }
}

// Welford 1962.
void Accumulator::close_set(double* sets) const {
    for (size_t c = 0; c < 3; ++c) {
        const double value = sets[SET + c] / passes_per_set_;
        const double before = value - sets[SET_MEAN + c];
        add(sets[SET_MEAN + c], before / static_cast<double>(finished_sets()));
        add(sets[SET_DEVIATIONS + c], before * (value - sets[SET_MEAN + c]));
        sets[SET + c] = 0;
    }
}

void Accumulator::develop(Image& image, bool parts) const {
    const auto n = static_cast<double>(passes_);
    const auto sets = static_cast<double>(finished_sets());
    const bool known_variance = finished_sets() >= 2;
    const std::vector<std::string> rgb{"R", "G", "B"};
    Layer beauty{"", {"R", "G", "B", "A"}, {}};
    Layer diffuse{DIFFUSE_LAYER, rgb, {}};
    Layer obscurance{layer_info("obscurance").name, rgb, {}};
    Layer variance{VARIANCE_LAYER, rgb, {}};
    Layer diffuse_variance{DIFFUSE_VARIANCE_LAYER, rgb, {}};
    Layer obscurance_variance{OBSCURANCE_VARIANCE_LAYER, rgb, {}};
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
            diffuse.pixels.push_back(static_cast<float>(diffuse_sum(pixel, c) / n));
            obscurance.pixels.push_back(static_cast<float>(pixel[OBSCURANCE + c] / n));
            if (!known_variance) continue;
            const auto variance_of_mean = [&](size_t of) {
                return static_cast<float>(pixel[of + SET_DEVIATIONS + c] / (sets - 1) / sets);
            };
            variance.pixels.push_back(variance_of_mean(BEAUTY_SETS));
            diffuse_variance.pixels.push_back(variance_of_mean(DIFFUSE_SETS));
            obscurance_variance.pixels.push_back(variance_of_mean(OBSCURANCE_SETS));
        }
        beauty.pixels.push_back(static_cast<float>(pixel[COVERAGE] / n));
        for (size_t i = 0; i < VALUE_COUNT; ++i) {
            high.pixels.push_back(static_cast<float>(pixel[i]));
            low.pixels.push_back(static_cast<float>(pixel[i] - static_cast<double>(high.pixels.back())));
        }
    }
    image.layers.push_back(std::move(beauty));
    image.layers.push_back(std::move(diffuse));
    if (parts) {
        std::ranges::move(part_layers, std::back_inserter(image.layers));
        image.layers.push_back(std::move(obscurance));
    }
    if (known_variance) image.layers.push_back(std::move(variance));
    if (known_variance) image.layers.push_back(std::move(diffuse_variance));
    if (known_variance && parts) image.layers.push_back(std::move(obscurance_variance));
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
