// SPDX-License-Identifier: Apache-2.0
#include "sampling/seed.h"

#include <limits>

namespace obscura {

uint32_t fold_seed(uint64_t seed) {
    const uint64_t mixed = (seed ^ seed >> 32) * 0x9e3779b97f4a7c15u;
    return seed <= std::numeric_limits<uint32_t>::max() ? static_cast<uint32_t>(seed)
                                                        : static_cast<uint32_t>(mixed >> 32);
}

}  // namespace obscura
