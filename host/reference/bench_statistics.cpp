// SPDX-License-Identifier: Apache-2.0
#include "reference/bench_statistics.h"

#include "base/error.h"

#include <algorithm>
#include <functional>
#include <vector>

namespace obscura {

Spread spread_of(std::span<const double> values) {
    OBSCURA_CHECK(!values.empty(), "no values have no median");
    std::vector<double> sorted(values.begin(), values.end());
    std::ranges::sort(sorted);
    const size_t half = sorted.size() / 2;
    const double median = sorted.size() % 2 == 1 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
    return {median, sorted.front(), sorted.back()};
}

Spread PairedTimes::rate(const Seconds& seconds) const {
    if (rays == 0) return {};
    Seconds rates;
    std::ranges::transform(seconds, rates.begin(),
                           [this](double s) { return static_cast<double>(rays) / s; });
    return spread_of(rates);
}

Spread PairedTimes::ratio() const {
    if (rays == 0) return {};
    Seconds ratios;
    std::ranges::transform(embree, device, ratios.begin(), std::divides<>());
    return spread_of(ratios);
}

}  // namespace obscura
