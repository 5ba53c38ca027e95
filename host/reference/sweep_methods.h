// SPDX-License-Identifier: Apache-2.0
// What `obscura sweep` measures against each other. A budget is a number of obscurance rays per pixel: the paper's 8
// samples with 5 rays each are a budget of 40. Methods without obscurance rays take the samples that the paper's 5 rays
// would leave them.
#pragma once

#include "reference/integrator.h"
#include "scene/settings.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace obscura {

inline constexpr uint32_t PAPER_OBSCURANCE_RAYS = 5;

struct SweepMethod {
    std::string name;     // "lattice", "k10", "dmax-x2"
    std::string meaning;  // for people
    // The picture that it is measured against: its own model's, which it converges to, or that of all light.
    reference::IntegratorKind reference = reference::IntegratorKind::obscurance;
    RenderSettings settings;   // all but samples per pixel, size and seed
    bool path_traced = false;  // by the reference's path tracer, on the host
    bool portable = false;     // kernels without instructions of one processor

    // A budget's rays over its samples per pixel.
    uint32_t rays_per_sample() const;
    uint32_t samples(uint32_t budget) const { return budget / rays_per_sample(); }
    // The first `count` of 5, 10, 20 ... that whole samples add up to.
    std::vector<uint32_t> budgets(uint32_t count) const;
    // The layers that are measured; "" is beauty.
    std::vector<std::string> layers() const;
};

// All of them; base holds what they have in common.
std::vector<SweepMethod> sweep_methods(const RenderSettings& base);

// Those of the given names, all if there are none. Throws InputError that lists them.
std::vector<SweepMethod> choose_methods(const std::vector<SweepMethod>& methods,
                                        std::span<const std::string> names);

}  // namespace obscura
