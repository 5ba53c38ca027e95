// SPDX-License-Identifier: Apache-2.0
// The reference pictures of a sweep, kept on disk: what is there is reused, or gone on with where it was interrupted.
#pragma once

#include "reference/sweep.h"

#include <filesystem>

namespace obscura {

// Independent sets of samples, which tell the reference's variance.
inline constexpr uint32_t REFERENCE_SETS = 16;

// "obscurance" or "path": also the stem of its file.
const char* integrator_name(reference::IntegratorKind integrator);

struct SweepReferenceJob {
    const Scene& scene;
    RenderSettings settings;  // what the methods have in common
    uint32_t budget_count = 1;
    reference::IntegratorKind integrator = reference::IntegratorKind::obscurance;
    std::filesystem::path folder;  // there; the file in it: obscurance.exr or path.exr
};

// Nothing if it was stopped; then what is done is in the file. Each set has twice the samples that the paper's 5 rays leave
// the largest budget: so the reference's standard error is at most a fifth or so of that picture's. Throws InputError if
// the file holds another picture.
std::optional<SweepReference> make_reference(const SweepReferenceJob& job,
                                             const reference::ReferenceCallback& go_on);

}  // namespace obscura
