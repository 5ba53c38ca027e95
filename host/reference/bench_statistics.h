// SPDX-License-Identifier: Apache-2.0
// Figures of a benchmark in pairs: each run of one side has a run of the other right beside it, so that what else the
// machine does weighs on both.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace obscura {

constexpr size_t BENCH_PAIRS = 7;

struct Spread {
    double median = 0, min = 0, max = 0;
};
Spread spread_of(std::span<const double> values);  // at least one

// Times of the same rays on both sides, s: entry i belongs to pair i.
struct PairedTimes {
    using Seconds = std::array<double, BENCH_PAIRS>;
    uint64_t rays = 0;
    Seconds device{}, embree{};

    // Rays per second. Of no rays all is 0.
    Spread device_rate() const { return rate(device); }
    Spread embree_rate() const { return rate(embree); }
    // Device over Embree, pair by pair.
    Spread ratio() const;

  private:
    Spread rate(const Seconds& seconds) const;
};

}  // namespace obscura
