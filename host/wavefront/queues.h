// SPDX-License-Identifier: Apache-2.0
// The wavefront's buffers.
#pragma once

#include "device/buffer.h"
#include "wavefront/queue_sizes.h"

#include <array>
#include <cstdint>
#include <vector>

namespace obscura {

// COUNT_*, STATUS_*: what the kernels counted and the first failure, read back once per depth.
using DeviceStatus = std::array<uint32_t, STATUS_WORDS>;

struct Queues {
    QueueShape shape;
    Buffer rays, next_rays;
    Buffer paths;        // layers and light contributions
    Buffer shadow_rays;  // of all light samples
    Buffer visibility;   // of each light sample
    Buffer points;       // origins of obscurance rays
    Buffer results;      // of each obscurance ray
    Buffer frame;
    Buffer counters;  // DeviceStatus
    Buffer sample_order;
    Buffer pixel_order;
    Buffer film;  // FilmSum, plane * pixels + the pixel's place in pixel_order

    Buffer& buffer(Queue queue);
};

// sample_order: visits of a pixel's samples; pixels: of the largest film band.
Queues allocate_queues(Device& device, const QueueShape& shape, uint32_t capacity, uint32_t pixels,
                       const std::vector<uint32_t>& sample_order);

}  // namespace obscura
