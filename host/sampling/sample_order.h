// SPDX-License-Identifier: Apache-2.0
// The order in which a pixel's camera samples are visited.
#pragma once

#include "scene/settings.h"

#include <cstdint>
#include <vector>

namespace obscura {

// 0 .. spp-1 in bit-reversed order, so that a render stopped half-way has used an even half of each set.
std::vector<uint32_t> bit_reversed_order(uint32_t spp);

const char* sampler_name(SamplerKind kind);

}  // namespace obscura
