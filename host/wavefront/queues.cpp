// SPDX-License-Identifier: Apache-2.0
#include "wavefront/queues.h"

#include "shared/frame.h"

#include <string>

namespace obscura {

Queues allocate_queues(Device& device, const QueueShape& shape, uint32_t capacity, uint32_t pixels,
                       const std::vector<uint32_t>& sample_order) {
    Queues queues;
    queues.shape = shape;
    queues.capacity = capacity;
    for (const QueueSize& size : queue_sizes(shape)) {
        const uint64_t bytes = size.lanes * size.items * capacity * sizeof(f32x4);
        queues.*size.buffer = Buffer(device, std::string(size.name), "queues", bytes);
    }
    queues.frame = Buffer(device, "frame", "queues", sizeof(Frame));
    queues.counters = Buffer(device, "counters", "status", STATUS_WORDS * sizeof(uint32_t));
    queues.sample_order = Buffer::holding(device, "sample_order", "queues", sample_order);
    queues.film = Buffer(device, "film", "film", uint64_t{pixels} * shape.layer_planes * sizeof(f32x4));
    return queues;
}

}  // namespace obscura
