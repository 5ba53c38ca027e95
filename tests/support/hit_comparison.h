// SPDX-License-Identifier: Apache-2.0
// Compares the device's hits with Embree's, and judges every difference by the brute-force oracle. What float
// arithmetic may do to a hit is bounded here, so that "on an edge" and "same distance" are statements, not excuses.
//
// The bound. Let M be the largest coordinate difference between the ray's origin and a vertex, u = 2^-24. The
// shear test rounds p - o once (u M), the shear's slope once or, where division is inexact, by 2.5 ulp (5 u), its
// product once and the difference once (2 u): each sheared coordinate is off by at most 9 u M, which shifts a
// projected vertex by 9 sqrt(2) u M < 13 u M. Whether the ray is inside, plain edge functions decide: that of two
// vertices a, b is off by 3 u |a| |b|, that is 3 u |a| |b| / |a - b| < 3 u M as a distance from an edge beside which the
// ray passes. Together: 16 u M. The distance comes from exact edge functions instead: it is that of the shifted corners,
// so that slivers make it no worse, and its own few roundings are relative to it. Along the ray a shift grows with 1 / cos
// of the angle to the triangle's normal; 16 u M / cos is taken as the bound of the distance too.
#pragma once

#include "reference/tracer.h"
#include "support/brute_force.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

namespace obscura::test {

enum class Outcome { same, tie, edge, embree_wrong, device_wrong };

constexpr const char* outcome_name(Outcome outcome) {
    constexpr const char* NAMES[] = {"same", "tie", "edge", "Embree wrong", "device wrong"};
    return NAMES[static_cast<size_t>(outcome)];
}

struct Disagreement {
    TraceRay ray;
    TraceHit device, embree;
    Outcome outcome;

    std::string text() const {
        const auto hit = [](const TraceHit& h) {
            return h.primitive == NO_PRIMITIVE ? std::string("miss")
                                               : fmt::format("{} at {:.9g}", h.primitive, h.t);
        };
        return fmt::format(
            "{}: device {}, Embree {}; origin {:.9g} {:.9g} {:.9g} direction {:.9g} {:.9g} {:.9g} t < {}",
            outcome_name(outcome), hit(device), hit(embree), ray.origin.x, ray.origin.y, ray.origin.z,
            ray.direction.x, ray.direction.y, ray.direction.z, ray.t_max);
    }
};

struct Tally {
    uint64_t rays = 0, hits = 0;
    uint64_t same = 0, tie = 0, edge = 0, embree_wrong = 0, device_wrong = 0;
    // Largest errors of the device's distances where the triangle is undisputed: as a share of the bound, and in
    // scene units.
    double worst_share = 0, worst_error = 0;
    std::vector<Disagreement> disagreements;

    void count(Outcome outcome) {
        uint64_t* const counts[] = {&same, &tie, &edge, &embree_wrong, &device_wrong};
        ++*counts[static_cast<size_t>(outcome)];
    }

    void add(const Tally& other) {
        rays += other.rays;
        hits += other.hits;
        same += other.same;
        tie += other.tie;
        edge += other.edge;
        embree_wrong += other.embree_wrong;
        device_wrong += other.device_wrong;
        worst_share = std::max(worst_share, other.worst_share);
        worst_error = std::max(worst_error, other.worst_error);
        disagreements.insert(disagreements.end(), other.disagreements.begin(), other.disagreements.end());
    }

    static std::string header() {
        return fmt::format("{:<12}{:>10}{:>10}{:>10}{:>7}{:>7}{:>14}{:>14}{:>16}{:>16}\n", "rays", "number",
                           "hits", "same", "ties", "edges", "Embree wrong", "device wrong", "error / bound",
                           "largest error");
    }
    std::string row(const std::string& name) const {
        return fmt::format("{:<12}{:>10}{:>10}{:>10}{:>7}{:>7}{:>14}{:>14}{:>16.3f}{:>16.2e}\n", name, rays,
                           hits, same, tie, edge, embree_wrong, device_wrong, worst_share, worst_error);
    }
};

class HitComparison {
  public:
    explicit HitComparison(const Scene& scene) : scene_(scene), embree_(scene), oracle_(scene) {
        for (uint32_t i = 0; i < scene.triangles.size(); ++i) {
            const V3d a(scene.corner(i, 0).position);
            const V3d normal =
                (V3d(scene.corner(i, 1).position) - a).cross(V3d(scene.corner(i, 2).position) - a);
            planes_.push_back({normal.normalized(), a});
        }
    }

