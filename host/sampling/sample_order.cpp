// SPDX-License-Identifier: Apache-2.0
#include "sampling/sample_order.h"

#include <bit>

namespace obscura {

std::vector<uint32_t> bit_reversed_order(uint32_t spp) {
    std::vector<uint32_t> order;
    order.reserve(spp);
    const auto bits = static_cast<int>(std::bit_width(spp - 1));
    for (uint32_t i = 0; i < (1u << bits); ++i) {
        uint32_t reversed = 0;
        for (int b = 0; b < bits; ++b)
            reversed |= ((i >> b) & 1u) << (bits - 1 - b);
        if (reversed < spp) order.push_back(reversed);
    }
    return order;
}

const char* sampler_name(SamplerKind kind) {
    switch (kind) {
        case SamplerKind::lattice:
            return "lattice";
        case SamplerKind::owen:
            return "owen";
        case SamplerKind::random:
            return "random";
    }
    return "";
}

}  // namespace obscura
