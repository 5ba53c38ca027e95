// SPDX-License-Identifier: Apache-2.0
#include "wavefront/queues.h"

#include "shared/frame.h"
#include "shared/wavefront.h"

namespace obscura {

Queues allocate_queues(Device& device, const QueueShape& shape, uint32_t capacity, uint32_t pixels,
                       const std::vector<uint32_t>& sample_order) {
    const auto lanes = [&](const char* name, uint64_t lane_count) {
        return Buffer(device, name, "queues", lane_count * capacity * sizeof(f32x4));
    };
    const uint64_t samples = shape.light_samples;
    const uint64_t k_count = shape.obscurance_rays;
    Queues queues;
    queues.frame = Buffer(device, "frame", "queues", sizeof(Frame));
    queues.rays = lanes("rays", RAY_LANES);
    queues.next_rays = lanes("next_rays", shape.specular_paths ? RAY_LANES : 0);
    queues.paths = lanes("paths", PATH_LAYERS + shape.layer_planes + samples * shape.light_lobes);
    queues.shadow_rays = lanes("shadow_rays", SHADOW_LANES * samples);
    queues.visibility = lanes("visibility", samples);
    queues.points = lanes("points", k_count > 0 ? POINT_LANES : 0);
    queues.results = lanes("results", k_count);
    queues.counters = Buffer(device, "counters", "status", STATUS_WORDS * sizeof(uint32_t));
    queues.sample_order = Buffer::holding(device, "sample_order", "queues", sample_order);
    queues.film = Buffer(device, "film", "film", uint64_t{pixels} * shape.layer_planes * sizeof(f32x4));
    return queues;
}

}  // namespace obscura
