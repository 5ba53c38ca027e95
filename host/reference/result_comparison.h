// SPDX-License-Identifier: Apache-2.0
// What rays brought back against what they should (expected_results.h), judged as their hits are: from the triangles that
// Embree names, and from those of the oracle where that differs.
#pragma once

#include "reference/expected_results.h"
#include "reference/ray_capture.h"

#include <array>
#include <string>

namespace obscura {

using ResultValues = std::array<double, 4>;  // rgb and colourless
std::string result_text(const ResultValues& values);

// One ray's result, judged.
struct JudgedResult {
    Outcome outcome = Outcome::same;
    bool by_oracle = false;
    uint32_t first = NO_PRIMITIVE;  // that Embree meets
    bool behind_pane = false;       // the light came through panes
    double share = 0;               // largest difference, as a share of what rounding explains
    double difference = 0;          // the same, absolute
    ResultValues given{}, expected{};
};

// What came of comparing the results of one queue.
struct ResultTally {
    uint64_t checked = 0;
    uint64_t behind_panes = 0;  // of these: light came through panes
    // The largest difference that the device is to blame for, as a share of what rounding explains; and absolute.
    double worst_share = 0;
    double worst = 0;

    void add(const ResultTally& other);
    void count(const JudgedResult& judged);
};

class ResultComparison {
  public:
    ResultComparison(const Scene& scene, const RenderSettings& settings, const HitComparison& hits)
        : hits_(hits), expected_(scene, settings, hits) {}

    // Ray i of a capture. anyway: the oracle judges it even if Embree agrees.
    JudgedResult judge_shadow(const CapturedRays& captured, size_t i, bool anyway) const;
    JudgedResult judge_obscurance(const CapturedRays& captured, size_t i, const Frame& frame,
                                  bool anyway) const;

    // Adds shadow rays to the tally; of obscurance rays, which HitComparison has counted, only those whose result is not
    // what their hits explain. One ray in `every` is judged by the oracle even if Embree agrees.
    ResultTally shadow(const CapturedRays& captured, size_t every, HitTally& tally) const;
    ResultTally obscurance(const CapturedRays& captured, const Frame& frame, size_t every,
                           HitTally& tally) const;

  private:
    template <typename Expect>
    JudgedResult judge(const TraceRay& ray, const ResultValues& given, const ExpectedResults::Hits& embree,
                       const Expect& expect, bool anyway) const;

    const HitComparison& hits_;
    ExpectedResults expected_;
};

}  // namespace obscura
