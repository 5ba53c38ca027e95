// SPDX-License-Identifier: Apache-2.0
#include "reference/ray_replay.h"

#include "base/error.h"
#include "bvh/bvh.h"
#include "device/launch.h"
#include "wavefront/features.h"
#include "wavefront/frame.h"

#include <bit>
#include <span>
#include <string>
#include <vector>

namespace obscura {
namespace {

f32x4 lane(const V3f& v, float w) {
    return {v.x, v.y, v.z, w};
}

// The stages that rays go through, with queues for one path.
class RayStages {
  public:
    RayStages(Device& device, ProgramLibrary& library, const RenderJob& job, const Bvh& bvh)
        : device_(device),
          library_(library),
          settings_(with_default_sky(job.scene, job.settings)),
          portable_(job.portable),
          needs_(analyse_needs(job.scene, settings_)) {
        const SceneArrays arrays = make_scene_arrays(job.scene, settings_.filter);
        scene_ = upload_scene(device, arrays, bvh);
        const LayerPlanes planes = assign_planes(needs_, {});
        frame_ = make_frame({job.scene, settings_, compute_radiometry(job.scene), needs_, planes,
                             static_cast<uint32_t>(arrays.area_lights.size()),
                             static_cast<uint32_t>(arrays.point_lights.size()),
                             resolve_max_distance(settings_.d_max, job.scene)},
                            {0, 0, 1, 1}, 1);
        queues_ = allocate_queues(device, queue_shape(needs_, settings_, plane_count(planes)), 1, 1, {0});
        queues_.frame.upload(std::span(&frame_, 1));
        queues_.counters.clear();
    }

    const Frame& frame() const { return frame_; }

    // The stage shadow, with this ray alone in its queue.
    CapturedRays shadow(const TraceRay& ray) {
        const uint64_t capacity = queues_.shape.light_samples;
        const float result_index = std::bit_cast<float>(0u);
        queues_.shadow_rays.upload(std::vector{lane(ray.origin, result_index)}, SHADOW_ORIGIN * capacity);
        queues_.shadow_rays.upload(std::vector{lane(ray.direction, ray.t_max)}, SHADOW_DIRECTION * capacity);
        DeviceStatus counters{};
        counters[COUNT_SHADOWS] = 1;
        queues_.counters.upload(counters);
        const StageInfo& stage = stage_info(Stage::shadow);
        const cl::Kernel kernel = library_.kernel(std::string(stage.name), options(Stage::shadow));
        launch({device_, kernel, stage.name, 1, library_.local_size()},
               stage_arguments(stage, scene_, queues_, {}));
        return {{ray}, {}, {}, {queues_.visibility.contents<f32x4>().front()}};
    }

    // The stage obscurance draws its own rays: a kernel beside it takes this one through its functions.
    CapturedRays obscurance(const TraceRay& ray, const V3f& start) {
        const std::vector<f32x4> rays{lane(ray.origin, ray.t_max), lane(ray.direction, 0)};
        const Buffer ray_buffer = Buffer::holding(device_, "rays", "check", rays);
        const Buffer start_buffer = Buffer::holding(device_, "starts", "check", std::vector{lane(start, 0)});
        const Buffer out(device_, "results", "check", 2 * sizeof(f32x4));
        const cl::Kernel kernel = library_.kernel(
            {"obscurance_results", options(Stage::obscurance), "check.cl", "obscurance_results"});
        launch(device_, kernel, "obscurance_results", 1, library_.local_size(), queues_.frame, scene_.nodes,
               scene_.blocks, scene_.triangles, scene_.materials, scene_.texels, scene_.tables, ray_buffer,
               start_buffer, out, 1u);
        const std::vector<f32x4> found = out.contents<f32x4>();
        return {{ray}, {hit_of(found[0])}, {start}, {found[1]}};
    }

  private:
    std::string options(Stage stage) const {
        return stage_options(stage, needs_, settings_.needs == NeedsMode::all, portable_);
    }

    Device& device_;
    ProgramLibrary& library_;
    RenderSettings settings_;
    bool portable_;
    Needs needs_;
    SceneBuffers scene_;
    Frame frame_{};
    Queues queues_;
};

}  // namespace

RayCheck replay_ray(Device& device, ProgramLibrary& library, const RenderJob& job, const GivenRay& given) {
    const TraceRay& ray = given.ray;
    const HitComparison hits(job.scene);
    const Bvh bvh = build_bvh(job.scene);
    const DeviceTracer tracer(device, library, bvh, stage_options(Stage::trace, {}, false, job.portable));
    RayCheck check;
    check.device = tracer.closest({&ray, 1}).front();
    hits.embree().closest({&ray, 1}, {&check.embree, 1});
    check.truth = hits.oracle().closest(ray);
    const HitTally tally = hits.compare({&ray, 1}, {&check.device, 1}, {&check.embree, 1}, 1);
    if (!tally.disagreements.empty()) check.outcome = tally.disagreements.front().outcome;

    const Needs needs = analyse_needs(job.scene, with_default_sky(job.scene, job.settings));
    if (given.start && !needs.obscurance)
        throw InputError("--ray: ten numbers are an obscurance ray, and this render has none");
    if (!given.start && !needs.direct()) return check;
    const ResultComparison results(job.scene, job.settings, hits);
    RayStages stages(device, library, job, bvh);
    check.result =
        given.start ? results.judge_obscurance(stages.obscurance(ray, *given.start), 0, stages.frame(), true)
                    : results.judge_shadow(stages.shadow(ray), 0, true);
    return check;
}

}  // namespace obscura
