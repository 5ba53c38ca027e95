// SPDX-License-Identifier: Apache-2.0
// The oracle: every triangle against every ray, in long double on the scene's float vertices. Besides the
// closest hit it tells how far a ray passes from each edge, so that a tracer's different answer can be
// explained (a tie, an edge within rounding) or not (wrong).
#pragma once

#include "reference/tracer.h"
#include "scene/scene.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace obscura::test {

struct BruteRay {
    V3d origin;
    V3d direction;
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
    // Distance between the ray's line and the line of the edge opposite vertex 0, 1, 2; scene units, > 0
    // inside.
    std::array<double, 3> edge_distance{};

    bool hit() const { return primitive != NO_PRIMITIVE; }
    double inside_by() const { return std::min({edge_distance[0], edge_distance[1], edge_distance[2]}); }
    bool inside(double tolerance = 0) const { return cosine > 0 && inside_by() >= -tolerance; }
};

// The order of hits that all tracers keep: smaller t, then smaller primitive.
inline bool nearer(const BruteHit& a, const BruteHit& b) {
    return a.t < b.t || (a.t == b.t && a.primitive < b.primitive);
}

inline BruteHit intersect(const BruteRay& ray, const std::array<V3f, 3>& triangle, uint32_t primitive) {
    using V3l = Imath::Vec3<long double>;
    const V3l direction(ray.direction);
    std::array<V3l, 3> vertex;
    for (size_t i = 0; i < 3; ++i)
        vertex[i] = V3l(triangle[i]) - V3l(ray.origin);

    // Scaled by the edges' cross product, the distances are the edge functions of Woop's test.
    std::array<long double, 3> weight;
    std::array<long double, 3> sine;
    for (size_t i = 0; i < 3; ++i) {
        const V3l& from = vertex[(i + 1) % 3];
        const V3l edge = vertex[(i + 2) % 3] - from;
        const V3l across = direction.cross(edge);
        weight[i] = from.dot(across);
        sine[i] = across.length();
    }
    const V3l normal = (vertex[1] - vertex[0]).cross(vertex[2] - vertex[0]);
    const long double determinant = normal.dot(direction);  // = -(sum of the weights)
    BruteHit hit;
    hit.primitive = primitive;
    hit.cosine = static_cast<double>(std::abs(determinant) / (normal.length() * direction.length()));
    const long double sign = determinant > 0 ? -1 : 1;
    for (size_t i = 0; i < 3; ++i)
        hit.edge_distance[i] = sine[i] > 0 ? static_cast<double>(sign * weight[i] / sine[i]) : 0;
    if (determinant != 0) {
        hit.t = static_cast<double>(normal.dot(vertex[0]) / determinant);
        hit.u = static_cast<double>(-weight[1] / determinant);
        hit.v = static_cast<double>(-weight[2] / determinant);
    }
    return hit;
}

class BruteForce {
  public:
    explicit BruteForce(const Scene& scene) : scene_(scene) {
        for (const Vertex& vertex : scene.vertices)
            positions_.emplace_back(vertex.position);
    }

    BruteHit examine(const TraceRay& ray, uint32_t primitive) const {
        return intersect(brute_ray(ray), corners(primitive), primitive);
    }

    // All triangles that the ray meets with 0 < t <= t_max, also those it passes outside by up to the
    // tolerance (scene units), in the order of nearer().
    std::vector<BruteHit> candidates(const TraceRay& ray, double tolerance = 0) const {
        std::vector<BruteHit> result;
        for_each_near(brute_ray(ray), tolerance, [&](uint32_t primitive) {
            const BruteHit hit = examine(ray, primitive);
            if (hit.inside(tolerance) && hit.t > 0 && hit.t <= static_cast<double>(ray.t_max))
                result.push_back(hit);
        });
        std::sort(result.begin(), result.end(), nearer);
        return result;
    }

    // t = t_max for a miss.
    BruteHit closest(const TraceRay& ray) const {
        const auto all = candidates(ray);
        if (!all.empty()) return all.front();
        BruteHit miss;
        miss.t = static_cast<double>(ray.t_max);
        return miss;
    }

    std::vector<BruteHit> closest(std::span<const TraceRay> rays) const {
        std::vector<BruteHit> hits(rays.size());
        tbb::parallel_for(size_t{0}, rays.size(), [&](size_t i) { hits[i] = closest(rays[i]); });
        return hits;
    }

  private:
    std::array<V3f, 3> corners(uint32_t triangle) const {
        return {scene_.corner(triangle, 0).position, scene_.corner(triangle, 1).position,
                scene_.corner(triangle, 2).position};
    }

    // Calls use(primitive) for every triangle whose projection along the ray has a bounding box around the
    // ray, give or take the tolerance and the rounding of the projection.
    template <typename Use>
    void for_each_near(const BruteRay& ray, double tolerance, const Use& use) const {
        const V3d forward = ray.direction.normalized();
        const V3d axis = std::abs(forward.x) < 0.6 ? V3d(1, 0, 0) : V3d(0, 1, 0);
        const V3d right = forward.cross(axis).normalized();
        const V3d up = right.cross(forward);
        thread_local std::vector<double> x;
        thread_local std::vector<double> y;
        x.resize(positions_.size());
        y.resize(positions_.size());
        double extent = 0;
        for (size_t i = 0; i < positions_.size(); ++i) {
            const V3d offset = positions_[i] - ray.origin;
            x[i] = offset.dot(right);
            y[i] = offset.dot(up);
            extent = std::max(extent, std::abs(offset.x) + std::abs(offset.y) + std::abs(offset.z));
        }
        const double margin = tolerance + 1e-13 * extent;
        for (uint32_t primitive = 0; primitive < scene_.triangles.size(); ++primitive) {
            const auto [a, b, c] = scene_.triangles[primitive].vertex;
            if (std::min({x[a], x[b], x[c]}) <= margin && std::max({x[a], x[b], x[c]}) >= -margin &&
                std::min({y[a], y[b], y[c]}) <= margin && std::max({y[a], y[b], y[c]}) >= -margin)
                use(primitive);
        }
    }

    const Scene& scene_;
    std::vector<V3d> positions_;
};

enum class Verdict {
    same,  // the oracle's triangle, or a miss like the oracle
    tie,   // another triangle at the same distance within the tolerance
    edge,  // differs, and each triangle wrongly hit or missed is passed within the tolerance of an edge or
           // end
    wrong
};

// Judges a tracer's answer. tolerance: the error of position, in scene units, that float arithmetic may make
// at the hit; distances may differ by what it amounts to at the angle of incidence.
inline Verdict judge(const BruteForce& oracle, const TraceRay& ray, const TraceHit& answer,
                     double tolerance) {
    const double speed = V3d(ray.direction).length();
    const auto slack = [&](const BruteHit& hit) { return tolerance / (speed * std::max(hit.cosine, 1e-12)); };
    const BruteHit truth = oracle.closest(ray);
    double limit = static_cast<double>(ray.t_max);
    if (answer.primitive != NO_PRIMITIVE) {
        const BruteHit claimed = oracle.examine(ray, answer.primitive);
        if (!claimed.inside(tolerance)) return Verdict::wrong;
        if (std::abs(static_cast<double>(answer.t) - claimed.t) > slack(claimed)) return Verdict::wrong;
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
        if (missed.inside_by() > tolerance && !at_an_end) return Verdict::wrong;
    }
    return Verdict::edge;
}

}  // namespace obscura::test
