// SPDX-License-Identifier: Apache-2.0
// How a picture is cut into waves: pure arithmetic, tested without a device. The cut changes memory and speed,
// never a bit of the picture.
#pragma once

#include "film/develop.h"
#include "scene/needs.h"
#include "scene/settings.h"
#include "wavefront/queue_sizes.h"

#include <cstdint>
#include <vector>

namespace obscura {

// Pixels [x0, x1) x [y0, y1) of the full picture.
struct PixelRect {
    uint32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    uint32_t width() const { return x1 - x0; }
    uint32_t height() const { return y1 - y0; }
    uint64_t pixel_count() const { return uint64_t{width()} * height(); }
};

// Throws InputError if the window holds no pixel.
PixelRect crop_pixels(const CropWindow& crop, uint32_t width, uint32_t height);

// layer_planes: of the film.
QueueShape queue_shape(const Needs& needs, const RenderSettings& settings, uint32_t layer_planes);

// Bytes of all queues per path slot, and of the largest single queue per slot.
uint64_t bytes_per_slot(const QueueShape& shape);
uint64_t largest_bytes_per_slot(const QueueShape& shape);

// Path slots of a wave: as many as asked, as the memory allows, as one allocation allows, never more than there are
// samples. Throws InputError if not even 64 slots fit.
uint32_t wave_capacity(const QueueShape& shape, uint64_t wanted, uint64_t memory_bytes,
                       uint64_t max_allocation_bytes, uint64_t sample_count);

// Camera samples that go through the stages together: some passes over a range of pixels, in the order of visits. A pixel's
// samples are neighbours.
struct Wave {
    uint32_t first_pixel = 0, pixel_count = 0;
    uint32_t first_pass = 0, pass_count = 0;
    uint32_t sample_count() const { return pixel_count * pass_count; }
};

// The wave that follows one over so many pixels, up to end_pass; no samples past the end. The first follows an empty one,
// which has but the first pass. All pixels have some passes before any has more: as many as a wave holds of all pixels, as
// the pixels have already, or, once all have one, as take a moment; the latter two up to sixteen. So a stopped picture is
// whole early, and the samples of its pixels differ twofold at most but in its first moments. The waves over the same passes
// are of about one size.
Wave wave_after(const Wave& wave, uint32_t capacity, uint32_t pixel_count, uint32_t end_pass);

// Once the wave is done, and all before it.
SampleCounts samples_after(const Wave& wave, uint32_t pixel_count);

// Horizontal bands of rect whose film fits into max_film_bytes and whose pixels 31 bits count; one band in nearly every
// render.
std::vector<PixelRect> film_bands(const PixelRect& rect, uint32_t layer_planes, uint64_t max_film_bytes);

}  // namespace obscura
