// SPDX-License-Identifier: Apache-2.0
// Compares the device's hits with Embree's, and judges every difference by the brute-force oracle. What float arithmetic
// may do to a hit is bounded here, so that "on an edge" and "same distance" are statements, not excuses.
//
// The bound. Let M be the largest coordinate difference between the ray's origin and a vertex of the triangle, u = 2^-24.
// The shear test rounds p - o once (u M), the shear's slope once or, where division is inexact, by 2.5 ulp (5 u), its
// product once and the difference once (2 u): each sheared coordinate is off by at most 9 u M, which shifts a projected
// vertex by 9 sqrt(2) u M < 13 u M. Whether the ray is inside, plain edge functions decide: that of two vertices a, b is
// off by 3 u |a| |b|, that is 3 u |a| |b| / |a - b| < 3 u M as a distance from an edge beside which the ray passes.
// Together: 16 u M. The distance comes from exact edge functions instead: it is that of the shifted corners, so that
// slivers make it no worse, and its own few roundings are relative to it. Along the ray a shift grows with 1 / cos of the
// angle to the triangle's normal; 16 u M / cos is taken as the bound of the distance too. A barycentric weight is the
// distance from an edge over the triangle's height above it: a shift s changes it by s / height, and dividing by the sum
// of the three by that much of the others' changes.
#pragma once

#include "reference/brute_force.h"
#include "reference/ray_text.h"
#include "reference/tracer.h"

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace obscura {

enum class Outcome { same, tie, edge, embree_wrong, device_wrong };
std::string outcome_text(Outcome outcome);

// A ray whose answers are not the same, for the reader of a report.
struct Disagreement {
    GivenRay ray{};  // with a start if it is an obscurance ray's result
    Outcome outcome = Outcome::same;
    // Who is wrong: by which share of what rounding explains; infinitely where hit or miss or the triangle is wrong.
    double severity = 0;
    std::string device = {}, expected = {};
};

// What came of comparing the rays of one queue.
struct HitTally {
    uint64_t rays = 0, hits = 0;
    uint64_t judged = 0;  // by the oracle
    uint64_t ties = 0, edges = 0, embree_wrong = 0, device_wrong = 0;
    // Largest errors of the device where the triangle is undisputed: of the distance and of the barycentric weights as
    // shares of their bounds; of the distance relative to it, and in units in its last place.
    double distance_share = 0, weight_share = 0, distance_relative = 0, distance_ulps = 0;
    std::vector<Disagreement> disagreements;  // the worst few of each outcome, worst first

    // Counts a judged ray; tell gives the Disagreement, if it is to be kept.
    template <typename Tell>
    void count(Outcome outcome, double severity, const Tell& tell) {
        if (outcome == Outcome::same) return;
        ++*count_of(outcome);
        if (!is_among_worst(outcome, severity)) return;
        Disagreement told = tell();
        told.outcome = outcome;
        told.severity = severity;
        keep(std::move(told));
    }
    void add(const HitTally& other);

  private:
    uint64_t* count_of(Outcome outcome);
    bool is_among_worst(Outcome outcome, double severity) const;
    void keep(Disagreement disagreement);
};

// Whether ray i of a queue belongs to the part, one in `every`, that the oracle judges anyway. A fixed choice without
// pattern: a stride that is a multiple of K would look at the first of a point's K rays only.
bool is_drawn(size_t i, size_t every);

class HitComparison {
  public:
    explicit HitComparison(const Scene& scene) : scene_(scene), embree_(scene), oracle_(scene) {}

    const ReferenceTracer& embree() const { return embree_; }
    const BruteForce& oracle() const { return oracle_; }

    // The errors that float arithmetic may make at a triangle that the ray meets: of position, in scene units; of the
    // distance, in those of t; of a corner's barycentric weight.
    double position_error(const TraceRay& ray, uint32_t primitive) const;
    double distance_error(const TraceRay& ray, const BruteHit& exact) const;
    double weight_error(const TraceRay& ray, const BruteHit& exact, size_t corner) const;

    // One ray in `every` (is_drawn) is judged even if both tracers agree: they could be wrong together.
    HitTally compare(std::span<const TraceRay> rays, std::span<const TraceHit> device,
                     std::span<const TraceHit> embree, size_t every) const;

  private:
    struct Judged {
        Outcome outcome = Outcome::same;
        double severity = 0;  // as a Disagreement's
    };
    Judged compare_one(const TraceRay& ray, const TraceHit& device, const TraceHit& embree, bool judge_anyway,
                       HitTally& tally) const;
    Verdict verdict_on(const TraceRay& ray, const TraceHit& hit) const;
    double error_share(const TraceRay& ray, const TraceHit& device, const BruteHit& exact, double bound,
                       HitTally& tally) const;

    const Scene& scene_;
    ReferenceTracer embree_;
    BruteForce oracle_;
};

}  // namespace obscura
