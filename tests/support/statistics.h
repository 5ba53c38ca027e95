// SPDX-License-Identifier: Apache-2.0
// Tests of estimates against known values: z from the standard error of independent randomisations, with a limit
// for |z| that holds for a whole table at once (Sidak 1967) and for few randomisations (Student 1908).
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace obscura::test {

struct Estimate {
    double mean = 0;
    double standard_error = 0;  // of the mean
};

inline Estimate estimate(const std::vector<double>& values) {
    const auto count = static_cast<double>(values.size());
    double sum = 0;
    for (const double value : values)
        sum += value;
    const double mean = sum / count;
    double squares = 0;
    for (const double value : values)
        squares += (value - mean) * (value - mean);
    return {mean, std::sqrt(squares / (count - 1) / count)};
}

// P(|T| > t) of Student's t with the given degrees of freedom: with t = sqrt(dof) tan(theta) the density is a power
// of the cosine.
inline double student_tail(double t, int degrees_of_freedom) {
    constexpr int STEPS = 20000;
    const auto integral = [&](double from) {
        const double width = (std::numbers::pi / 2 - from) / STEPS;
        double sum = 0;
        for (int i = 0; i < STEPS; ++i)
            sum += std::pow(std::cos(from + (i + 0.5) * width), degrees_of_freedom - 1);
        return sum * width;
    };
    return integral(std::atan(t / std::sqrt(degrees_of_freedom))) / integral(0);
}

// The |z| that the largest of `comparisons` right ones exceeds once in a hundred tables.
inline double sidak_limit(size_t comparisons, int degrees_of_freedom) {
    const double tail = -std::expm1(std::log1p(-0.01) / static_cast<double>(comparisons));
    double low = 0, high = 1000;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (student_tail(middle, degrees_of_freedom) > tail ? low : high) = middle;
    }
    return high;
}

// An estimate of a number that lies in [low, high]; rounding: what float arithmetic may add to it.
struct Comparison {
    std::string name;
    Estimate found;
    double low = 0, high = 0;
    double rounding = 0;

    // Distance from [low, high], negative below.
    double error() const { return found.mean - std::clamp(found.mean, low, high); }

    // The error beyond rounding in standard errors; infinite where there is no variance to explain it.
    double z() const {
        const double beyond = std::abs(error()) - rounding;
        if (beyond <= 0) return 0;
        return std::copysign(found.standard_error > 0 ? beyond / found.standard_error
                                                      : std::numeric_limits<double>::infinity(),
                             error());
    }
};

// Comparisons that are judged together.
class ZTable {
  public:
    // values: independent estimates of one number in [low, high], each of which float arithmetic may change by
    // `rounding`.
    void add(const std::string& name, const std::vector<double>& values, double low, double high,
             double rounding) {
        degrees_of_freedom_ = static_cast<int>(values.size()) - 1;
        rows_.push_back({name, estimate(values), low, high, rounding});
    }

    double limit() const { return sidak_limit(rows_.size(), degrees_of_freedom_); }

    // One line for each comparison beyond the limit.
    std::vector<std::string> failures() const {
        std::vector<std::string> lines;
        const double most = limit();
        for (const Comparison& row : rows_) {
            if (std::abs(row.z()) <= most) continue;
            lines.push_back(row.name + ": " + std::to_string(row.found.mean) + " +- " +
                            std::to_string(row.found.standard_error) + ", expected " +
                            std::to_string(row.low) + " .. " + std::to_string(row.high) + ", z " +
                            std::to_string(row.z()) + " beyond " + std::to_string(most));
        }
        return lines;
    }

    void expect_no_failure() const {
        ASSERT_FALSE(rows_.empty());
        for (const std::string& line : failures())
            ADD_FAILURE() << line;
    }

    // Every comparison would notice if its number were off by one per cent. Zero has no per cent.
    void expect_one_percent_matters() const {
        const double most = limit();
        for (const Comparison& row : rows_) {
            EXPECT_LE(row.high - row.low + most * row.found.standard_error, 0.01 * row.high) << row.name;
        }
    }

    // Standard errors are neither too large, which would hide what is wrong, nor too small: z varies as Student's t
    // does. For comparisons independent of each other; those that a bracket or rounding may decide don't count.
    void expect_student_spread() const {
        double sum = 0;
        size_t count = 0;
        for (const Comparison& row : rows_) {
            if (row.low < row.high || row.found.standard_error < row.rounding) continue;
            const double z = row.error() / row.found.standard_error;
            sum += z * z;
            ++count;
        }
        // Moments of t^2.
        const double dof = degrees_of_freedom_;
        const double variance = dof / (dof - 2);
        const double fourth = 3 * dof * dof / ((dof - 2) * (dof - 4));
        const auto n = static_cast<double>(count);
        ASSERT_GE(count, 100u);
        EXPECT_NEAR(sum / n, variance, 3.5 * std::sqrt((fourth - variance * variance) / n));
    }

    const std::vector<Comparison>& rows() const { return rows_; }
    size_t size() const { return rows_.size(); }
    int degrees_of_freedom() const { return degrees_of_freedom_; }

  private:
    std::vector<Comparison> rows_;
    int degrees_of_freedom_ = 1;
};

}  // namespace obscura::test
