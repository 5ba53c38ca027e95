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

SamplerKind resolve_sampler(const RenderSettings& settings) {
    if (settings.sampler != SamplerKind::automatic) return settings.sampler;
    const uint64_t set_size = uint64_t{settings.spp} * settings.obscurance_rays;
    const bool smooth = settings.falloff.kind != FalloffKind::step;
    return smooth && set_size >= 64 ? SamplerKind::owen : SamplerKind::lattice;
}

const char* sampler_name(SamplerKind kind) {
    switch (kind) {
        case SamplerKind::lattice:
            return "lattice";
        case SamplerKind::owen:
            return "owen";
        case SamplerKind::random:
            return "random";
        case SamplerKind::automatic:
            return "auto";
    }
    return "auto";
}

}  // namespace obscura
