// SPDX-License-Identifier: Apache-2.0
#include "wavefront/queues.h"

#include "shared/frame.h"

#include <array>
#include <string>

namespace obscura {

Buffer& Queues::buffer(Queue queue) {
    // In the order of Queue.
    static constexpr std::array<Buffer Queues::*, QUEUE_COUNT> BUFFERS{
        &Queues::rays,       &Queues::next_rays, &Queues::paths,  &Queues::shadow_rays,
        &Queues::visibility, &Queues::points,    &Queues::results};
    return this->*BUFFERS.at(static_cast<uint32_t>(queue));
}

Queues allocate_queues(Device& device, const QueueShape& shape, uint32_t capacity, uint32_t pixels,
                       const std::vector<uint32_t>& sample_order) {
    Queues queues;
    queues.shape = shape;
    for (const QueueSize& size : queue_sizes(shape)) {
        const uint64_t bytes = size.lanes * size.items * capacity * sizeof(f32x4);
        queues.buffer(size.queue) = Buffer(device, std::string(size.name), "queues", bytes);
    }
    queues.frame = Buffer(device, "frame", "queues", sizeof(Frame));
    queues.counters = Buffer(device, "counters", "status", sizeof(DeviceStatus));
    queues.sample_order = Buffer::holding(device, "sample_order", "queues", sample_order);
    queues.pixel_order = Buffer(device, "pixel_order", "queues", uint64_t{pixels} * sizeof(uint32_t));
    queues.film = Buffer(device, "film", "film", uint64_t{pixels} * shape.layer_planes * sizeof(FilmSum),
                         Pages::huge);  // the first pass gets them all, one fault for each
    return queues;
}

}  // namespace obscura
