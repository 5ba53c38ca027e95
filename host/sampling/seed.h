// SPDX-License-Identifier: Apache-2.0
// A user's seed as the samplers take it.
#pragma once

#include <cstdint>

namespace obscura {

// 64 bits of seed for samplers that mix in 32: the high half is folded in so that it counts.
uint32_t fold_seed(uint64_t seed);

}  // namespace obscura
