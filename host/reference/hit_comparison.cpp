// SPDX-License-Identifier: Apache-2.0
#include "reference/hit_comparison.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <utility>

#include "base/error.h"

namespace obscura {
namespace {

constexpr double ROUNDING = 0x1p-24;
constexpr size_t KEPT_DISAGREEMENTS = 8;  // of each outcome

constexpr double INFINITE = std::numeric_limits<double>::infinity();

// What may be left of a barycentric weight where the triangle is no thicker than rounding: it can't be told from its edges.
bool is_weight(float weight) {
    return weight >= -1 && weight <= 2;
}

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

bool HitTally::is_among_worst(Outcome outcome, double severity) const {
    const auto as_bad = [&](const Disagreement& kept) {
        return kept.outcome == outcome && kept.severity >= severity;
    };
    return static_cast<size_t>(std::ranges::count_if(disagreements, as_bad)) < KEPT_DISAGREEMENTS;
}

// Of equally bad ones the first come first.
void HitTally::keep(Disagreement disagreement) {
    const Outcome outcome = disagreement.outcome;
    const auto place = std::ranges::upper_bound(disagreements, disagreement.severity, std::greater{},
                                                &Disagreement::severity);
    disagreements.insert(place, std::move(disagreement));
    if (std::ranges::count(disagreements, outcome, &Disagreement::outcome) <=
        static_cast<ptrdiff_t>(KEPT_DISAGREEMENTS))
        return;
    const auto least = std::find_if(disagreements.rbegin(), disagreements.rend(),
                                    [&](const Disagreement& kept) { return kept.outcome == outcome; });
    disagreements.erase(std::next(least).base());
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
        if (is_among_worst(ray.outcome, ray.severity)) keep(ray);
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

Verdict HitComparison::verdict_on(const TraceRay& ray, const TraceHit& hit) const {
    return judge(oracle_, ray, hit, [&](uint32_t primitive) { return position_error(ray, primitive); });
}

HitTally HitComparison::compare(std::span<const TraceRay> rays, std::span<const TraceHit> device,
                                std::span<const TraceHit> embree, size_t every) const {
    OBSCURA_CHECK(rays.size() == device.size() && rays.size() == embree.size(),
                  "{} rays, {} hits of the device, {} of Embree", rays.size(), device.size(), embree.size());
    return tbb::parallel_deterministic_reduce(
        tbb::blocked_range<size_t>(0, rays.size(), 4096), HitTally{},
        [&](const auto& range, HitTally tally) {
            for (size_t i = range.begin(); i < range.end(); ++i) {
                const Judged judged = compare_one(rays[i], device[i], embree[i], is_drawn(i, every), tally);
                tally.count(judged.outcome, judged.severity, [&] {
                    return Disagreement{.ray = {rays[i]},
                                        .device = hit_text(scene_, device[i]),
                                        .expected = hit_text(scene_, oracle_.closest(rays[i]))};
                });
            }
            return tally;
        },
        [](HitTally a, const HitTally& b) {
            a.add(b);
            return a;
        });
}

// The outcome is the device's, but where Embree alone is wrong; beside another one, Embree's mistake is counted here.
HitComparison::Judged HitComparison::compare_one(const TraceRay& ray, const TraceHit& device,
                                                 const TraceHit& embree, bool judge_anyway,
                                                 HitTally& tally) const {
    ++tally.rays;
    Judged judged;
    Judged of_embree;
    const bool is_hit = device.primitive != NO_PRIMITIVE;
    if (is_hit) ++tally.hits;
    if (is_hit && device.primitive >= scene_.triangles.size()) return {Outcome::device_wrong, INFINITE};
    const BruteHit exact = is_hit ? oracle_.examine(ray, device.primitive) : BruteHit();
    // Then the plane tells nothing, and judge() asks how far the point is from the triangle.
    const bool is_edge_on = is_hit && exact.is_edge_on(position_error(ray, device.primitive));
    const bool same_triangle = device.primitive == embree.primitive;
    if (judge_anyway || !same_triangle || is_edge_on) {
        ++tally.judged;
        judged.outcome = outcome_of(verdict_on(ray, device));
        if (judged.outcome == Outcome::device_wrong) judged.severity = INFINITE;
        if (verdict_on(ray, embree) == Verdict::wrong) of_embree = {Outcome::embree_wrong, INFINITE};
    }
    if (is_edge_on) {
        if (!is_weight(device.u) || !is_weight(device.v)) judged = {Outcome::device_wrong, INFINITE};
    } else if (is_hit && (same_triangle || judged.outcome != Outcome::device_wrong)) {
        const double bound = distance_error(ray, exact);
        const double share = error_share(ray, device, exact, bound, tally);
        if (!(share <= 1)) judged = {Outcome::device_wrong, share};
        const double of_bound = std::abs(static_cast<double>(embree.t) - exact.t) / bound;
        if (same_triangle && !(of_bound <= 1)) of_embree = {Outcome::embree_wrong, of_bound};
    }
    if (of_embree.outcome == Outcome::same) return judged;
    if (judged.outcome == Outcome::same) return of_embree;
    ++tally.embree_wrong;
    return judged;
}

// The largest error of the device's numbers at its triangle, as a share of its bound; infinite where one is none. bound: of
// the distance.
double HitComparison::error_share(const TraceRay& ray, const TraceHit& device, const BruteHit& exact,
                                  double bound, HitTally& tally) const {
    const double error = std::abs(static_cast<double>(device.t) - exact.t);
    const double share = error / bound;
    const double u_share = std::abs(static_cast<double>(device.u) - exact.u) / weight_error(ray, exact, 1);
    const double v_share = std::abs(static_cast<double>(device.v) - exact.v) / weight_error(ray, exact, 2);
    tally.distance_share = std::max(tally.distance_share, share);
    tally.weight_share = std::max({tally.weight_share, u_share, v_share});
    tally.distance_relative = std::max(tally.distance_relative, error / exact.t);
    tally.distance_ulps = std::max(tally.distance_ulps, error / unit_in_last_place(device.t));
    if (std::isnan(share) || std::isnan(u_share) || std::isnan(v_share)) return INFINITE;
    return std::max({share, u_share, v_share});
}

}  // namespace obscura
