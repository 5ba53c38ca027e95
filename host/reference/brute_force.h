// SPDX-License-Identifier: Apache-2.0
// The oracle: every triangle against every ray, in long double on the scene's float vertices. Besides the closest hit
// it tells how far a ray passes from each edge, and what lies across that edge, so that a tracer's different answer can
// be explained (a tie, an edge within rounding) or not (wrong).
#pragma once

#include "reference/tracer.h"
#include "scene/scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace obscura {

struct BruteRay {
    V3d origin;
    V3d direction;  // of any length but 0
};
inline BruteRay brute_ray(const TraceRay& ray) {
    return {V3d(ray.origin), V3d(ray.direction)};
}

// Where a ray's line meets a triangle's plane. t in units of the direction's length.
struct BruteHit {
    double t = std::numeric_limits<double>::infinity();
    double u = 0;  // weight of vertex 1
    double v = 0;  // weight of vertex 2
    uint32_t primitive = NO_PRIMITIVE;
    double cosine = 0;  // of the angle to the normal, 0..1; 0 = the ray lies in the plane: never a hit
    // Distance between the ray's line and the line of the edge opposite vertex 0, 1, 2; scene units, > 0 inside.
    std::array<double, 3> edge_distance{};
    // The same distance for a parallel ray through vertex 0, 1, 2: the triangle's heights as the ray sees them.
    std::array<double, 3> height{};

    bool hit() const { return primitive != NO_PRIMITIVE; }
    double inside_by() const { return std::min({edge_distance[0], edge_distance[1], edge_distance[2]}); }
    bool inside(double tolerance = 0) const { return cosine > 0 && inside_by() >= -tolerance; }
    // The triangle is no thicker than the tolerance as the ray sees it.
    bool is_edge_on(double tolerance) const {
        return std::min({height[0], height[1], height[2]}) <= tolerance;
    }
};

BruteHit intersect(const BruteRay& ray, const std::array<V3f, 3>& triangle, uint32_t primitive);

// The order of hits that all tracers keep: smaller t, then smaller primitive.
inline bool nearer(const BruteHit& a, const BruteHit& b) {
    return a.t < b.t || (a.t == b.t && a.primitive < b.primitive);
}

class BruteForce {
  public:
    explicit BruteForce(const Scene& scene);

    BruteHit examine(const TraceRay& ray, uint32_t primitive) const;

    // All triangles that the ray meets with 0 < t <= t_max, also those it passes outside by up to the tolerance (scene
    // units), in the order of nearer().
    std::vector<BruteHit> candidates(const TraceRay& ray, double tolerance = 0) const;

    // t = t_max for a miss.
    BruteHit closest(const TraceRay& ray) const;
    std::vector<BruteHit> closest(std::span<const TraceRay> rays) const;

    // Between a point and the nearest point of a triangle.
    double distance(const V3d& point, uint32_t primitive) const;

    // Whether the surface may end where the ray meets this triangle within the tolerance of an edge: the triangle, or one
    // that it is joined to there, has an edge within the tolerance beyond which nothing goes on (a border, or a fold as the
    // ray sees it). Elsewhere the neighbours go on where the triangle ends, and who misses them all fell through a crack.
    bool may_end(const TraceRay& ray, uint32_t primitive, double tolerance) const;

  private:
    using Points = std::array<uint32_t, 3>;

    Points points(uint32_t triangle) const;
    std::array<V3f, 3> corners(uint32_t triangle) const;
    template <typename Use>
    void for_each_near(const BruteRay& ray, double tolerance, const Use& use) const;
    // Triangles that share both points and lie on the other side of that edge, as the ray sees them.
    std::vector<uint32_t> across(const BruteRay& ray, uint32_t triangle, size_t opposite_corner) const;

    const Scene& scene_;
    std::vector<V3d> positions_;
    // Vertices at one position are one point: triangles that are joined need not share vertices.
    std::vector<uint32_t> point_of_vertex_;
    // Triangles around point p: around_[first_around_[p]] to around_[first_around_[p + 1]].
    std::vector<uint32_t> first_around_, around_;
};

enum class Verdict {
    same,  // the oracle's triangle, or a miss like the oracle
    tie,   // another triangle at the same distance within the tolerance
    // differs, and each triangle wrongly hit or missed is passed within the tolerance of one end of the ray or of an edge
    // at which the surface may end
    edge,
    wrong
};

// Judges a tracer's answer. tolerance(primitive): the error of position, in scene units, that float arithmetic may make
// at that triangle; distances may differ by what it amounts to at the angle of incidence.
template <typename Tolerance>
Verdict judge(const BruteForce& oracle, const TraceRay& ray, const TraceHit& answer,
              const Tolerance& tolerance) {
    const double speed = V3d(ray.direction).length();
    const auto slack = [&](const BruteHit& hit) {
        return tolerance(hit.primitive) / (speed * std::max(hit.cosine, 1e-12));
    };
    const BruteHit truth = oracle.closest(ray);
    double limit = static_cast<double>(ray.t_max);
    if (answer.primitive != NO_PRIMITIVE) {
        BruteHit claimed = oracle.examine(ray, answer.primitive);
        const double near = tolerance(answer.primitive);
        if (claimed.is_edge_on(near)) {
            // Where such a ray meets the plane means nothing: the point that the answer means has to be on the triangle.
            const auto t = static_cast<double>(answer.t);
            const V3d point = V3d(ray.origin) + t * V3d(ray.direction);
            if (!(oracle.distance(point, answer.primitive) <= near)) return Verdict::wrong;
            claimed.t = t;
            claimed.cosine = 1;
        }
        if (!claimed.inside(near)) return Verdict::wrong;
        if (!(std::abs(static_cast<double>(answer.t) - claimed.t) <= slack(claimed))) return Verdict::wrong;
        if (claimed.t < -slack(claimed) || claimed.t > limit + slack(claimed)) return Verdict::wrong;
        if (answer.primitive == truth.primitive) return Verdict::same;
        if (truth.hit() && std::abs(truth.t - claimed.t) <= slack(truth) + slack(claimed))
            return Verdict::tie;
        if (!truth.hit() || claimed.t < truth.t) return Verdict::edge;
        limit = claimed.t;
    } else if (!truth.hit()) {
        return Verdict::same;
    }
    for (const BruteHit& missed : oracle.candidates(ray)) {
        if (missed.t >= limit) break;
        const bool at_an_end = missed.t <= slack(missed) || missed.t >= limit - slack(missed);
        if (at_an_end) continue;
        const double near = tolerance(missed.primitive);
        if (missed.inside_by() > near || !oracle.may_end(ray, missed.primitive, near)) return Verdict::wrong;
    }
    return Verdict::edge;
}

}  // namespace obscura
