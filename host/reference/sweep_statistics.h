// SPDX-License-Identifier: Apache-2.0
// The statistics of `obscura sweep`: means of few independent renders, power laws through them, and where one curve of
// error against time crosses another.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace obscura {

// A value with the interval that holds the true one in 95 of 100 cases; NaN where it takes more values to tell.
struct Estimate {
    double value = 0, low = 0, high = 0;
};

// Quantile 0.975 of Student's t distribution, within 2e-4 of its value; degrees of freedom: at least 1.
double student_t(size_t degrees_of_freedom);

// Of independent values of one normal distribution; at least one.
Estimate estimate_mean(std::span<const double> values);
// Sample variance, NaN of fewer than two.
double sample_variance(std::span<const double> values);
// Root of each number; 0 where noise has made an estimate of a square negative.
Estimate root(const Estimate& square);

// y = factor x^exponent.
struct PowerLaw {
    double factor = 0, exponent = 0;
    double at(double x) const;
};

// Least squares of log y against log x. At least two different x; nothing if any number is not positive.
std::optional<PowerLaw> fit_power_law(std::span<const double> x, std::span<const double> y);

// From which x on an estimator without bias, of the given mean squared error, is better than one that ends at a floor of
// its own: the last x where mse = variance + floor. 0 if it is better everywhere, nothing if nowhere.
std::optional<double> overtaking(const PowerLaw& mse, const PowerLaw& variance, double floor);

}  // namespace obscura
