// SPDX-License-Identifier: Apache-2.0
// The order in which a pixel's camera samples are visited, and the sampler that suits a set.
#pragma once

#include "scene/settings.h"

#include <cstdint>
#include <vector>

namespace obscura {

// 0 .. spp-1 in bit-reversed order, so that a render stopped half-way has used an even half of each set.
std::vector<uint32_t> bit_reversed_order(uint32_t spp);

// What SamplerKind::automatic means. The lattice has the least error for sets of fewer than 64 obscurance rays
// and for the step; Owen-scrambled points converge faster for smooth falloffs in larger sets.
SamplerKind resolve_sampler(const RenderSettings& settings);
const char* sampler_name(SamplerKind kind);

}  // namespace obscura
