// SPDX-License-Identifier: Apache-2.0
// The comparison of two tracers' hits: Embree's own pass for the device's, and each planted error is found and told.
#include "reference/hit_comparison.h"

#include "reference/hard_rays.h"
#include "reference/meshes.h"
#include "reference/ray_text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace obscura {
namespace {

class HitComparisonOfSphere : public testing::Test {
  protected:
    HitComparisonOfSphere() { comparison.embree().closest(rays, embree); }

    HitTally tally(const std::vector<TraceHit>& device) const {
        return comparison.compare(rays, device, embree, 1);
    }
    size_t first_hit() const {
        const auto is_hit = [](const TraceHit& hit) { return hit.primitive != NO_PRIMITIVE; };
        return static_cast<size_t>(std::ranges::find_if(embree, is_hit) - embree.begin());
    }
    // What comes of the first hit with this change, which only the oracle can judge.
    template <typename Change>
    HitTally tally_after(Change change) const {
        std::vector<TraceHit> device = embree;
        change(device[first_hit()]);
        return tally(device);
    }

    Scene scene = icosphere(2);
    std::vector<TraceRay> rays = random_rays(scene, 2000, 1);
    std::vector<TraceHit> embree = std::vector<TraceHit>(rays.size());
    HitComparison comparison{scene};
};

TEST_F(HitComparisonOfSphere, EqualHitsAreRight) {
    const HitTally all = tally(embree);
    EXPECT_EQ(all.rays, 2000u);
    EXPECT_EQ(all.judged, 2000u);
    EXPECT_GT(all.hits, 50u);
    EXPECT_LT(all.hits, 1950u);
    EXPECT_EQ(all.device_wrong + all.embree_wrong, 0u);
    EXPECT_GT(all.distance_share, 0);
    EXPECT_LT(all.distance_share, 1);
    EXPECT_LT(all.weight_share, 1);
}

TEST_F(HitComparisonOfSphere, PlantedErrorsAreTheDevices) {
    const auto expect_wrong = [](const HitTally& tally) {
        EXPECT_EQ(tally.device_wrong, 1u);
        EXPECT_EQ(tally.embree_wrong, 0u);
        ASSERT_EQ(tally.disagreements.size(), 1u);
        EXPECT_EQ(tally.disagreements[0].outcome, Outcome::device_wrong);
        EXPECT_NE(tally.disagreements[0].device, tally.disagreements[0].expected);
    };
    expect_wrong(tally_after([](TraceHit& hit) { hit.primitive = NO_PRIMITIVE; }));
    expect_wrong(tally_after([](TraceHit& hit) { hit.primitive = (hit.primitive + 160) % 320; }));
    expect_wrong(tally_after([](TraceHit& hit) { hit.t *= 1.0001f; }));
    expect_wrong(tally_after([](TraceHit& hit) { std::swap(hit.u, hit.v); }));
}

TEST_F(HitComparisonOfSphere, KeepsTheWorstDisagreementsWorstFirst) {
    std::vector<TraceHit> device = embree;
    float longer = 1;
    for (TraceHit& hit : device)
        hit.t *= longer += 0x1p-16f;
    HitTally all = tally(device);
    EXPECT_GT(all.device_wrong, 50u);
    ASSERT_EQ(all.disagreements.size(), 8u);
    std::vector<double> severities;
    for (size_t i = 0; i < rays.size(); ++i) {
        if (embree[i].primitive == NO_PRIMITIVE) continue;
        const BruteHit exact = comparison.oracle().examine(rays[i], embree[i].primitive);
        severities.push_back(std::abs(static_cast<double>(device[i].t) - exact.t) /
                             comparison.distance_error(rays[i], exact));
    }
    std::ranges::sort(severities, std::greater{});
    for (size_t i = 0; i < 8; ++i)
        EXPECT_EQ(all.disagreements[i].severity, severities[i]);

    const HitTally once = all;
    all.add(once);
    EXPECT_EQ(all.device_wrong, 2 * once.device_wrong);
    ASSERT_EQ(all.disagreements.size(), 8u);
    for (size_t i = 0; i < 8; ++i)
        EXPECT_EQ(all.disagreements[i].severity, severities[i / 2]);
}

TEST_F(HitComparisonOfSphere, MissOfWhatIsHitIsWorst) {
    std::vector<TraceHit> device = embree;
    size_t last = 0;
    for (size_t i = 0; i < device.size(); ++i) {
        if (device[i].primitive == NO_PRIMITIVE) continue;
        device[i].t *= 1.5f;
        last = i;
    }
    device[last] = {rays[last].t_max, 0, 0, NO_PRIMITIVE};
    const Disagreement worst = tally(device).disagreements.front();
    EXPECT_EQ(worst.severity, std::numeric_limits<double>::infinity());
    EXPECT_EQ(worst.ray.ray.origin, rays[last].origin);
    EXPECT_EQ(worst.device, "no hit");
}

TEST_F(HitComparisonOfSphere, NumbersThatAreNoneAreWrong) {
    const float none = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(tally_after([&](TraceHit& hit) { hit.t = none; }).device_wrong, 1u);
    EXPECT_EQ(tally_after([&](TraceHit& hit) { hit.u = none; }).device_wrong, 1u);
    EXPECT_EQ(tally_after([&](TraceHit& hit) { hit.v = none; }).device_wrong, 1u);
    EXPECT_EQ(tally_after([&](TraceHit& hit) { hit.primitive = 320; }).device_wrong, 1u) << "there are 320";
}

// A triangle that the ray sees from its edge: where its line meets the plane tells nothing, but weights are weights.
TEST(HitComparisonOfThinTriangle, WeightsOfEdgeOnHitsAreChecked) {
    MeshBuilder builder;
    const uint32_t first = builder.vertex({0, 0, 1});
    builder.vertex({1, 0, 1});
    builder.vertex({0.5f, 1e-7f, 2});
    builder.triangle(first, first + 1, first + 2);
    const Scene scene = builder.finish();
    const HitComparison comparison(scene);
    const TraceRay ray{{0.5f, 0, 0}, {0, 0, 1}, std::numeric_limits<float>::infinity()};
    const BruteHit exact = comparison.oracle().examine(ray, 0);
    ASSERT_TRUE(exact.is_edge_on(comparison.position_error(ray, 0)));
    const TraceHit right{1.5f, 0.25f, 0.5f, 0};
    const auto device_wrong = [&](TraceHit device) {
        return comparison.compare({&ray, 1}, {&device, 1}, {&right, 1}, 1).device_wrong;
    };
    EXPECT_EQ(device_wrong(right), 0u);
    EXPECT_EQ(device_wrong({1.5f, std::numeric_limits<float>::quiet_NaN(), 0.5f, 0}), 1u);
    EXPECT_EQ(device_wrong({1.5f, 0.25f, 1e30f, 0}), 1u);
    EXPECT_EQ(device_wrong({1.6f, 0.25f, 0.5f, 0}), 0u) << "on the triangle as well";
    EXPECT_EQ(device_wrong({2.5f, 0.25f, 0.5f, 0}), 1u);
}

// Where Embree names another triangle the device's own numbers are still compared.
TEST_F(HitComparisonOfSphere, WeightsAreComparedWhereEmbreeIsWrong) {
    const TraceHit& hit = embree[first_hit()];
    const TraceRay& ray = rays[first_hit()];
    const TraceHit miss{ray.t_max, 0, 0, NO_PRIMITIVE};
    TraceHit swapped = hit;
    std::swap(swapped.u, swapped.v);
    const HitTally right = comparison.compare({&ray, 1}, {&hit, 1}, {&miss, 1}, 1);
    EXPECT_EQ(right.embree_wrong, 1u);
    EXPECT_EQ(right.device_wrong, 0u);
    const HitTally wrong = comparison.compare({&ray, 1}, {&swapped, 1}, {&miss, 1}, 1);
    EXPECT_EQ(wrong.embree_wrong, 1u);
    EXPECT_EQ(wrong.device_wrong, 1u);
}

TEST(RaysJudgedAnyway, AreSpreadOverTheRaysOfAPoint) {
    constexpr size_t K = 5, POINTS = 1 << 18, EVERY = 1000;  // a multiple of K
    std::array<int, K> drawn{};
    for (size_t i = 0; i < K * POINTS; ++i)
        drawn[i % K] += is_drawn(i, EVERY) ? 1 : 0;
    // Poisson's standard deviation of 262 is 16.
    for (const int count : drawn)
        EXPECT_NEAR(count, POINTS / EVERY, 5 * 16);
    for (size_t i = 0; i < 1000; ++i)
        EXPECT_TRUE(is_drawn(i, 1));
}

// Where both tracers are wrong, both are counted, and the oracle says what is right.
TEST_F(HitComparisonOfSphere, OracleIsExpectedWhereBothAreWrong) {
    const TraceHit& hit = embree[first_hit()];
    const TraceRay& ray = rays[first_hit()];
    const TraceHit miss{ray.t_max, 0, 0, NO_PRIMITIVE};
    TraceHit far_off = hit;
    far_off.t *= 1.0001f;
    for (const auto& [device, other] : {std::pair(miss, miss), {miss, far_off}, {far_off, far_off}}) {
        const HitTally tally = comparison.compare({&ray, 1}, {&device, 1}, {&other, 1}, 1);
        EXPECT_EQ(tally.device_wrong, 1u);
        EXPECT_EQ(tally.embree_wrong, 1u);
        ASSERT_EQ(tally.disagreements.size(), 1u);
        EXPECT_EQ(tally.disagreements[0].expected, hit_text(scene, comparison.oracle().closest(ray)));
    }
}

}  // namespace
}  // namespace obscura
