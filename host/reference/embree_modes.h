// SPDX-License-Identifier: Apache-2.0
// Embree in every mode that a program could choose for a queue of rays, timed: robust or fast, rays one by one, in
// packets or as a stream, said to be coherent or not, in the order of the queue or sorted. Rays are arranged before the
// clock starts, results written to memory as the device's kernels do.
#pragma once

#include "reference/tracer.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace obscura {

// How rays are handed over: rtcIntersect1, 8, 16 or 1M, likewise rtcOccluded*.
enum class EmbreeCall { single, packet8, packet16, stream };

struct EmbreeMode {
    bool robust = true;
    EmbreeCall call = EmbreeCall::single;
    bool coherent = false;  // RTC_INTERSECT_CONTEXT_FLAG_COHERENT, which means nothing to single rays
    bool sorted = false;    // coherent_order()
    bool operator==(const EmbreeMode&) const = default;
};

// The robust ones, then the fast ones in the same order.
const std::vector<EmbreeMode>& embree_modes();
// "single", "packets of 8, coherent, sorted", ...: without robust or fast.
std::string call_text(const EmbreeMode& mode);

// The nearest hit; whether anything is hit; whether anything is that isn't a pane.
enum class RayQuery { closest, any, opaque };

// The rays of a launch side by side in blocks, which suit all calls, and their hits.
class ArrangedRays {
  public:
    static constexpr size_t BLOCK = 16;
    struct alignas(64) RayBlock {
        float org_x[BLOCK], org_y[BLOCK], org_z[BLOCK];
        float dir_x[BLOCK], dir_y[BLOCK], dir_z[BLOCK], t_max[BLOCK];
    };
    struct alignas(64) HitBlock {
        float t[BLOCK], u[BLOCK], v[BLOCK];
        uint32_t primitive[BLOCK];
    };

    // order: indices of the rays as they are traced.
    ArrangedRays(std::span<const TraceRay> rays, std::vector<uint32_t> order);

    size_t size() const { return order_.size(); }
    std::span<const RayBlock> rays() const { return rays_; }
    std::span<HitBlock> hits() { return hits_; }
    // In the order of the rays that were given. Where any hit will do, only primitive is set: NO_PRIMITIVE or 0.
    std::vector<TraceHit> hits_in_order() const;

  private:
    std::vector<uint32_t> order_;
    std::vector<RayBlock> rays_;
    std::vector<HitBlock> hits_;
};

// A launch's rays in both orders.
class EmbreeRays {
  public:
    explicit EmbreeRays(std::span<const TraceRay> rays);
    ArrangedRays& arranged(const EmbreeMode& mode) { return mode.sorted ? sorted_ : unsorted_; }

  private:
    ArrangedRays unsorted_, sorted_;
};

// What an Embree scene cost.
struct EmbreeCost {
    uint64_t bytes = 0;
    double build_seconds = 0;
};

class EmbreeRunner {
  public:
    EmbreeRunner(const Scene& scene, int threads);
    ~EmbreeRunner();

    // Traces all rays; seconds of wall time.
    double trace(const EmbreeMode& mode, RayQuery query, EmbreeRays& rays) const;
    EmbreeCost cost(bool robust) const;
    // Through which RayQuery::opaque passes.
    bool has_panes() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace obscura