    // The error of position that the file's head derives, scene units.
    double position_error(const TraceRay& ray) const {
        constexpr double ROUNDING = 0x1p-24;
        if (scene_.triangles.empty()) return 0;
        double reach = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double origin = static_cast<double>(ray.origin[axis]);
            reach = std::max({reach, std::abs(static_cast<double>(scene_.bounds.min[axis]) - origin),
                              std::abs(static_cast<double>(scene_.bounds.max[axis]) - origin)});
        }
        return 16 * ROUNDING * reach;
    }

    // The exact distance at which the ray meets a triangle's plane, and the error that float arithmetic may make.
    struct Distance {
        double t, bound;
    };
    Distance distance(const TraceRay& ray, uint32_t primitive) const {
        const Plane& plane = planes_[primitive];
        const V3d direction(ray.direction);
        const double along = plane.normal.dot(direction);
        const double t = plane.normal.dot(plane.point - V3d(ray.origin)) / along;
        return {t, position_error(ray) / std::max(std::abs(along), 1e-12 * direction.length())};
    }

    // Embree's hits, which every caller needs for its own checks too.
    std::vector<TraceHit> embree(std::span<const TraceRay> rays) const {
        std::vector<TraceHit> hits(rays.size());
        embree_.closest(rays, hits);
        return hits;
    }

    Outcome judge_difference(const TraceRay& ray, const TraceHit& device, const TraceHit& embree) const {
        const double tolerance = position_error(ray);
        const Verdict ours = judge(oracle_, ray, device, tolerance);
        if (ours == Verdict::wrong) return Outcome::device_wrong;
        const Verdict theirs = judge(oracle_, ray, embree, tolerance);
        if (theirs == Verdict::wrong) return Outcome::embree_wrong;
        if (ours == Verdict::tie || theirs == Verdict::tie) return Outcome::tie;
        return ours == Verdict::edge || theirs == Verdict::edge ? Outcome::edge : Outcome::same;
    }

    // One ray in `every` is judged even if both agree: they could be wrong together.
    Tally compare(std::span<const TraceRay> rays, std::span<const TraceHit> device,
                  std::span<const TraceHit> embree, size_t every = 10000) const {
        return tbb::parallel_reduce(
            tbb::blocked_range<size_t>(0, rays.size(), 4096), Tally{},
            [&](const auto& range, Tally tally) {
                for (size_t i = range.begin(); i < range.end(); ++i)
                    compare_one(rays[i], device[i], embree[i], i % every == 0, tally);
                return tally;
            },
            [](Tally a, const Tally& b) {
                a.add(b);
                return a;
            });
    }

  private:
    struct Plane {
        V3d normal, point;
    };

    void compare_one(const TraceRay& ray, const TraceHit& device, const TraceHit& embree, bool judge_anyway,
                     Tally& tally) const {
        ++tally.rays;
        if (device.primitive != NO_PRIMITIVE) ++tally.hits;
        bool agree = device.primitive == embree.primitive;
        if (agree && device.primitive != NO_PRIMITIVE) {
            const Distance exact = distance(ray, device.primitive);
            const double error = std::abs(static_cast<double>(device.t) - exact.t);
            tally.worst_share = std::max(tally.worst_share, error / exact.bound);
            tally.worst_error = std::max(tally.worst_error, error);
            agree = error <= exact.bound && std::abs(static_cast<double>(embree.t) - exact.t) <= exact.bound;
        }
        if (agree && !judge_anyway) {
            ++tally.same;
            return;
        }
        const Outcome outcome = judge_difference(ray, device, embree);
        tally.count(outcome);
        if (outcome != Outcome::same) tally.disagreements.push_back({ray, device, embree, outcome});
    }

    const Scene& scene_;
    ReferenceTracer embree_;
    BruteForce oracle_;
    std::vector<Plane> planes_;
};

}  // namespace obscura::test
