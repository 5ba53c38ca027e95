// SPDX-License-Identifier: Apache-2.0
// The one table of the queues' sizes: the plan fits its sum into memory, the buffers are allocated from it.
#pragma once

#include "shared/wavefront.h"

#include <array>
#include <cstdint>
#include <string_view>

namespace obscura {

// What one path slot needs.
struct QueueShape {
    uint32_t layer_planes = 0;     // kept layers
    uint32_t light_samples = 0;    // per path: L for each group of lights
    uint32_t light_lobes = 1;      // contributions per light sample
    uint32_t obscurance_rays = 0;  // K, 0 without obscurances
    bool specular_paths = false;   // a second ray queue
};

enum class Queue : uint32_t { rays, next_rays, paths, shadow_rays, visibility, points, results };
constexpr uint32_t QUEUE_COUNT = 7;

// A queue of lanes * items f32x4 per path slot: queue[lane * (capacity * items) + item].
struct QueueSize {
    Queue queue;
    std::string_view name;
    uint64_t lanes;
    uint64_t items;  // the most that the stages put there per path slot: no queue overflows
};

constexpr std::array<QueueSize, QUEUE_COUNT> queue_sizes(const QueueShape& shape) {
    const uint64_t light_samples = shape.light_samples;
    const uint64_t path_lanes = PATH_LAYERS + shape.layer_planes + light_samples * shape.light_lobes;
    return {{
        {Queue::rays, "rays", RAY_LANES, 1},
        {Queue::next_rays, "next_rays", RAY_LANES, shape.specular_paths ? 1u : 0u},
        {Queue::paths, "paths", path_lanes, 1},  // layers and light contributions
        {Queue::shadow_rays, "shadow_rays", SHADOW_LANES, light_samples},
        {Queue::visibility, "visibility", light_samples, 1},
        {Queue::points, "points", POINT_LANES, shape.obscurance_rays > 0 ? 1u : 0u},
        {Queue::results, "results", 1, shape.obscurance_rays},
    }};
}

}  // namespace obscura
