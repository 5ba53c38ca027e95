// SPDX-License-Identifier: Apache-2.0
// The statistics of `obscura sweep` against values worked out by hand or taken from tables.
#include "reference/sweep_statistics.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace obscura {
namespace {

// Tables of the t distribution.
TEST(StudentT, IsTheQuantileOfTables) {
    for (const auto& [degrees, quantile] : {std::pair{1, 12.7062},
                                            {2, 4.3027},
                                            {4, 2.7764},
                                            {9, 2.2622},
                                            {10, 2.2281},
                                            {19, 2.0930},
                                            {30, 2.0423},
                                            {1000, 1.9623}})
        EXPECT_NEAR(student_t(static_cast<size_t>(degrees)), quantile, 2e-4) << degrees;
}

TEST(EstimateMean, HasTheIntervalOfStudent) {
    const std::array values{1.0, 2.0, 3.0, 4.0};
    const Estimate estimate = estimate_mean(values);
    EXPECT_EQ(estimate.value, 2.5);
    EXPECT_DOUBLE_EQ(sample_variance(values), 5.0 / 3);
    // 3.1824 sqrt(5/3 / 4)
    EXPECT_NEAR(estimate.high - 2.5, 2.0542, 1e-4);
    EXPECT_NEAR(2.5 - estimate.low, 2.0542, 1e-4);
}

TEST(EstimateMean, OfOneValueHasNoInterval) {
    const Estimate estimate = estimate_mean(std::array{7.0});
    EXPECT_EQ(estimate.value, 7);
    EXPECT_TRUE(std::isnan(estimate.low));
    EXPECT_TRUE(std::isnan(estimate.high));
    EXPECT_TRUE(std::isnan(sample_variance(std::array{7.0})));
}

TEST(Root, TakesNegativeSquaresForZeroAndKeepsUnknownOnes) {
    const Estimate estimate = root({4, -1, std::nan("")});
    EXPECT_EQ(estimate.value, 2);
    EXPECT_EQ(estimate.low, 0);
    EXPECT_TRUE(std::isnan(estimate.high));
}

TEST(PowerLaw, GoesThroughPointsThatFollowOne) {
    const std::array x{1.0, 2.0, 4.0, 8.0};
    const std::array y{6.0, 3.0, 1.5, 0.75};
    const auto law = fit_power_law(x, y);
    ASSERT_TRUE(law);
    EXPECT_NEAR(law->factor, 6, 1e-12);
    EXPECT_NEAR(law->exponent, -1, 1e-12);
    EXPECT_NEAR(law->at(16), 0.375, 1e-12);
}

// In logarithms to base 2: x = 0, 1, 2 and y = 0, -1, -3, whose line has slope -3/2 and meets x = 0 at 1/6.
TEST(PowerLaw, IsTheLeastSquaresLineOfLogarithms) {
    const auto law = fit_power_law(std::array{1.0, 2.0, 4.0}, std::array{1.0, 0.5, 0.125});
    ASSERT_TRUE(law);
    EXPECT_NEAR(law->exponent, -1.5, 1e-12);
    EXPECT_NEAR(law->factor, std::exp2(1.0 / 6), 1e-12);
}

TEST(PowerLaw, TakesTwoAbscissasAndPositiveNumbers) {
    EXPECT_FALSE(fit_power_law(std::array{1.0}, std::array{1.0}));
    EXPECT_FALSE(fit_power_law(std::array{2.0, 2.0}, std::array{1.0, 3.0}));
    EXPECT_FALSE(fit_power_law(std::array{1.0, 2.0}, std::array{1.0, 0.0}));
    EXPECT_FALSE(fit_power_law(std::array{1.0, 2.0}, std::array{1.0, std::nan("")}));
}

// P / x = V / x + floor at x = (P - V) / floor.
TEST(Overtaking, IsWhereTheCurvesCross) {
    const auto x = overtaking({5, -1}, {1, -1}, 0.01);
    ASSERT_TRUE(x);
    EXPECT_NEAR(*x, 400, 1e-9);
    // 4 / x < 2 / sqrt(x) from x = 4 on.
    EXPECT_NEAR(overtaking({4, -1}, {2, -0.5}, 0).value(), 4, 1e-9);
}

TEST(Overtaking, IsZeroWhereOneIsAlwaysBetterAndNothingWhereNever) {
    EXPECT_EQ(overtaking({1, -1}, {2, -1}, 0.01), 0);
    EXPECT_FALSE(overtaking({2, -1}, {1, -1}, 0));
}

}  // namespace
}  // namespace obscura
