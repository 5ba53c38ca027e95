// SPDX-License-Identifier: Apache-2.0
// Host side of sampling: lattices, alias tables, filters, orders.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <vector>

#include "sampling/alias_table.h"
#include "sampling/filter.h"
#include "sampling/lattice.h"
#include "sampling/pixel_order.h"
#include "sampling/sample_order.h"

namespace obscura {
namespace {

// Shortest distance of two points of the lattice on the torus, by brute force, units of 1 / total.
double shortest_distance(uint32_t total, uint32_t g, uint32_t stride) {
    double best = 1e30;
    for (uint32_t j = stride; j < total; j += stride) {
        const auto centred = [&](uint64_t v) {
            const auto m = static_cast<double>(v % total);
            return std::min(m, total - m);
        };
        best = std::min(best, std::hypot(centred(j), centred(uint64_t{g} * j)));
    }
    return best;
}

TEST(Lattice, PaperSettingsGiveAGeneratorWhoseSubsetsAreGoodToo) {
    // 40 points as 8 x 5: the studies' 7 (or its equivalents by symmetry): 40-point set and each 5-point subset.
    const uint32_t g = lattice_generator(40, 8);
    EXPECT_DOUBLE_EQ(shortest_distance(40, g, 1), shortest_distance(40, 7, 1));
    EXPECT_DOUBLE_EQ(shortest_distance(40, g, 8), shortest_distance(40, 7, 8));
}

TEST(Lattice, GeneratorIsTheBestOfAllForSmallSets) {
    for (const auto& [total, stride] :
         std::vector<std::pair<uint32_t, uint32_t>>{{8, 8}, {16, 16}, {32, 8}, {64, 8}, {60, 4}}) {
        const uint32_t g = lattice_generator(total, stride);
        EXPECT_EQ(std::gcd(g, total), 1u);
        double best = 0;
        for (uint32_t other = 1; other < total; ++other) {
            if (std::gcd(other, total) == 1) best = std::max(best, shortest_distance(total, other, 1));
        }
        // Never worse than 0.7 of the best full lattice, which pays for the subsets.
        EXPECT_GE(shortest_distance(total, g, 1), 0.7 * best) << total;
    }
}

TEST(Lattice, StepsFillTheUnitIntervalEvenly) {
    for (const uint32_t total : {1u, 2u, 3u, 5u, 40u, 1000u}) {
        const LatticeSteps steps = lattice_steps(total, total);
        std::vector<uint32_t> codes;
        for (uint32_t j = 0; j < total; ++j)
            codes.push_back(j * steps.x);
        std::ranges::sort(codes);
        for (uint32_t j = 0; j < total; ++j) {
            EXPECT_NEAR(codes[j] * std::ldexp(1.0, -32), static_cast<double>(j) / total, 1e-6);
        }
    }
}

TEST(Lattice, LargeSetsAreFoundQuickly) {
    EXPECT_EQ(std::gcd(lattice_generator(1u << 22, 1u << 6), 1u << 22), 1u);
}

// Probability with which uniform columns and fractions select each index.
std::vector<double> selection(const std::vector<AliasEntry>& table) {
    const auto column = 1 / static_cast<double>(table.size());
    std::vector<double> selected(table.size(), 0);
    for (size_t i = 0; i < table.size(); ++i) {
        const auto acceptance = static_cast<double>(table[i].acceptance);
        selected[i] += acceptance * column;
        selected[table[i].alias] += (1 - acceptance) * column;
    }
    return selected;
}

TEST(AliasTable, SelectsWithTheGivenProbabilities) {
    const std::vector<double> weights{1, 0, 3, 0.5, 5.5};
    const std::vector<AliasEntry> table = build_alias_table(weights);
    const std::vector<double> selected = selection(table);
    for (size_t i = 0; i < weights.size(); ++i) {
        EXPECT_NEAR(selected[i], weights[i] / 10, 1e-6);
        EXPECT_FLOAT_EQ(table[i].probability, static_cast<float>(weights[i] / 10));
    }
}

// Of 10^5 each third is 0, and one a million times the others.
TEST(AliasTable, OneInAHundredThousandMayOutweighAllOthers) {
    for (const size_t bright : {0u, 50'000u, 99'999u}) {
        std::vector<double> weights(100'000, 1);
        for (size_t i = 2; i < weights.size(); i += 3)
            weights[i] = 0;
        weights[bright] = 1e6;
        const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
        const std::vector<AliasEntry> table = build_alias_table(weights);
        const std::vector<double> selected = selection(table);
        for (size_t i = 0; i < weights.size(); ++i) {
            ASSERT_NEAR(selected[i], weights[i] / sum, 1e-6 * weights[i] / sum) << i << ", bright " << bright;
            ASSERT_FLOAT_EQ(table[i].probability, static_cast<float>(weights[i] / sum)) << i;
        }
    }
}

TEST(AliasTable, WhatHasNoInverseInFloatIsNeverSelected) {
    for (const double tiny : {1e-38, 1e-42, 1e-60, 1e-300}) {
        const std::vector<AliasEntry> table = build_alias_table(std::vector<double>{tiny, 1, tiny});
        EXPECT_EQ(selection(table), (std::vector<double>{0, 1, 0})) << tiny;
        EXPECT_EQ(table[0].probability, 0) << tiny;
    }
}

TEST(AliasTable, AllZeroWeightsAbort) {
    EXPECT_DEATH(build_alias_table(std::vector<double>{0, 0}), "internal error");
}

TEST(Filter, OffsetsAreSymmetricAndKeepTheirRadius) {
    const std::vector<std::pair<PixelFilter, float>> filters{{PixelFilter::box, 0.5f},
                                                             {PixelFilter::tent, 1.0f},
                                                             {PixelFilter::gauss, 1.5f},
                                                             {PixelFilter::blackman_harris, 1.5f}};
    for (const auto& [filter, radius] : filters) {
        const std::vector<float> offsets = inverse_filter_cdf(filter, 128);
        ASSERT_EQ(offsets.size(), 129u);
        EXPECT_TRUE(std::ranges::is_sorted(offsets));
        EXPECT_NEAR(offsets.front(), -radius, 1e-3f);
        EXPECT_NEAR(offsets.back(), radius, 1e-3f);
        for (size_t i = 0; i < offsets.size(); ++i)
            EXPECT_NEAR(offsets[i], -offsets[128 - i], 2e-3f);
    }
}

TEST(Filter, TentInvertsItsParabola) {
    const std::vector<float> offsets = inverse_filter_cdf(PixelFilter::tent, 128);
    for (int i = 0; i <= 64; ++i) {
        EXPECT_NEAR(offsets[static_cast<size_t>(i)], -1 + std::sqrt(2 * i / 128.0), 1e-3);
    }
}

TEST(SampleOrder, IsAPermutationWhosePrefixesAreSpread) {
    for (const uint32_t spp : {1u, 2u, 5u, 8u, 100u}) {
        const std::vector<uint32_t> order = bit_reversed_order(spp);
        EXPECT_EQ(std::set<uint32_t>(order.begin(), order.end()).size(), spp);
        EXPECT_EQ(order.size(), spp);
    }
    EXPECT_EQ(bit_reversed_order(8), (std::vector<uint32_t>{0, 4, 2, 6, 1, 5, 3, 7}));
}

TEST(PixelOrder, TakesEveryPixelOnce) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {7u, 1u}, {1u, 70u}, {33u, 65u}, {64u, 32u}}) {
        const std::vector<uint32_t> order = tiled_pixel_order(width, height);
        const std::set<uint32_t> pixels(order.begin(), order.end());
        EXPECT_EQ(order.size(), size_t{width} * height);
        EXPECT_EQ(pixels.size(), order.size());
        EXPECT_EQ(*pixels.rbegin(), width * height - 1);
    }
}

TEST(PixelOrder, RunsOfPowersOfTwoAreTiles) {
    constexpr uint32_t WIDTH = 96, HEIGHT = 64;
    const std::vector<uint32_t> order = tiled_pixel_order(WIDTH, HEIGHT);
    for (const uint32_t side : {2u, 4u, 8u, 16u, 32u}) {
        for (size_t i = 0; i < order.size(); ++i) {
            const uint32_t first = order[i / (side * side) * side * side];
            EXPECT_LT(order[i] % WIDTH - first % WIDTH, side) << "place " << i;
            EXPECT_LT(order[i] / WIDTH - first / WIDTH, side) << "place " << i;
        }
    }
}

}  // namespace
}  // namespace obscura
