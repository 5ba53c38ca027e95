// SPDX-License-Identifier: Apache-2.0
// What a ray should bring back, in double from exact intersections: a shadow ray the light that comes through, an
// obscurance ray R(Q) rho(d) behind the panes on its way, or R_ave where nothing stops it. With it how far rounding may
// lead from that, which follows from the roundings on the way: of the distance and the barycentric weights
// (hit_comparison.h), of rho, of texture coordinates, of the cosine at panes.
#pragma once

#include "reference/hit_comparison.h"
#include "scene/material.h"
#include "scene/settings.h"
#include "scene/texture.h"

#include <array>
#include <vector>

namespace obscura {

// A value, and how far from it rounding may lead.
struct Bounded {
    double value = 0, error = 0;
};
using BoundedRgb = std::array<Bounded, 3>;
using ExpectedResult = std::array<Bounded, 4>;  // rgb and colourless

class ExpectedResults {
  public:
    ExpectedResults(const Scene& scene, const RenderSettings& settings, const HitComparison& hits);

    using Hits = std::vector<BruteHit>;  // along a ray, nearest first
    ExpectedResult light_through(const TraceRay& ray, const Hits& hits) const;
    // start: the ray's origin relative to its point; miss: R_ave.
    ExpectedResult brought_back(const TraceRay& ray, const V3f& start, const V3f& miss,
                                const Hits& hits) const;

    // Exact intersections with the triangles that Embree meets, up to the first that stops the ray.
    Hits hits_of_embree(const TraceRay& ray) const;
    // Whether rounding may decide what the ray meets: up to the first surface that stops it, a triangle's edge or
    // another triangle is within the errors, or an end of the ray is.
    bool is_ambiguous(const TraceRay& ray) const;
    bool is_pane_hit(const BruteHit& hit) const;

  private:
    // How far behind a pane a ray may go on beside its line: its origin is lifted off the pane.
    double lift(const BruteHit& pane) const;
    BoundedRgb base_color(const TraceRay& ray, const BruteHit& hit) const;
    BoundedRgb passed_by(const TraceRay& ray, const BruteHit& pane) const;
    Bounded falloff(const TraceRay& ray, const V3f& start, const BruteHit& hit, double lateral) const;

    const Scene& scene_;
    const RenderSettings& settings_;
    const HitComparison& hits_;
    double d_max_;
    double reach_;  // largest distance within the scene's bounds, m
    std::vector<SurfaceModel> models_;
    std::vector<TextureIntegral> textures_;
};

}  // namespace obscura
