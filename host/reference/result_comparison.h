// SPDX-License-Identifier: Apache-2.0
// What rays brought back against what they should: of shadow rays the light that comes through, of obscurance rays
// R(Q) rho(d) behind the panes on their way, or R_ave where nothing stops them. Expected values are in double, from the
// exact intersections with the triangles that Embree names. The tolerance of each ray follows from the roundings that
// lead to it: of the distance and the barycentric weights (hit_comparison.h), of rho, of texture coordinates, of the
// cosine at panes.
#pragma once

#include "reference/hit_comparison.h"
#include "reference/ray_capture.h"
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

// What came of comparing the results of one queue.
struct ResultTally {
    uint64_t checked = 0;
    uint64_t behind_panes = 0;  // of these: light came through panes
    double worst_share =
        0;  // largest difference that the device is to blame for, as a share of what rounding explains
    double worst = 0;  // the same, absolute

    void add(const ResultTally& other);
};

class ResultComparison {
  public:
    ResultComparison(const Scene& scene, const RenderSettings& settings, const HitComparison& hits);

    // Adds shadow rays to the tally; of obscurance rays, which HitComparison has counted, only those whose result is not
    // what their hits explain. One ray in `every` is judged by the oracle even if Embree agrees.
    ResultTally shadow(const CapturedRays& captured, size_t every, HitTally& tally) const;
    ResultTally obscurance(const CapturedRays& captured, const Frame& frame, size_t every,
                           HitTally& tally) const;

  private:
    using Hits = std::vector<BruteHit>;       // along a ray, nearest first
    using Expected = std::array<Bounded, 4>;  // rgb and colourless

    template <typename Expect>
    void compare_one(const TraceRay& ray, const f32x4& given, const Hits& hits, const Expect& expect,
                     bool judge_anyway, ResultTally& results, HitTally& tally) const;
    Expected light_through(const TraceRay& ray, const Hits& hits) const;
    Expected brought_back(const TraceRay& ray, const V3f& start, const V3f& miss, const Hits& hits) const;

    Hits hits_of_embree(const TraceRay& ray) const;
    bool is_ambiguous(const TraceRay& ray) const;
    // How far behind a pane a ray may go on beside its line: its origin is lifted off the pane.
    double lift(const BruteHit& pane) const;
    bool is_pane_hit(const BruteHit& hit) const;
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
