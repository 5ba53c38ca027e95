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

// Comparisons that are judged together.
class ZTable {
  public:
    // values: independent estimates of one number that lies in [low, high]; rounding: what float arithmetic may add
    // to each of them.
    void add(const std::string& name, const std::vector<double>& values, double low, double high,
             double rounding) {
        const Estimate found = estimate(values);
        degrees_of_freedom_ = static_cast<int>(values.size()) - 1;
        const double outside = std::max({low - found.mean, found.mean - high, 0.0}) - rounding;
        const double z = outside <= 0               ? 0
                         : found.standard_error > 0 ? outside / found.standard_error
                                                    : std::numeric_limits<double>::infinity();
        rows_.push_back({name, found, low, high, z});
    }

    double limit() const { return sidak_limit(rows_.size(), degrees_of_freedom_); }

    // One line for each comparison beyond the limit.
    std::vector<std::string> failures() const {
        std::vector<std::string> lines;
        const double most = limit();
        for (const Row& row : rows_) {
            if (row.z <= most) continue;
            lines.push_back(row.name + ": " + std::to_string(row.found.mean) + " +- " +
                            std::to_string(row.found.standard_error) + ", expected " +
                            std::to_string(row.low) + " .. " + std::to_string(row.high) + ", |z| " +
                            std::to_string(row.z) + " > " + std::to_string(most));
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
        for (const Row& row : rows_) {
            EXPECT_LE(row.high - row.low + most * row.found.standard_error, 0.01 * row.high) << row.name;
        }
    }

    size_t size() const { return rows_.size(); }

  private:
    struct Row {
        std::string name;
        Estimate found;
        double low, high, z;
    };
    std::vector<Row> rows_;
    int degrees_of_freedom_ = 1;
};

}  // namespace obscura::test
