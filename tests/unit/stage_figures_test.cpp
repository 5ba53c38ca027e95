// SPDX-License-Identifier: Apache-2.0
// The profile's arithmetic: bytes by the lanes of a small render whose counts are known, fill, and what is said to bound a
// stage.
#include "wavefront/stage_figures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace obscura {
namespace {

// Copies 10 GB/s; a visit takes 20 ns of one of two cores.
DeviceRates rates() {
    DeviceRates device;
    device.copy_gb_per_s = 10;
    device.launch_ms = 0.1;
    device.idle_item_ns = 1;
    device.visit_ns = 20;
    device.cache_bytes = 1 << 20;
    device.cores = 2;
    return device;
}

constexpr uint64_t SMALL_TREE = 1 << 10;
constexpr uint64_t LARGE_TREE = 1 << 24;

testing::AssertionResult is_bound_by(const std::string& what, const StageFigures& figures,
                                     uint64_t bvh_bytes = SMALL_TREE) {
    const std::string text = bound_text(figures, bvh_bytes, rates());
    if (text.starts_with(what + ": ")) return testing::AssertionSuccess();
    return testing::AssertionFailure() << text;
}

TEST(Bound, StageWithoutRaysComputesUnlessItMovesWhatACopyDoes) {
    StageFigures figures;
    figures.ns_per_item = 100;
    figures.gb_per_s = 4;
    EXPECT_TRUE(is_bound_by("computing", figures));
    figures.gb_per_s = 6;
    EXPECT_TRUE(is_bound_by("memory bandwidth", figures));
    figures.gb_per_s = 14;
    EXPECT_TRUE(is_bound_by("memory bandwidth", figures));
    figures.gb_per_s = 16;
    EXPECT_TRUE(is_bound_by("cache bandwidth", figures));
}

TEST(Bound, LaunchesThatIdleComeFirst) {
    StageFigures figures;
    figures.ns_per_item = 100;
    figures.gb_per_s = 6;
    figures.idle_share = 0.6;
    EXPECT_TRUE(is_bound_by("launching", figures));
}

TEST(Bound, RaysAreBoundByTheirVisitsOrByWhatIsAroundThem) {
    StageFigures figures;
    figures.visits_per_ray = 10;  // 200 ns of a core, 100 ns of the device
    figures.ns_per_item = 150;
    EXPECT_TRUE(is_bound_by("traversal", figures));
    figures.ns_per_item = 250;
    EXPECT_TRUE(is_bound_by("computing", figures));
    EXPECT_TRUE(is_bound_by("memory latency", figures, LARGE_TREE));
}

// A hundred camera rays with two obscurance rays each, one light sample of which 60 were worth a shadow ray.
RenderResult small_render() {
    RenderResult result;
    result.rays = {.camera = 100, .shadow = 60, .glossy = 0, .obscurance = 160};
    result.shape = {.layer_planes = 4, .light_samples = 1, .light_lobes = 1, .obscurance_rays = 2};
    result.planes.fill(NO_PLANE);
    result.planes[LAYER_EMISSION] = 0;
    result.planes[LAYER_DIRECT] = 1;
    result.planes[LAYER_AMBIENT] = 2;
    result.planes[LAYER_OBSCURANCE] = 3;
    result.bytes["bvh"] = SMALL_TREE;
    for (const char* row : {"camera", "trace_camera", "shade", "gather"})
        result.profile[row] = {1, 100, 128, 1.0};
    result.profile["shadow"] = {1, 60, 128, 1.0};
    result.profile["obscurance"] = {1, 160, 128, 3.0};
    result.profile["film"] = {1, 25, 64, 1.0};
    result.visits.emplace();
    result.visits->queues[0].add(4, 1, 2);
    result.visits->queues[0].add(8, 3, 3);
    return result;
}

StageFigures figures_of(const std::string& row) {
    const std::vector<StageFigures> rows = stage_figures(small_render(), rates());
    return *std::ranges::find(rows, row, &StageFigures::row);
}

TEST(StageFigures, RowsAreThoseOfTheProfileInTheOrderOfTheStages) {
    std::vector<std::string> names;
    for (const StageFigures& figures : stage_figures(small_render(), rates()))
        names.push_back(figures.row);
    EXPECT_EQ(names, (std::vector<std::string>{"camera", "trace_camera", "shade", "shadow", "obscurance",
                                               "gather", "film"}));
}

TEST(StageFigures, BytesAreThoseOfTheLanes) {
    // Origin, direction, throughput, sample.
    EXPECT_EQ(figures_of("camera").bytes, 100u * 4 * 16);
    EXPECT_EQ(figures_of("trace_camera").bytes, 100u * 3 * 16);
    // The ray with its hit, throughput, sample; ambient, a light contribution; emission; shadow rays of two lanes, 80
    // points of three.
    EXPECT_EQ(figures_of("shade").bytes, (100u * (5 + 2 + 1) + 60 * 2 + 80 * 3) * 16);
    EXPECT_EQ(figures_of("shadow").bytes, 60u * 3 * 16);
    EXPECT_EQ(figures_of("obscurance").bytes, (80u * 4 + 160) * 16);
    // Slot, ambient, a light contribution; visibility, results; three layers, written; the sample of each point, read
    // and written.
    EXPECT_EQ(figures_of("gather").bytes, (100u * 3 + 60 + 160 + 100 * 3 + 80 * 2) * 16);
    // Each sample's layers; each pixel's sums with what rounding left over, read and written.
    EXPECT_EQ(figures_of("film").bytes, (100u * 4 + 25 * 4 * 4) * 16);
}

TEST(StageFigures, ShareSpeedAndFillFollowFromTheCounts) {
    const StageFigures obscurance = figures_of("obscurance");
    EXPECT_DOUBLE_EQ(obscurance.share, 3.0 / 9);
    EXPECT_DOUBLE_EQ(obscurance.ns_per_item, 3e6 / 160);
    EXPECT_DOUBLE_EQ(obscurance.mrays_per_s, 160 / 3e3);
    EXPECT_DOUBLE_EQ(obscurance.gb_per_s, 480 * 16 / 3e6);
    EXPECT_DOUBLE_EQ(obscurance.fill, 80.0 / 128);
    EXPECT_DOUBLE_EQ(obscurance.idle_share, (0.1 + 48e-6) / 3);
    EXPECT_DOUBLE_EQ(figures_of("trace_camera").visits_per_ray, 8);
    EXPECT_DOUBLE_EQ(figures_of("shade").mrays_per_s, 0);
}

TEST(RayVisits, AreHistograms) {
    RayVisits visits;
    visits.add(3, 0, 1);
    visits.add(1, 0, 1);
    visits.add(3, 2, 0);
    EXPECT_EQ(visits.rays, 3u);
    EXPECT_EQ(visits.nodes, (RayVisits::Histogram{0, 1, 0, 2}));
    EXPECT_EQ(visits.blocks, (RayVisits::Histogram{2, 0, 1}));
    EXPECT_EQ(visits.stack, (RayVisits::Histogram{1, 2}));
    EXPECT_DOUBLE_EQ(mean(visits.nodes), 7.0 / 3);
    EXPECT_EQ(mean({}), 0);
}

}  // namespace
}  // namespace obscura
