// SPDX-License-Identifier: Apache-2.0
// Traces batches of rays through Embree: the second opinion that the device's hits are compared with. An opinion, not
// the truth: even in robust mode Embree 3.13 lets about one ray in 400 through that is aimed at a vertex of a closed
// mesh exactly (at edges none).
#pragma once

#include "scene/scene.h"
#include "shared/bvh.h"

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <span>

namespace obscura {

// Hits count for 0 < t <= t_max, in units of the direction's length (any length but 0).
struct TraceRay {
    V3f origin;
    V3f direction;
    float t_max;
};

struct TraceHit {
    float t;
    float u;             // barycentric weight of vertex 1
    float v;             // barycentric weight of vertex 2
    uint32_t primitive;  // triangle index in the scene; NO_PRIMITIVE = miss, then t = t_max of the ray
};

// To the bit: a NaN is itself, and zeros have signs.
inline bool same_bits(const TraceHit& a, const TraceHit& b) {
    using Words = std::array<uint32_t, 4>;
    return std::bit_cast<Words>(a) == std::bit_cast<Words>(b);
}

class ReferenceTracer {
  public:
    explicit ReferenceTracer(const Scene& scene);  // copies what it needs
    ~ReferenceTracer();
    ReferenceTracer(const ReferenceTracer&) = delete;
    ReferenceTracer& operator=(const ReferenceTracer&) = delete;

    // The nearest hit of each ray; both spans have the same length. All cores.
    void closest(std::span<const TraceRay> rays, std::span<TraceHit> hits) const;
    // The nearest hit with t > after: called again with the hit's t, all hits one after the other. For threads of the
    // caller's.
    TraceHit next(const TraceRay& ray, float after) const;
    // 1 where anything is hit, else 0.
    void occluded(std::span<const TraceRay> rays, std::span<uint8_t> results) const;

  private:
    struct Embree;
    std::unique_ptr<Embree> embree_;
};

}  // namespace obscura
