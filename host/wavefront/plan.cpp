// SPDX-License-Identifier: Apache-2.0
#include "wavefront/plan.h"

#include "base/error.h"
#include "base/units.h"
#include "shared/types.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace obscura {
namespace {

constexpr uint64_t LANE_BYTES = sizeof(f32x4);
// Below this a wave is all launch overhead.
constexpr uint64_t MIN_WAVE = 64;
// Passes that go together: rays of the same pixel go nearly the same way through the same memory.
constexpr uint32_t MAX_PASSES_TOGETHER = 16;
// So few samples (the kitchen's take two cores 1.5 s) that it matters little how uneven a picture is that is stopped in them.
constexpr uint64_t SAMPLES_TOGETHER = uint64_t{1} << 22;
// Kernels count elements of queues, pixels and samples in 32 bits, up to the next multiple of a work-group or a share: half
// the range leaves room for it.
constexpr uint64_t MAX_INDEX = 0x7fffffff;

// The option that sets the size of the largest queue. Rays and layers alone stay below 1 KiB per slot, which fits
// every device.
const char* largest_queue_option(const QueueShape& shape) {
    const auto sizes = queue_sizes(shape);
    const auto largest =
        std::ranges::max_element(sizes, {}, [](const QueueSize& size) { return size.lanes * size.items; });
    return largest->queue == Queue::results ? "--obscurance-rays" : "--light-samples";
}

}  // namespace

PixelRect crop_pixels(const CropWindow& crop, uint32_t width, uint32_t height) {
    const auto edge = [](double fraction, uint32_t size) {
        return static_cast<uint32_t>(std::clamp(std::ceil(fraction * size), 0.0, static_cast<double>(size)));
    };
    const PixelRect rect{edge(crop.x0, width), edge(crop.y0, height), edge(crop.x1, width),
                         edge(crop.y1, height)};
    if (rect.x0 >= rect.x1 || rect.y0 >= rect.y1) {
        throw InputError("crop window {},{},{},{} holds no pixel of {} x {}", crop.x0, crop.x1, crop.y0,
                         crop.y1, width, height);
    }
    return rect;
}

QueueShape queue_shape(const Needs& needs, const RenderSettings& settings, uint32_t layer_planes) {
    const bool punctual = needs.point_lights || needs.spot_lights || needs.directional_lights;
    QueueShape shape;
    shape.layer_planes = layer_planes;
    shape.light_samples = settings.light_samples * ((needs.area_lights ? 1u : 0u) + (punctual ? 1u : 0u));
    shape.light_lobes = needs.glossy ? 2 : 1;
    shape.obscurance_rays = needs.obscurance ? settings.obscurance_rays : 0;
    shape.specular_paths = needs.specular_paths;
    return shape;
}

uint64_t bytes_per_slot(const QueueShape& shape) {
    uint64_t lanes = 0;
    for (const QueueSize& size : queue_sizes(shape))
        lanes += size.lanes * size.items;
    return lanes * LANE_BYTES;
}

uint64_t largest_bytes_per_slot(const QueueShape& shape) {
    uint64_t lanes = 0;
    for (const QueueSize& size : queue_sizes(shape))
        lanes = std::max(lanes, size.lanes * size.items);
    return lanes * LANE_BYTES;
}

uint32_t wave_capacity(const QueueShape& shape, uint64_t wanted, uint64_t memory_bytes,
                       uint64_t max_allocation_bytes, uint64_t sample_count) {
    constexpr uint64_t INDEXED_BYTES = MAX_INDEX * LANE_BYTES;
    const uint64_t queue_bytes = std::min(max_allocation_bytes, INDEXED_BYTES);
    const uint64_t fit_one_queue = queue_bytes / largest_bytes_per_slot(shape);
    if (fit_one_queue < MIN_WAVE) {
        throw InputError(
            "the largest queue takes {} for each camera sample, and the {} that {} hold {}, {} are the "
            "least: lower {}",
            bytes_text(largest_bytes_per_slot(shape)), bytes_text(queue_bytes),
            max_allocation_bytes < INDEXED_BYTES ? "the device allows one buffer" : "31-bit indices reach",
            fit_one_queue, MIN_WAVE, largest_queue_option(shape));
    }
    const uint64_t fit_memory = memory_bytes / bytes_per_slot(shape);
    if (fit_memory < MIN_WAVE) {
        throw InputError(
            "{} of queue memory hold {} at {} each, {} are the least: raise --memory or lower "
            "--obscurance-rays or --light-samples",
            bytes_text(memory_bytes), counted(fit_memory, "camera sample"), bytes_text(bytes_per_slot(shape)),
            MIN_WAVE);
    }
    const uint64_t fits = std::min(fit_memory, fit_one_queue);
    return static_cast<uint32_t>(
        std::clamp(std::min(wanted, fits), uint64_t{1}, std::max(sample_count, MIN_WAVE)));
}

Wave wave_after(const Wave& wave, uint32_t capacity, uint32_t pixel_count, uint32_t end_pass) {
    Wave next = wave;
    next.first_pixel += wave.pixel_count;
    if (next.first_pixel == pixel_count || wave.sample_count() == 0) {
        next.first_pixel = 0;
        next.first_pass += wave.pass_count;
        // The first pass goes alone.
        const uint32_t as_before = std::bit_floor(next.first_pass);
        const uint32_t quickly =
            next.first_pass > 0 ? static_cast<uint32_t>(SAMPLES_TOGETHER / pixel_count) : 1;
        const uint32_t together = std::clamp(std::max(as_before, quickly), 1u, MAX_PASSES_TOGETHER);
        next.pass_count =
            std::min({std::max(together, capacity / pixel_count), capacity, end_pass - next.first_pass});
    }
    if (next.pass_count == 0) return {};
    const uint32_t most = capacity / next.pass_count;
    const uint32_t wave_count = (pixel_count - 1) / most + 1;
    next.pixel_count = std::min((pixel_count - 1) / wave_count + 1, pixel_count - next.first_pixel);
    return next;
}

SampleCounts samples_after(const Wave& wave, uint32_t pixel_count) {
    const uint32_t pixels = wave.first_pixel + wave.pixel_count;
    if (pixels == pixel_count) return {.passes = uint64_t{wave.first_pass} + wave.pass_count};
    return {.passes = wave.first_pass, .pixels_ahead = pixels, .passes_ahead = wave.pass_count};
}

std::vector<PixelRect> film_bands(const PixelRect& rect, uint32_t layer_planes, uint64_t max_film_bytes) {
    const uint64_t row_bytes = uint64_t{rect.width()} * layer_planes * sizeof(FilmSum);
    const uint64_t fits =
        std::min(max_film_bytes / std::max<uint64_t>(row_bytes, 1), MAX_INDEX / rect.width());
    const auto rows = static_cast<uint32_t>(std::clamp<uint64_t>(fits, 1, rect.height()));
    std::vector<PixelRect> bands;
    for (uint32_t y = rect.y0; y < rect.y1; y += rows) {
        bands.push_back({rect.x0, y, rect.x1, std::min(y + rows, rect.y1)});
    }
    return bands;
}

}  // namespace obscura
