// SPDX-License-Identifier: Apache-2.0
// One ray again, as `obscura check --ray` asks for it: what it hits, and what it brings back.
#pragma once

#include "reference/ray_text.h"
#include "reference/result_comparison.h"
#include "wavefront/render.h"

#include <optional>

namespace obscura {

// The ray as the device, Embree and the oracle see it.
struct RayCheck {
    TraceHit device, embree;
    BruteHit truth;
    Outcome outcome = Outcome::same;
    // Of an obscurance ray what it brings back, of another one the light that comes through; nothing where the render
    // has no such rays.
    std::optional<JudgedResult> result = {};

    bool is_device_wrong() const {
        return outcome == Outcome::device_wrong || (result && result->outcome == Outcome::device_wrong);
    }
};

// Throws InputError for an obscurance ray of a render without obscurances.
RayCheck replay_ray(Device& device, ProgramLibrary& library, const RenderJob& job, const GivenRay& given);

}  // namespace obscura
