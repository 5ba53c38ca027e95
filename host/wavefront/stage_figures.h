// SPDX-License-Identifier: Apache-2.0
// The rows of a profile: what each stage's time was spent on, and what bounds it.
#pragma once

#include "wavefront/device_rates.h"
#include "wavefront/render.h"

#include <cstdint>
#include <string>
#include <vector>

namespace obscura {

struct StageFigures {
    std::string row;
    StageProfile profile;
    double share = 0;  // of the time of all kernels
    double ns_per_item = 0;
    double mrays_per_s = 0;  // 0: its items aren't rays
    uint64_t bytes = 0;   // moved to and from queues, computed from the lanes that the stage reads and writes
    double gb_per_s = 0;  // these over its time
    double visits_per_ray = 0;  // nodes and blocks of triangles; 0: likewise
    double fill = 0;            // work items that had work, of those launched
    double idle_share = 0;      // of its time: launches, and work items without work
    std::string bound;
};

// What bounds a stage, by its other figures. bvh_bytes: of the tree.
std::string bound_text(const StageFigures& figures, uint64_t bvh_bytes, const DeviceRates& rates);

// In the order of the stages. result.visits must be there.
std::vector<StageFigures> stage_figures(const DeviceWork& result, const DeviceRates& rates);

}  // namespace obscura
