// SPDX-License-Identifier: Apache-2.0
// Visits counted during a render: every ray of every queue once, at its pixel, and without any effect on the picture.
#include "wavefront/visit_recorder.h"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "support/busy_room.h"
#include "support/render.h"

namespace obscura::test {
namespace {

class VisitRecorderTest : public DeviceTest {
  protected:
    RenderResult render_counted(const Scene& scene, const RenderSettings& settings, bool portable = false,
                                uint64_t wave_size = DEFAULT_WAVE_SIZE) {
        RenderJob job{scene, settings, {}};
        job.count_visits = true;
        job.portable = portable;
        job.wave_size = wave_size;
        return render_scene(device(), shared_library(64), job, [](double, const RayCounts&) { return true; });
    }
};

uint64_t sum(const RayVisits::Histogram& histogram) {
    return std::accumulate(histogram.begin(), histogram.end(), uint64_t{0});
}

TEST_F(VisitRecorderTest, CountsEveryRayAndLeavesThePictureAsItIs) {
    const Scene room = busy_room();
    const RenderSettings settings = picture(24, 18, 4, 3);
    for (const bool portable : {false, true}) {
        const RenderResult counted = render_counted(room, settings, portable, 512);
        ASSERT_TRUE(counted.visits);
        const auto& queues = counted.visits->queues;
        const std::array rays{counted.rays.camera, counted.rays.shadow, counted.rays.glossy,
                              counted.rays.obscurance};
        for (size_t i = 0; i < queues.size(); ++i) {
            SCOPED_TRACE(RAY_QUEUES[i]);
            EXPECT_GT(rays[i], 0u);
            EXPECT_EQ(queues[i].rays, rays[i]);
            for (const auto& histogram : {queues[i].nodes, queues[i].blocks, queues[i].stack})
                EXPECT_EQ(sum(histogram), rays[i]);
            EXPECT_EQ(queues[i].nodes.at(0), 0u) << "every ray visits the root";
        }
        const RenderResult plain = render(room, settings);
        EXPECT_FALSE(plain.visits);
        EXPECT_EQ(counted.image.layers.at(0).pixels, plain.image.layers.at(0).pixels);
    }
}

TEST_F(VisitRecorderTest, NodesOfThePixelsAreThoseOfTheRays) {
    const RenderResult result = render_counted(busy_room(), picture(24, 18, 4, 3), false, 512);
    double of_rays = 0, of_pixels = 0;
    for (const RayVisits& queue : result.visits->queues)
        of_rays += mean(queue.nodes) * static_cast<double>(queue.rays);
    for (const float nodes : result.nodes_per_sample)
        of_pixels += 4.0 * static_cast<double>(nodes);
    EXPECT_EQ(result.nodes_per_sample.size(), 24u * 18);
    EXPECT_NEAR(of_pixels / of_rays, 1, 1e-5);
}

// Ambient occlusion asks whether there is any occluder: at the same points, behind panes or not and with colours or without,
// it visits less than falloffs that have to know the nearest.
TEST_F(VisitRecorderTest, AmbientOcclusionStopsAtAnyOccluder) {
    const Scene room = busy_room();
    RenderSettings settings = picture(24, 18, 4, 3);
    settings.d_max = {std::numeric_limits<double>::infinity(), MaxDistance::Unit::metres};
    const auto blocks = [&](FalloffKind falloff) {
        settings.falloff.kind = falloff;
        const RenderResult result = render_counted(room, settings);
        const RayVisits& queue = result.visits->queues.back();
        return mean(queue.blocks) * static_cast<double>(queue.rays);
    };
    for (const NeedsMode needs : {NeedsMode::automatic, NeedsMode::all}) {
        settings.needs = needs;
        settings.bleeding = needs == NeedsMode::all;
        EXPECT_LT(blocks(FalloffKind::step), 0.9 * blocks(FalloffKind::sqrt));
    }
}

// Two panels side by side, seen from the front: the left half of the picture sees a finely divided one.
TEST_F(VisitRecorderTest, DearPixelsAreWhereTheTrianglesAre) {
    SceneBuilder builder;
    const uint32_t white = builder.material(matte(Rgb(0.5f)));
    builder.sphere({-1, 0, 0}, 0.8f, 5, white, false, true);
    builder.quad({0.2f, -0.8f, 0}, {1.6f, 0, 0}, {0, 1.6f, 0}, white);
    builder.camera({0, 0, 4}, {0, 0, 0}, 0.6);
    RenderSettings settings = picture(32, 16, 2, 1);
    const RenderResult result = render_counted(builder.finish(), settings);
    double left = 0, right = 0;
    for (uint32_t i = 0; i < 32 * 16; ++i)
        (i % 32 < 16 ? left : right) += static_cast<double>(result.nodes_per_sample[i]);
    EXPECT_GT(left, 1.5 * right);
}

}  // namespace
}  // namespace obscura::test
