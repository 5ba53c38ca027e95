// SPDX-License-Identifier: Apache-2.0
// Every ray of a render, checked: the real work of its queues against Embree and the brute-force oracle.
#pragma once

#include "reference/hit_comparison.h"
#include "reference/result_comparison.h"
#include "wavefront/render.h"

#include <array>
#include <string>

namespace obscura {

// Ties and rays at edges that a correct tracer may have, as a share of a queue's rays.
constexpr double MAX_DOUBTFUL_SHARE = 1e-4;

struct QueueCheck {
    std::string name;
    HitTally rays;
    ResultTally results;  // of shadow and obscurance rays
    bool aimed = false;   // at edges and vertices: ties are what they are for

    // Nothing wrong, and little in doubt.
    bool passes() const;
};

struct SceneCheck {
    std::array<QueueCheck, 4> queues{
        {{"camera", {}, {}}, {"shadow", {}, {}}, {"glossy", {}, {}}, {"obscurance", {}, {}}}};
    RayCounts rendered;  // what the render itself counted
};

// Renders the job and checks its queues depth by depth. Returns what it has when after_wave stops the render.
SceneCheck check_scene(Device& device, ProgramLibrary& library, RenderJob job,
                       const RenderCallback& after_wave);

}  // namespace obscura
