// SPDX-License-Identifier: Apache-2.0
// The figures of `obscura bench`: medians, ratios pair by pair, the choice of Embree's best mode, the order of rays.
#include "reference/bench_statistics.h"

#include "reference/bench.h"
#include "reference/hard_rays.h"
#include "reference/meshes.h"
#include "reference/ray_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace obscura {
namespace {

TEST(Spread, IsMedianSmallestAndLargest) {
    const std::vector<double> odd{5, 1, 100};
    EXPECT_EQ(spread_of(odd).median, 5);
    EXPECT_EQ(spread_of(odd).min, 1);
    EXPECT_EQ(spread_of(odd).max, 100);
    const std::vector<double> even{4, 1, 2, 9};
    EXPECT_EQ(spread_of(even).median, 3);
}

// The machine slows down threefold half-way: it shows in the rates, not in the ratio.
TEST(PairedTimes, RatioIsTakenPairByPair) {
    PairedTimes times;
    times.rays = 12;
    for (size_t i = 0; i < BENCH_PAIRS; ++i) {
        times.device[i] = i < 4 ? 1 : 3;
        times.embree[i] = i < 4 ? 2 : 6;
    }
    EXPECT_EQ(times.device_rate().median, 12);
    EXPECT_EQ(times.device_rate().min, 4);
    EXPECT_EQ(times.embree_rate().median, 6);
    EXPECT_EQ(times.ratio().median, 2) << "the device is twice as fast";
    EXPECT_EQ(times.ratio().min, 2);
    EXPECT_EQ(times.ratio().max, 2);
}

TEST(PairedTimes, WithoutRaysAreZero) {
    EXPECT_EQ(PairedTimes().device_rate().median, 0);
    EXPECT_EQ(PairedTimes().ratio().max, 0);
}

QueueBench three_modes() {
    QueueBench queue;
    queue.visits.rays = 100000;
    queue.modes = {{{true, EmbreeCall::single, false, false}, 3, 10},
                   {{true, EmbreeCall::packet8, false, true}, 2, 4},
                   {{false, EmbreeCall::single, false, false}, 1, 5000}};
    return queue;
}

TEST(QueueBench, BestModeIsThatOfTheSameRobustness) {
    EXPECT_EQ(three_modes().best(true).mode, (EmbreeMode{true, EmbreeCall::packet8, false, true}));
    EXPECT_EQ(three_modes().best(false).mode, (EmbreeMode{false, EmbreeCall::single, false, false}));
}

TEST(QueueBench, AgreesUnlessARobustModeDiffersTooOften) {
    QueueBench queue = three_modes();
    EXPECT_EQ(queue.differing(), 10U);
    EXPECT_TRUE(queue.agrees());
    ++queue.modes.front().differing;
    EXPECT_FALSE(queue.agrees());
}

// One tie would be more than the share that may differ.
TEST(QueueBench, OfFewRaysAgreesInSpiteOfATie) {
    QueueBench queue = three_modes();
    queue.visits.rays = 100;
    queue.modes.front().differing = 3;
    queue.modes[1].differing = 0;
    EXPECT_TRUE(queue.agrees());
    queue.modes.front().differing = 4;
    EXPECT_FALSE(queue.agrees());
}

TEST(CoherentOrder, GroupsOctantsAndFollowsTheOrigins) {
    const Scene scene = icosphere(2);
    const std::vector<TraceRay> rays = random_rays(scene, 5000, 1);
    const std::vector<uint32_t> order = coherent_order(rays);
    std::vector<uint32_t> sorted = order;
    std::ranges::sort(sorted);
    std::vector<uint32_t> all(rays.size());
    std::iota(all.begin(), all.end(), 0u);
    ASSERT_EQ(sorted, all) << "every ray once";

    const auto octant = [&](uint32_t i) {
        const V3f& d = rays[i].direction;
        return 4 * std::signbit(d.x) + 2 * std::signbit(d.y) + std::signbit(d.z);
    };
    double distance = 0, sorted_distance = 0;
    for (size_t i = 1; i < order.size(); ++i) {
        EXPECT_LE(octant(order[i - 1]), octant(order[i]));
        distance += static_cast<double>((rays[i].origin - rays[i - 1].origin).length());
        sorted_distance += static_cast<double>((rays[order[i]].origin - rays[order[i - 1]].origin).length());
    }
    EXPECT_LT(sorted_distance, distance / 4);
}

TEST(CoherentOrder, KeepsTheOrderOfRaysThatAreAlike) {
    const std::vector<TraceRay> rays(100, TraceRay{V3f(1, 2, 3), V3f(0, 0, 1), 1});
    const std::vector<uint32_t> order = coherent_order(rays);
    EXPECT_TRUE(std::ranges::is_sorted(order));
    EXPECT_TRUE(coherent_order({}).empty());
}

}  // namespace
}  // namespace obscura
