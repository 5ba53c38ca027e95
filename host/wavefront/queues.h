// SPDX-License-Identifier: Apache-2.0
// The wavefront's buffers, and the one table of the queues' sizes: the plan fits its sum into memory, the buffers are
// allocated from it.
#pragma once

#include "device/buffer.h"
#include "shared/wavefront.h"

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace obscura {

// What one path slot needs.
struct QueueShape {
    uint32_t layer_planes = 0;     // kept layers
    uint32_t light_samples = 0;    // per path: L for each group of lights
    uint32_t light_lobes = 1;      // contributions per light sample
    uint32_t obscurance_rays = 0;  // K, 0 without obscurances
    bool specular_paths = false;   // a second ray queue
};

struct Queues {
    QueueShape shape;
    uint32_t capacity = 0;  // path slots
    Buffer rays, next_rays;
    Buffer paths;        // layers and light contributions
    Buffer shadow_rays;  // of all light samples
    Buffer visibility;   // of each light sample
    Buffer points;       // origins of obscurance rays
    Buffer results;      // of each obscurance ray
    Buffer frame;
    Buffer counters;  // COUNT_*, STATUS_*
    Buffer sample_order;
    Buffer film;  // layer sums, plane * pixels + pixel
};

// A queue of lanes * items f32x4 per path slot: queue[lane * (capacity * items) + item].
struct QueueSize {
    std::string_view name;
    Buffer Queues::*buffer;
    uint64_t lanes;
    uint64_t items;  // the most that the stages put there per path slot: no queue overflows
};

constexpr std::array<QueueSize, 7> queue_sizes(const QueueShape& shape) {
    const uint64_t light_samples = shape.light_samples;
    const uint64_t path_lanes = PATH_LAYERS + shape.layer_planes + light_samples * shape.light_lobes;
    return {{
        {"rays", &Queues::rays, RAY_LANES, 1},
        {"next_rays", &Queues::next_rays, RAY_LANES, shape.specular_paths ? 1u : 0u},
        {"paths", &Queues::paths, path_lanes, 1},
        {"shadow_rays", &Queues::shadow_rays, SHADOW_LANES, light_samples},
        {"visibility", &Queues::visibility, light_samples, 1},
        {"points", &Queues::points, POINT_LANES, shape.obscurance_rays > 0 ? 1u : 0u},
        {"results", &Queues::results, 1, shape.obscurance_rays},
    }};
}

// sample_order: visits of a pixel's samples; pixels: of the largest film band.
Queues allocate_queues(Device& device, const QueueShape& shape, uint32_t capacity, uint32_t pixels,
                       const std::vector<uint32_t>& sample_order);

}  // namespace obscura
