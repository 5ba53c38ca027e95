// SPDX-License-Identifier: Apache-2.0
#include "wavefront/scheduler.h"

#include <span>
#include <string>
#include <utility>

#include "base/error.h"
#include "device/launch.h"
#include "shared/wavefront.h"

namespace obscura {
namespace {

// The lengths of the queues from this moment on. status: of the end of the depth that begins.
void trace_queues(const Device& device, int64_t time_ns, const Work& work, const DeviceStatus& status) {
    const CommandLog* const commands = device.commands();
    if (commands == nullptr) return;
    commands->set_queue_length("camera rays", time_ns, work.depth == 0 ? work.count : 0);
    commands->set_queue_length("glossy rays", time_ns, work.depth == 0 ? 0 : work.count);
    commands->set_queue_length("shadow rays", time_ns, status[COUNT_SHADOWS]);
    commands->set_queue_length("obscurance points", time_ns, status[COUNT_POINTS]);
}

}  // namespace

Scheduler::Scheduler(Device& device, const StageKernels& kernels, const SceneBuffers& scene, Queues& queues,
                     uint32_t local_size, Profiler& profiler)
    : device_(device),
      kernels_(kernels),
      scene_(scene),
      queues_(queues),
      local_size_(local_size),
      profiler_(profiler) {}

// The kernels that the scene doesn't need are empty.
bool Scheduler::launches(const StageInfo& stage) const {
    return kernels_[static_cast<uint32_t>(stage.stage)]() != nullptr;
}

cl::Event Scheduler::launch_stage(const StageInfo& info, const Work& work) const {
    const cl::Kernel& kernel = kernels_[static_cast<uint32_t>(info.stage)];
    return launch({device_, kernel, info.row(work.depth), info.items(work, queues_.shape), local_size_},
                  stage_arguments(info, scene_, queues_, work));
}

void Scheduler::run_stages(StageTime time, const Work& work) {
    for (const StageInfo& info : STAGES) {
        if (info.time != time || !launches(info)) continue;
        const cl::Event event = launch_stage(info, work);
        const uint64_t items = info.items(work, queues_.shape);
        profiler_.record(std::string(info.row(work.depth)), items, grid_size(device_, items, local_size_),
                         event);
    }
}

SampleCounts Scheduler::render(const Frame& frame, uint32_t first_pass, uint32_t pass_count,
                               const WaveCallback& after_wave) {
    queues_.frame.upload(std::span(&frame, 1));
    const uint32_t pixels = frame.crop.z;
    const auto next = [&](const Wave& wave) {
        return wave_after(wave, frame.crop.w, pixels, first_pass + pass_count);
    };
    SampleCounts samples{.passes = first_pass};
    uint64_t done = 0;
    for (Wave wave = next({.first_pass = first_pass}); wave.sample_count() > 0; wave = next(wave)) {
        run_wave(frame, wave);
        samples = samples_after(wave, pixels);
        done += wave.sample_count();
        if (!after_wave(done, rays_)) break;
    }
    return samples;
}

void Scheduler::run_wave(const Frame& frame, const Wave& wave) {
    const TraceStep step(device_.trace(), TraceCategory::host, "wave", {"number", wave_count_++});
    const Work samples{wave, wave.sample_count(), 0};
    run_stages(StageTime::wave_start, samples);
    rays_.camera += samples.count;
    Work rays = samples;
    for (; rays.depth <= frame.seed.z && rays.count > 0; ++rays.depth) {
        rays.count = run_depth(frame, rays);
        // Without continuations there is no second queue to swap with.
        if (rays.count > 0) std::swap(queues_.rays, queues_.next_rays);
    }
    run_stages(StageTime::wave_end, samples);
    read_status();
    profiler_.collect();
    if (CommandLog* const commands = device_.commands()) {
        commands->collect();
        trace_queues(device_, commands->trace().now_ns(), {}, {});  // they are empty until the next wave
    }
}

uint32_t Scheduler::run_depth(const Frame& frame, const Work& work) {
    const TraceStep step(device_.trace(), TraceCategory::host, fmt::format("depth {}", work.depth));
    queues_.counters.clear();
    run_stages(StageTime::each_depth, work);
    const DeviceStatus status = read_status();  // the only host wait of a depth
    trace_queues(device_, step.start_ns(), work, status);
    for (const StageInfo& info : STAGES) {
        if (info.counted != nullptr && launches(info))
            profiler_.set_items(std::string(info.row(work.depth)), info.counted(status, queues_.shape));
    }
    rays_.shadow += status[COUNT_SHADOWS];
    rays_.obscurance += uint64_t{status[COUNT_POINTS]} * queues_.shape.obscurance_rays;
    rays_.glossy += status[COUNT_RAYS];
    if (observer_) {
        const auto relaunch = [&](Stage stage) { return launch_stage(stage_info(stage), work); };
        observer_({work.depth, work.count, status[COUNT_SHADOWS], status[COUNT_POINTS], relaunch}, frame,
                  queues_);
    }
    return status[COUNT_RAYS];
}

DeviceStatus Scheduler::read_status() const {
    const TraceStep step(device_.trace(), TraceCategory::host, "wait");
    DeviceStatus status{};
    queues_.counters.download(status);
    if (status[STATUS_CODE] == STATUS_OK) return status;
    const char* what = "an unknown failure";
    if (status[STATUS_CODE] == STATUS_NOT_FINITE) what = "a contribution is not a finite number";
    if (status[STATUS_CODE] == STATUS_STACK_OVERFLOW) what = "the traversal stack is too small";
    if (status[STATUS_CODE] == STATUS_BAD_SLOT) what = "its path slot or result index is out of range";
    throw DeviceError("stage {}, item {}: {} (device {})",
                      stage_info(static_cast<Stage>(status[STATUS_STAGE])).name, status[STATUS_ITEM], what,
                      device_.name());
}

}  // namespace obscura
