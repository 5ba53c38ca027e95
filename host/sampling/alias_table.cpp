// SPDX-License-Identifier: Apache-2.0
#include "sampling/alias_table.h"

#include "base/error.h"

#include <cmath>
#include <limits>
#include <numeric>

namespace obscura {

namespace {

// Estimates divide by the probability: what is less than a normal float is never selected.
constexpr double SMALLEST_SHARE = static_cast<double>(std::numeric_limits<float>::min());

}  // namespace

std::vector<AliasEntry> build_alias_table(std::span<const double> weights) {
    const size_t count = weights.size();
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    OBSCURA_CHECK(count > 0 && std::isfinite(sum) && sum > 0, "{} weights with sum {}", count, sum);

    std::vector<AliasEntry> table(count);
    std::vector<double> scaled(count);  // 1 = an average column
    std::vector<uint32_t> small, large;
    for (uint32_t i = 0; i < count; ++i) {
        OBSCURA_CHECK(weights[i] >= 0, "weight {} is {}", i, weights[i]);
        double share = weights[i] / sum;
        if (share < SMALLEST_SHARE) share = 0;
        scaled[i] = share * static_cast<double>(count);
        table[i] = {1.0f, i, static_cast<float>(share)};
        (scaled[i] < 1 ? small : large).push_back(i);
    }
    // Each small column is filled up by a large one. What is left over at the end differs from 1 by rounding only.
    while (!small.empty() && !large.empty()) {
        const uint32_t low = small.back();
        const uint32_t high = large.back();
        small.pop_back();
        table[low].acceptance = static_cast<float>(scaled[low]);
        table[low].alias = high;
        scaled[high] -= 1 - scaled[low];
        if (scaled[high] < 1) {
            large.pop_back();
            small.push_back(high);
        }
    }
    return table;
}

}  // namespace obscura
