// SPDX-License-Identifier: Apache-2.0
#include "reference/sweep_statistics.h"

#include "base/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace obscura {
namespace {

constexpr double UNKNOWN = std::numeric_limits<double>::quiet_NaN();

double mean(std::span<const double> values) {
    double sum = 0;
    for (const double value : values)
        sum += value;
    return sum / static_cast<double>(values.size());
}

}  // namespace

double student_t(size_t degrees_of_freedom) {
    OBSCURA_CHECK(degrees_of_freedom > 0, "a t distribution without degrees of freedom");
    constexpr std::array EXACT = {12.7062, 4.3027, 3.1824, 2.7764, 2.5706, 2.4469, 2.3646, 2.3060, 2.2622};
    if (degrees_of_freedom <= EXACT.size()) return EXACT[degrees_of_freedom - 1];
    // Cornish-Fisher expansion about the normal distribution's quantile (Abramowitz and Stegun 1964, 26.7.5).
    constexpr double Z = 1.959963985, Z2 = Z * Z;
    const auto n = static_cast<double>(degrees_of_freedom);
    return Z * (1 + (Z2 + 1) / (4 * n) + ((5 * Z2 + 16) * Z2 + 3) / (96 * n * n) +
                (((3 * Z2 + 19) * Z2 + 17) * Z2 - 15) / (384 * n * n * n));
}

double sample_variance(std::span<const double> values) {
    if (values.size() < 2) return UNKNOWN;
    const double center = mean(values);
    double squares = 0;
    for (const double value : values)
        squares += (value - center) * (value - center);
    return squares / static_cast<double>(values.size() - 1);
}

Estimate estimate_mean(std::span<const double> values) {
    OBSCURA_CHECK(!values.empty(), "no values have no mean");
    const double center = mean(values);
    if (values.size() < 2) return {center, UNKNOWN, UNKNOWN};
    const double half = student_t(values.size() - 1) *
                        std::sqrt(sample_variance(values) / static_cast<double>(values.size()));
    return {center, center - half, center + half};
}

Estimate root(const Estimate& square) {
    // NaN stays NaN: std::max(0, NaN) would be 0.
    const auto root_of = [](double x) { return x < 0 ? 0 : std::sqrt(x); };
    return {root_of(square.value), root_of(square.low), root_of(square.high)};
}

double PowerLaw::at(double x) const {
    return factor * std::pow(x, exponent);
}

std::optional<PowerLaw> fit_power_law(std::span<const double> x, std::span<const double> y) {
    OBSCURA_CHECK(x.size() == y.size(), "{} abscissas for {} ordinates", x.size(), y.size());
    const auto positive = [](double value) { return value > 0; };
    if (x.size() < 2 || !std::ranges::all_of(x, positive) || !std::ranges::all_of(y, positive))
        return std::nullopt;
    std::vector<double> log_x, log_y;
    for (size_t i = 0; i < x.size(); ++i) {
        log_x.push_back(std::log(x[i]));
        log_y.push_back(std::log(y[i]));
    }
    const double mean_x = mean(log_x), mean_y = mean(log_y);
    double squares = 0, products = 0;
    for (size_t i = 0; i < x.size(); ++i) {
        squares += (log_x[i] - mean_x) * (log_x[i] - mean_x);
        products += (log_x[i] - mean_x) * (log_y[i] - mean_y);
    }
    if (!(squares > 0)) return std::nullopt;
    const double exponent = products / squares;
    return PowerLaw{std::exp(mean_y - exponent * mean_x), exponent};
}

std::optional<double> overtaking(const PowerLaw& mse, const PowerLaw& variance, double floor) {
    const auto is_better = [&](double x) { return mse.at(x) < variance.at(x) + floor; };
    constexpr double FIRST = 1e-12, LAST = 1e30, STEP = 2;
    double x = LAST;
    if (!is_better(x)) return std::nullopt;
    while (x > FIRST && is_better(x))
        x /= STEP;
    if (x <= FIRST) return 0;
    double low = x, high = STEP * x;
    for (int i = 0; i < 60; ++i) {
        const double middle = std::sqrt(low * high);
        (is_better(middle) ? high : low) = middle;
    }
    return high;
}

}  // namespace obscura
