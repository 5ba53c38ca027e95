// SPDX-License-Identifier: Apache-2.0
#include "reference/result_comparison.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace obscura {
namespace {

// How far values are from what is expected.
struct Difference {
    double share = 0, largest = 0;
};

Difference difference(const ResultValues& values, const ExpectedResult& expected) {
    Difference worst;
    for (size_t i = 0; i < values.size(); ++i) {
        const double apart = std::abs(values[i] - expected[i].value);
        worst.largest = std::max(worst.largest, apart);
        const double share = apart == 0 ? 0 : apart / expected[i].error;
        worst.share =
            std::max(worst.share, std::isnan(share) ? std::numeric_limits<double>::infinity() : share);
    }
    return worst;
}

ResultValues values_of(const f32x4& lane) {
    return {static_cast<double>(lane.x), static_cast<double>(lane.y), static_cast<double>(lane.z),
            static_cast<double>(lane.w)};
}

// Both tallies of a chunk of rays.
struct Tallies {
    ResultTally results;
    HitTally hits;

    static Tallies sum(Tallies a, const Tallies& b) {
        a.results.add(b.results);
        a.hits.add(b.hits);
        return a;
    }
};

template <typename Compare>
ResultTally for_each_ray(size_t count, HitTally& tally, const Compare& compare) {
    const Tallies all = tbb::parallel_deterministic_reduce(
        tbb::blocked_range<size_t>(0, count, 4096), Tallies{},
        [&](const auto& range, Tallies tallies) {
            for (size_t i = range.begin(); i < range.end(); ++i)
                compare(i, tallies);
            return tallies;
        },
        Tallies::sum);
    tally.add(all.hits);
    return all.results;
}

void count(const JudgedResult& judged, const Disagreement& ray, Tallies& tallies) {
    tallies.results.count(judged);
    if (judged.by_oracle) ++tallies.hits.judged;
    tallies.hits.count(judged.outcome, judged.share, [&] {
        Disagreement told = ray;
        told.device = result_text(judged.given);
        told.expected = result_text(judged.expected);
        return told;
    });
}

}  // namespace

std::string result_text(const ResultValues& values) {
    return fmt::format("rgb {:.9g} {:.9g} {:.9g}, without colours {:.9g}", values[0], values[1], values[2],
                       values[3]);
}

void ResultTally::add(const ResultTally& other) {
    checked += other.checked;
    behind_panes += other.behind_panes;
    worst_share = std::max(worst_share, other.worst_share);
    worst = std::max(worst, other.worst);
}

void ResultTally::count(const JudgedResult& judged) {
    ++checked;
    if (judged.behind_pane) ++behind_panes;
    if (judged.outcome == Outcome::edge) return;
    worst_share = std::max(worst_share, judged.share);
    worst = std::max(worst, judged.difference);
}

// expect: what a ray with these hits brings back.
template <typename Expect>
JudgedResult ResultComparison::judge(const TraceRay& ray, const ResultValues& given,
                                     const ExpectedResults::Hits& embree, const Expect& expect,
                                     bool anyway) const {
    ExpectedResult expected = expect(embree);
    Difference found = difference(given, expected);
    JudgedResult judged;
    judged.given = given;
    if (!embree.empty()) {
        judged.first = embree.front().primitive;
        judged.behind_pane = expected_.is_pane_hit(embree.front());
    }
    judged.by_oracle = anyway || found.share > 1;
    if (judged.by_oracle) {
        expected = expect(hits_.oracle().candidates(ray));
        const Difference truth = difference(given, expected);
        if (truth.share > 1) {
            judged.outcome = expected_.is_ambiguous(ray) ? Outcome::edge : Outcome::device_wrong;
        } else if (found.share > 1 && !expected_.is_ambiguous(ray)) {
            // Else Embree's rounding may be to blame, also at the ends, which it includes.
            judged.outcome = Outcome::embree_wrong;
        }
        found = truth;
    }
    judged.share = found.share;
    judged.difference = found.largest;
    for (size_t i = 0; i < expected.size(); ++i)
        judged.expected[i] = expected[i].value;
    return judged;
}

JudgedResult ResultComparison::judge_shadow(const CapturedRays& captured, size_t i, bool anyway) const {
    const TraceRay& ray = captured.rays[i];
    f32x4 given = captured.results[i];
    given.w = (given.x + given.y + given.z) / 3;
    const auto expect = [&](const ExpectedResults::Hits& hits) { return expected_.light_through(ray, hits); };
    return judge(ray, values_of(given), expected_.hits_of_embree(ray), expect, anyway);
}

JudgedResult ResultComparison::judge_obscurance(const CapturedRays& captured, size_t i, const Frame& frame,
                                                bool anyway) const {
    const TraceRay& ray = captured.rays[i];
    const V3f miss(frame.miss.x, frame.miss.y, frame.miss.z);
    const auto expect = [&](const ExpectedResults::Hits& hits) {
        return expected_.brought_back(ray, captured.starts[i], miss, hits);
    };
    return judge(ray, values_of(captured.results[i]), expected_.hits_of_embree(ray), expect, anyway);
}

ResultTally ResultComparison::shadow(const CapturedRays& captured, size_t every, HitTally& tally) const {
    return for_each_ray(captured.rays.size(), tally, [&](size_t i, Tallies& tallies) {
        const JudgedResult judged = judge_shadow(captured, i, is_drawn(i, every));
        ++tallies.hits.rays;
        if (judged.given[3] == 0) ++tallies.hits.hits;
        count(judged, {.ray = {captured.rays[i]}}, tallies);
    });
}

ResultTally ResultComparison::obscurance(const CapturedRays& captured, const Frame& frame, size_t every,
                                         HitTally& tally) const {
    return for_each_ray(captured.rays.size(), tally, [&](size_t i, Tallies& tallies) {
        const JudgedResult judged = judge_obscurance(captured, i, frame, is_drawn(i, every));
        if (judged.first != captured.hits[i].primitive) return;
        count(judged, {.ray = {captured.rays[i], captured.starts[i]}}, tallies);
    });
}

}  // namespace obscura
