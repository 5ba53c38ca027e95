// SPDX-License-Identifier: Apache-2.0
#include "reference/hit_comparison.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"
#include "reference/ray_text.h"

namespace obscura {
namespace {

constexpr double ROUNDING = 0x1p-24;
constexpr size_t KEPT_DISAGREEMENTS = 8;  // of each outcome

double unit_in_last_place(float value) {
    const float next = std::nextafter(std::abs(value), std::numeric_limits<float>::infinity());
    return static_cast<double>(next) - static_cast<double>(std::abs(value));
}

// What a verdict on the device's hit comes to.
Outcome outcome_of(Verdict verdict) {
    switch (verdict) {
        case Verdict::same:
            return Outcome::same;
        case Verdict::tie:
            return Outcome::tie;
        case Verdict::edge:
            return Outcome::edge;
        case Verdict::wrong:
            return Outcome::device_wrong;
    }
    OBSCURA_CHECK(false, "verdict {}", static_cast<int>(verdict));
}

}  // namespace

std::string outcome_text(Outcome outcome) {
    switch (outcome) {
        case Outcome::same:
            return "the same";
        case Outcome::tie:
            return "a tie";
        case Outcome::edge:
            return "at an edge";
        case Outcome::embree_wrong:
            return "Embree wrong";
        case Outcome::device_wrong:
            return "device wrong";
    }
    OBSCURA_CHECK(false, "outcome {}", static_cast<int>(outcome));
}

// The index mixed by SplitMix64 (Steele, Lea, Flood 2014).
bool is_drawn(size_t i, size_t every) {
    uint64_t mixed = (i + 1) * 0x9e3779b97f4a7c15u;
    mixed = (mixed ^ mixed >> 30) * 0xbf58476d1ce4e5b9u;
    mixed = (mixed ^ mixed >> 27) * 0x94d049bb133111ebu;
    return (mixed ^ mixed >> 31) % every == 0;
}

uint64_t* HitTally::count_of(Outcome outcome) {
    if (outcome == Outcome::tie) return &ties;
    if (outcome == Outcome::edge) return &edges;
    return outcome == Outcome::embree_wrong ? &embree_wrong : &device_wrong;
}

bool HitTally::keeps(Outcome outcome) const {
    const auto kept = std::ranges::count(disagreements, outcome, &Disagreement::outcome);
    return static_cast<size_t>(kept) < KEPT_DISAGREEMENTS;
}

void HitTally::add(const HitTally& other) {
    rays += other.rays;
    hits += other.hits;
    judged += other.judged;
    ties += other.ties;
    edges += other.edges;
    embree_wrong += other.embree_wrong;
    device_wrong += other.device_wrong;
    distance_share = std::max(distance_share, other.distance_share);
    weight_share = std::max(weight_share, other.weight_share);
    distance_relative = std::max(distance_relative, other.distance_relative);
    distance_ulps = std::max(distance_ulps, other.distance_ulps);
    for (const Disagreement& ray : other.disagreements)
        if (keeps(ray.outcome)) disagreements.push_back(ray);
}

double HitComparison::position_error(const TraceRay& ray, uint32_t primitive) const {
    double reach = 0;
    for (int corner = 0; corner < 3; ++corner) {
        const V3d offset = V3d(scene_.corner(primitive, corner).position) - V3d(ray.origin);
        reach = std::max({reach, std::abs(offset.x), std::abs(offset.y), std::abs(offset.z)});
    }
    return 16 * ROUNDING * reach;
}

double HitComparison::distance_error(const TraceRay& ray, const BruteHit& exact) const {
    const double speed = V3d(ray.direction).length();
    return position_error(ray, exact.primitive) / (speed * std::max(exact.cosine, 1e-12));
}

double HitComparison::weight_error(const TraceRay& ray, const BruteHit& exact, size_t corner) const {
    const double shift = position_error(ray, exact.primitive);
    const double of_the_sum = 1 / exact.height[0] + 1 / exact.height[1] + 1 / exact.height[2];
    return shift * (1 / exact.height[corner] + of_the_sum) + 8 * ROUNDING;
}

Outcome HitComparison::judge_both(const TraceRay& ray, const TraceHit& device, const TraceHit& embree,
                                  HitTally& tally) const {
    const auto verdict_on = [&](const TraceHit& hit) {
        return judge(oracle_, ray, hit, [&](uint32_t primitive) { return position_error(ray, primitive); });
    };
    const Outcome outcome = outcome_of(verdict_on(device));
    if (verdict_on(embree) != Verdict::wrong) return outcome;
    if (outcome == Outcome::same) return Outcome::embree_wrong;
    ++tally.embree_wrong;
    return outcome;
}

HitTally HitComparison::compare(std::span<const TraceRay> rays, std::span<const TraceHit> device,
                                std::span<const TraceHit> embree, size_t every) const {
    OBSCURA_CHECK(rays.size() == device.size() && rays.size() == embree.size(),
                  "{} rays, {} hits of the device, {} of Embree", rays.size(), device.size(), embree.size());
    return tbb::parallel_deterministic_reduce(
        tbb::blocked_range<size_t>(0, rays.size(), 4096), HitTally{},
        [&](const auto& range, HitTally tally) {
            for (size_t i = range.begin(); i < range.end(); ++i) {
                const Outcome outcome = compare_one(rays[i], device[i], embree[i], is_drawn(i, every), tally);
                tally.count(outcome, rays[i], [&] {
                    return std::pair(hit_text(scene_, device[i]), hit_text(scene_, oracle_.closest(rays[i])));
                });
            }
            return tally;
        },
        [](HitTally a, const HitTally& b) {
            a.add(b);
            return a;
        });
}

Outcome HitComparison::compare_one(const TraceRay& ray, const TraceHit& device, const TraceHit& embree,
                                   bool judge_anyway, HitTally& tally) const {
    ++tally.rays;
    if (device.primitive != NO_PRIMITIVE) ++tally.hits;
    if (judge_anyway || device.primitive != embree.primitive) {
        ++tally.judged;
        const Outcome outcome = judge_both(ray, device, embree, tally);
        if (outcome != Outcome::same || device.primitive != embree.primitive) return outcome;
    }
    return device.primitive == NO_PRIMITIVE ? Outcome::same : compare_errors(ray, device, embree, tally);
}

// Both tracers name the same triangle: distances and weights against the exact ones.
Outcome HitComparison::compare_errors(const TraceRay& ray, const TraceHit& device, const TraceHit& embree,
                                      HitTally& tally) const {
    const BruteHit exact = oracle_.examine(ray, device.primitive);
    const double bound = distance_error(ray, exact);
    const double error = std::abs(static_cast<double>(device.t) - exact.t);
    tally.distance_share = std::max(tally.distance_share, error / bound);
    tally.distance_relative = std::max(tally.distance_relative, error / exact.t);
    tally.distance_ulps = std::max(tally.distance_ulps, error / unit_in_last_place(device.t));

    const double u_share = std::abs(static_cast<double>(device.u) - exact.u) / weight_error(ray, exact, 1);
    const double v_share = std::abs(static_cast<double>(device.v) - exact.v) / weight_error(ray, exact, 2);
    const double worst_weight = std::max(u_share, v_share);
    tally.weight_share = std::max(tally.weight_share, worst_weight);

    const double embree_error = std::abs(static_cast<double>(embree.t) - exact.t);
    const bool embree_right = embree_error <= bound;
    if (error <= bound && worst_weight <= 1) return embree_right ? Outcome::same : Outcome::embree_wrong;
    if (!embree_right) ++tally.embree_wrong;
    return Outcome::device_wrong;
}

}  // namespace obscura
