// SPDX-License-Identifier: Apache-2.0
// The table of the wavefront's stages: from it kernels are compiled, launched, profiled, named in messages and tested.
// A stage called `shadow` is kernels/shadow.cl, its kernel, Stage::shadow and tests/kernel/shadow_test.cpp.
#pragma once

#include "device/launch.h"
#include "device/scene_buffers.h"
#include "scene/needs.h"
#include "shared/wavefront.h"
#include "wavefront/plan.h"
#include "wavefront/queues.h"

#include <array>
#include <cstdint>
#include <string_view>
#include <variant>
#include <vector>

namespace obscura {

enum class Stage : uint32_t {
    camera = STAGE_CAMERA,
    trace = STAGE_TRACE,
    shade = STAGE_SHADE,
    shadow = STAGE_SHADOW,
    obscurance = STAGE_OBSCURANCE,
    gather = STAGE_GATHER,
    film = STAGE_FILM,
};
constexpr uint32_t STAGE_COUNT = 7;

// When a wave launches a stage; those of the same time run in the table's order.
enum class StageTime { wave_start, each_depth, wave_end };

// What a launch is told beside its buffers.
struct Work : Wave {
    uint32_t count = 0;  // camera samples of the wave, or rays of the depth
    uint32_t depth = 0;
};

// A kernel's parameter: its name, and where its value comes from.
struct Argument {
    std::string_view name;
    std::variant<Buffer SceneBuffers::*, Buffer Queues::*, uint32_t Work::*> source;
};

// A queue that a stage appends to, and how much at most for each of its items.
struct Append {
    Queue queue;
    uint64_t (*most)(const QueueShape&);
};

struct StageInfo {
    Stage stage;
    std::string_view name;
    StageTime time;
    std::array<std::string_view, 2> rows;  // of the profile: at depth 0, deeper
    // The NEED_* flags that its kernel depends on: names of needs.h, separated by blanks.
    std::string_view features;
    bool (*needed)(const Needs&);
    // Work items of a launch.
    uint64_t (*items)(const Work&, const QueueShape&);
    // Rays that the launch traced, where only the device knows: such a launch covers the most there can be. Else null: it
    // had `items`.
    uint64_t (*counted)(const DeviceStatus&, const QueueShape&);
    std::array<Append, 3> appends;        // the rest is empty
    std::array<Argument, 15> parameters;  // of its kernel, in order; the rest is empty

    std::string_view row(uint32_t depth) const { return rows[depth == 0 ? 0 : 1]; }
};

extern const std::array<StageInfo, STAGE_COUNT> STAGES;

inline const StageInfo& stage_info(Stage stage) {
    return STAGES.at(static_cast<uint32_t>(stage));
}

// The stages that a render launches, in order.
std::vector<Stage> needed_stages(const Needs& needs);

// What the parameters of the stage's kernel are set to. It refers to the three that it is made from.
std::vector<LaunchArgument> stage_arguments(const StageInfo& stage, const SceneBuffers& scene,
                                            const Queues& queues, const Work& work);

}  // namespace obscura
