// SPDX-License-Identifier: Apache-2.0
// The table of stages: which of them a scene needs, and that the queues hold what they append.
#include "wavefront/stages.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "wavefront/queue_sizes.h"

namespace obscura {
namespace {

TEST(NeededStages, AreThoseWithWork) {
    using enum Stage;
    Needs needs;
    EXPECT_EQ(needed_stages(needs), (std::vector{camera, trace, shade, gather, film}));
    needs.ambient = true;  // constant
    EXPECT_EQ(needed_stages(needs), (std::vector{camera, trace, shade, gather, film}));
    needs.obscurance = true;
    EXPECT_EQ(needed_stages(needs), (std::vector{camera, trace, shade, obscurance, gather, film}));
    needs.spot_lights = true;
    EXPECT_EQ(needed_stages(needs), (std::vector{camera, trace, shade, shadow, obscurance, gather, film}));
    RenderSettings everything;
    everything.needs = NeedsMode::all;
    EXPECT_EQ(needed_stages(analyse_needs(Scene{}, everything)).size(), size_t{STAGE_COUNT});
}

// Every path slot has at most one ray at a depth, so it gets what the stages append for one item.
TEST(Queues, HoldWhatTheStagesAppend) {
    const std::vector<QueueShape> shapes{
        {},
        {.light_samples = 3},
        {.obscurance_rays = 5},
        {.specular_paths = true},
        {.layer_planes = 13,
         .light_samples = 8,
         .light_lobes = 2,
         .obscurance_rays = 7,
         .specular_paths = true},
    };
    for (const QueueShape& shape : shapes) {
        std::set<Queue> appended_to;
        for (const QueueSize& size : queue_sizes(shape)) {
            uint64_t appended = 0;
            for (const StageInfo& info : STAGES) {
                for (const Append& append : info.appends) {
                    if (append.most == nullptr || append.queue != size.queue) continue;
                    appended += append.most(shape);
                    appended_to.insert(size.queue);
                }
            }
            if (appended_to.contains(size.queue)) {
                EXPECT_EQ(size.items, appended) << size.name;
            }
        }
        EXPECT_EQ(appended_to, (std::set{Queue::next_rays, Queue::shadow_rays, Queue::points}));
    }
}

}  // namespace
}  // namespace obscura
