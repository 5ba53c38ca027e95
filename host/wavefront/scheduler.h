// SPDX-License-Identifier: Apache-2.0
// The loop: waves of camera samples through the stages until every pixel has all its samples.
#pragma once

#include "device/program.h"
#include "device/scene_buffers.h"
#include "shared/frame.h"
#include "shared/wavefront.h"
#include "wavefront/plan.h"
#include "wavefront/profiler.h"
#include "wavefront/queues.h"
#include "wavefront/stages.h"

#include <array>
#include <cstdint>
#include <functional>
#include <utility>

namespace obscura {

struct RayCounts {
    uint64_t camera = 0, shadow = 0, glossy = 0, obscurance = 0;
    uint64_t total() const { return camera + shadow + glossy + obscurance; }
    RayCounts& operator+=(const RayCounts& other) {
        camera += other.camera;
        shadow += other.shadow;
        glossy += other.glossy;
        obscurance += other.obscurance;
        return *this;
    }
};

// Called after each wave with the samples that render() has finished and all rays traced so far; false stops it there.
using WaveCallback = std::function<bool(uint64_t samples_done, const RayCounts& rays)>;

// One depth of a wave, seen after its kernels ran: queues.rays still holds its rays with their hits.
struct DepthView {
    uint32_t depth;
    uint32_t ray_count, shadow_count, point_count;
    // Launches trace, shadow or obscurance of this depth once more: they only write again what they have written.
    std::function<cl::Event(Stage)> relaunch;
};
// Looks at the queues between two depths, for checks that replay the real work of a render.
using DepthObserver = std::function<void(const DepthView&, const Frame&, const Queues&)>;

// One kernel per stage; those that the scene doesn't need are empty.
using StageKernels = std::array<cl::Kernel, STAGE_COUNT>;

class Scheduler {
  public:
    Scheduler(Device& device, const StageKernels& kernels, const SceneBuffers& scene, Queues& queues,
              uint32_t local_size, Profiler& profiler);

    // Adds these passes over the frame's pixels to the sums in queues.film, which are those of the passes before, and says what
    // samples the pixels have then: all, or fewer if after_wave stopped it. Throws DeviceError when a kernel reports a failure.
    SampleCounts render(const Frame& frame, uint32_t first_pass, uint32_t pass_count,
                        const WaveCallback& after_wave);

    const RayCounts& rays() const { return rays_; }
    void observe(DepthObserver observer) { observer_ = std::move(observer); }

  private:
    void run_wave(const Frame& frame, const Wave& wave);
    // One depth of a wave's paths; the number of rays that go on.
    uint32_t run_depth(const Frame& frame, const Work& work);
    DeviceStatus read_status() const;  // waits for the device; throws DeviceError when a kernel has failed
    bool launches(const StageInfo& stage) const;
    cl::Event launch_stage(const StageInfo& info, const Work& work) const;
    void run_stages(StageTime time, const Work& work);

    Device& device_;
    const StageKernels& kernels_;
    const SceneBuffers& scene_;
    Queues& queues_;
    uint32_t local_size_;
    Profiler& profiler_;
    DepthObserver observer_;
    RayCounts rays_;
    uint64_t wave_count_ = 0;
};

}  // namespace obscura
