// SPDX-License-Identifier: Apache-2.0
// One ray again, as `obscura check --ray` asks for it: what it hits, and what it brings back.
#pragma once

#include "reference/ray_text.h"
#include "reference/result_comparison.h"
#include "wavefront/render.h"

#include <optional>
#include <string>

namespace obscura {

// The ray as the device, Embree and the oracle see it.
struct RayCheck {
    TraceHit device, embree;
    BruteHit truth;
    Outcome outcome = Outcome::same;
    // What any-hit queries or the walk of single rays make of the ray that contradicts the hit; empty: nothing.
    std::string contradiction = {};
    // Of an obscurance ray what it brings back, of a ray as shadow rays are (reach 1 or endless) the light that comes
    // through; nothing where the render has no such rays.
    std::optional<JudgedResult> result = {};

    bool is_device_wrong() const {
        return outcome == Outcome::device_wrong || !contradiction.empty() ||
               (result && result->outcome == Outcome::device_wrong);
    }
};

// The ray goes down the tree alone, then beside copies of itself, as rays of a stream do; what is told is the first of these whose
// result is wrong, or what the ray brings back alone. Throws InputError for an obscurance ray of a render without obscurances, or with another reach than the render's.
RayCheck replay_ray(Device& device, ProgramLibrary& library, const RenderJob& job, const GivenRay& given);

}  // namespace obscura
