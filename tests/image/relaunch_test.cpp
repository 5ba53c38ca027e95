// SPDX-License-Identifier: Apache-2.0
// What `obscura bench` times: a stage that is launched once more between two depths of a render does all of its work
// again, and comes to the same bits.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <set>
#include <string>
#include <vector>

#include "support/busy_room.h"
#include "support/render.h"

namespace obscura::test {
namespace {

using Relaunch = DeviceTest;
using Bits = std::array<uint32_t, 4>;

constexpr uint32_t POISON = 0xdeadbeef;
constexpr Bits POISONED{POISON, POISON, POISON, POISON};

// A stage and `count` of the values, first to last, of the buffer that it writes to.
struct Output {
    Stage stage;
    const Buffer& buffer;
    uint64_t first, values, count;
};

std::vector<Bits> read(const Output& output) {
    std::vector<Bits> values(output.values);
    output.buffer.download(values, output.first);
    return values;
}

void expect_same_again(const DepthView& view, const Output& output) {
    if (output.count == 0) return;
    SCOPED_TRACE(std::string(stage_info(output.stage).name) + " at depth " + std::to_string(view.depth));
    const std::vector<Bits> before = read(output);
    const cl::CommandQueue& queue = shared_device().queue();
    ASSERT_EQ(queue.enqueueFillBuffer(output.buffer.handle(), POISON, output.first * sizeof(Bits),
                                      output.values * sizeof(Bits)),
              CL_SUCCESS);
    view.relaunch(output.stage);
    const std::vector<Bits> after = read(output);
    uint64_t written = 0;
    for (size_t i = 0; i < after.size(); ++i) {
        if (after[i] == POISONED) continue;
        ++written;
        ASSERT_EQ(after[i], before[i]) << "value " << i;
    }
    EXPECT_EQ(written, output.count);
}

TEST_F(Relaunch, DoesTheSameWorkAgain) {
    const Scene room = busy_room();
    RenderJob job{room, picture(48, 36, 2, 3), {}};
    std::set<uint32_t> depths;
    job.observer = [&](const DepthView& view, const Frame& frame, const Queues& queues) {
        depths.insert(view.depth);
        const uint64_t capacity = frame.crop.w;
        const uint64_t light_samples = queues.visibility.bytes() / sizeof(Bits);
        const uint64_t results = queues.results.bytes() / sizeof(Bits);
        expect_same_again(view, {Stage::trace, queues.rays, RAY_HIT * capacity, capacity, view.ray_count});
        expect_same_again(view, {Stage::shadow, queues.visibility, 0, light_samples, view.shadow_count});
        expect_same_again(view, {Stage::obscurance, queues.results, 0, results, view.point_count * 3});
    };
    render_scene(device(), shared_library(64), job, [](double, const RayCounts&) { return true; });
    EXPECT_TRUE(depths.contains(1)) << "the room has reflections";
}

}  // namespace
}  // namespace obscura::test
