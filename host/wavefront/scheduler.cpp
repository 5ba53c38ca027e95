// SPDX-License-Identifier: Apache-2.0
#include "wavefront/scheduler.h"

#include <algorithm>
#include <span>
#include <utility>

#include "base/error.h"
#include "device/launch.h"
#include "shared/wavefront.h"

namespace obscura {

Scheduler::Scheduler(Device& device, const StageKernels& kernels, const SceneBuffers& scene, Queues& queues,
                     uint32_t local_size, Profiler& profiler)
    : device_(device),
      kernels_(kernels),
      scene_(scene),
      queues_(queues),
      local_size_(local_size),
      profiler_(profiler) {}

template <typename... Args>
void Scheduler::run(Stage stage, const char* row, uint64_t item_count, const Args&... args) {
    const cl::Kernel& kernel = kernels_[static_cast<uint32_t>(stage)];
    if (kernel() == nullptr) return;  // not needed by this scene
    profiler_.record(row, item_count,
                     launch(device_, kernel, stage_name(stage), item_count, local_size_, args...));
}

uint64_t Scheduler::render(const Frame& frame, const WaveCallback& after_wave) {
    queues_.frame.upload(std::span(&frame, 1));
    queues_.film.clear();
    const uint32_t pixels = frame.crop.z;
    uint64_t done = 0;
    for (uint64_t index = 0;; ++index) {
        const Wave wave = wave_at(index, frame.crop.w, pixels, frame.sampling.x);
        if (wave.count == 0) break;
        run_wave(frame, wave);
        done += wave.count;
        if (!after_wave(done, rays_)) break;
    }
    return done;
}

void Scheduler::run_wave(const Frame& frame, const Wave& wave) {
    run(Stage::camera, "camera", wave.count, queues_.frame, scene_.tables, queues_.sample_order, queues_.rays,
        queues_.paths, wave.first_pixel, wave.first_pass, wave.count);
    rays_.camera += wave.count;
    uint32_t ray_count = wave.count;
    for (uint32_t depth = 0; depth <= frame.seed.z && ray_count > 0; ++depth) {
        ray_count = run_depth(frame, ray_count, depth);
        // Without continuations there is no second queue to swap with.
        if (ray_count > 0) std::swap(queues_.rays, queues_.next_rays);
    }
    run(Stage::film, "film", std::min(wave.count, frame.crop.z), queues_.frame, queues_.paths, queues_.film,
        queues_.counters, wave.first_pixel, wave.first_pass, wave.count);
    std::array<uint32_t, STATUS_WORDS> status{};
    queues_.counters.download(status);
    check_status(status);
    profiler_.collect();
}

uint32_t Scheduler::run_depth(const Frame& frame, uint32_t ray_count, uint32_t depth) {
    const uint32_t capacity = frame.crop.w;
    const uint64_t light_samples = queues_.visibility.bytes() / (uint64_t{capacity} * sizeof(f32x4));
    const auto shadow_capacity = static_cast<uint32_t>(light_samples * capacity);
    queues_.counters.clear();
    run(Stage::trace, depth == 0 ? "trace_camera" : "trace_glossy", ray_count, scene_.nodes, scene_.blocks,
        queues_.rays, queues_.counters, capacity, ray_count);
    run(Stage::shade, "shade", ray_count, queues_.frame, scene_.triangles, scene_.materials,
        scene_.area_lights, scene_.point_lights, scene_.texels, scene_.tables, queues_.rays, queues_.paths,
        queues_.next_rays, queues_.shadow_rays, queues_.points, queues_.counters, ray_count, depth);
    // How many of these there are, the device knows: the launches cover the most there can be.
    run(Stage::shadow, "shadow", uint64_t{ray_count} * light_samples, scene_.nodes, scene_.blocks,
        scene_.triangles, scene_.materials, scene_.texels, scene_.tables, queues_.shadow_rays,
        queues_.visibility, queues_.counters, shadow_capacity);
    run(Stage::obscurance, "obscurance", ray_count, queues_.frame, scene_.nodes, scene_.blocks,
        scene_.triangles, scene_.materials, scene_.texels, scene_.tables, queues_.points, queues_.paths,
        queues_.results, queues_.counters, depth);
    run(Stage::gather, "gather", ray_count, queues_.frame, queues_.rays, queues_.visibility, queues_.results,
        queues_.paths, ray_count, depth);

    std::array<uint32_t, STATUS_WORDS> status{};
    queues_.counters.download(status);  // the only host wait of a depth
    check_status(status);
    const uint64_t obscurance_rays = uint64_t{status[COUNT_POINTS]} * frame.sampling.y;
    profiler_.set_items("shadow", status[COUNT_SHADOWS]);
    profiler_.set_items("obscurance", obscurance_rays);
    rays_.shadow += status[COUNT_SHADOWS];
    rays_.obscurance += obscurance_rays;
    rays_.glossy += status[COUNT_RAYS];
    if (observer_) observer_({depth, ray_count, status[COUNT_SHADOWS], status[COUNT_POINTS]}, frame, queues_);
    return status[COUNT_RAYS];
}

void Scheduler::check_status(const std::array<uint32_t, STATUS_WORDS>& status) const {
    if (status[STATUS_CODE] == STATUS_OK) return;
    const char* what = status[STATUS_CODE] == STATUS_NOT_FINITE ? "a contribution is not a finite number"
                                                                : "the traversal stack is too small";
    throw DeviceError("stage {}, item {}: {} (device {})", STAGES.at(status[STATUS_STAGE]).name,
                      status[STATUS_ITEM], what, device_.name());
}

}  // namespace obscura
