// SPDX-License-Identifier: Apache-2.0
// The wavefront's buffers: queues, path slots, results, film and counters. Sizes come from the plan alone.
#pragma once

#include "device/buffer.h"
#include "wavefront/plan.h"

namespace obscura {

struct Queues {
    Buffer frame;
    Buffer rays, next_rays;  // RAY_LANES
    Buffer paths;            // PATH_LAYERS + layers + light contributions
    Buffer shadow_rays;      // SHADOW_LANES
    Buffer visibility;       // one f32x4 per light sample of a slot
    Buffer points;           // POINT_LANES
    Buffer results;          // K f32x4 per slot
    Buffer counters;         // COUNT_*, STATUS_*
    Buffer sample_order;
    Buffer film;  // layer sums, plane * pixels + pixel
};

// sample_order: visits of a pixel's samples; pixels: of the largest film band.
Queues allocate_queues(Device& device, const QueueShape& shape, uint32_t capacity, uint32_t pixels,
                       const std::vector<uint32_t>& sample_order);

}  // namespace obscura
