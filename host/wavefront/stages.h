// SPDX-License-Identifier: Apache-2.0
// The table of the wavefront's stages: from it kernels are compiled, launched, profiled, named in messages and tested.
// A stage called `shadow` is kernels/shadow.cl, its kernel, Stage::shadow and tests/kernel/shadow_test.cpp.
#pragma once

#include "device/launch.h"
#include "device/scene_buffers.h"
#include "scene/needs.h"
#include "wavefront/queues.h"

#include <array>
#include <cstdint>
#include <string_view>
#include <variant>
#include <vector>

namespace obscura {

enum class Stage : uint32_t { camera = 0, trace, shade, shadow, obscurance, gather, film };  // = STAGE_*
constexpr uint32_t STAGE_COUNT = 7;

// What a launch is told beside its buffers.
struct Work {
    uint32_t first_pixel = 0;  // of the wave
    uint32_t first_pass = 0;   // of the wave's first pixel
    uint32_t count = 0;        // camera samples of the wave, or rays of the depth
    uint32_t depth = 0;
    uint32_t pixels = 0;  // of the film
};

// A kernel's parameter: its name, and where its value comes from.
struct Argument {
    std::string_view name;
    std::variant<Buffer SceneBuffers::*, Buffer Queues::*, uint32_t Work::*> source;
};

struct StageInfo {
    Stage stage;
    std::string_view name;
    std::array<std::string_view, 2> rows;  // of the profile: at depth 0, deeper
    // The NEED_* flags that its kernel depends on: names of needs.h, separated by blanks.
    std::string_view features;
    bool (*needed)(const Needs&);
    // Work items of a launch. How many shadow rays and obscurance points there are only the device knows: their launches
    // cover the most there can be.
    uint64_t (*items)(const Work&, const QueueShape&);
    std::array<Argument, 15> parameters;  // of its kernel, in order; the rest is empty
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
