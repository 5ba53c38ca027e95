// SPDX-License-Identifier: Apache-2.0
#include "reference/ray_replay.h"

#include "base/error.h"
#include "bvh/bvh.h"
#include "device/launch.h"
#include "wavefront/features.h"
#include "wavefront/frame.h"

#include <bit>
#include <cmath>
#include <optional>
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
    // settings: with their sky; needs: theirs.
    RayStages(Device& device, ProgramLibrary& library, const RenderJob& job, const RenderSettings& settings,
              const Needs& needs, const Bvh& bvh)
        : device_(device), library_(library), settings_(settings), portable_(job.portable), needs_(needs) {
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
        const Buffer ray_buffer = Buffer::holding(device_, "rays", "check", pack({&ray, 1}));
        const Buffer start_buffer = Buffer::holding(device_, "starts", "check", std::vector{lane(start, 0)});
        const Buffer out(device_, "results", "check", 3 * sizeof(f32x4));
        const cl::Kernel kernel = library_.kernel(
            {"obscurance_results", options(Stage::obscurance), "check.cl", "obscurance_results"});
        launch(device_, kernel, "obscurance_results", 1, library_.local_size(), queues_.frame, scene_.nodes,
               scene_.blocks, scene_.triangles, scene_.materials, scene_.texels, scene_.tables, ray_buffer,
               start_buffer, out, 1u);
        const std::vector<f32x4> found = out.contents<f32x4>();
        return {{{ray.origin, ray.direction, found[1].x}}, {hit_of(found[0])}, {start}, {found[2]}};
    }

  private:
    std::string options(Stage stage) const {
        return stage_options(stage, needs_, settings_.needs == NeedsMode::all, portable_);
    }

    Device& device_;
    ProgramLibrary& library_;
    const RenderSettings& settings_;
    bool portable_;
    const Needs& needs_;
    SceneBuffers scene_;
    Frame frame_{};
    Queues queues_;
};

// What is found with the same ray by queries that have to agree with the nearest hit.
std::string contradiction_of(const Scene& scene, const DeviceTracer& tracer, const TraceRay& ray,
                             const TraceHit& nearest) {
    const bool blocked = tracer.occluded({&ray, 1}).front() != 0;
    if (blocked != (nearest.primitive != NO_PRIMITIVE))
        return blocked ? "any-hit is blocked" : "any-hit is free";
    const TraceHit alone = tracer.closest_alone({&ray, 1}).front();
    if (same_bits(alone, nearest)) return {};
    return "alone it is " + hit_text(scene, alone);
}

// The device's own reach of the ray must be the given one: behind panes it counts.
void check_reach(const Scene& scene, const TraceRay& given, float reach) {
    if (std::abs(given.t_max - reach) <= 1e-5f * reach) return;
    throw InputError(
        "--ray: with these settings this obscurance ray reaches {:.9g}, where it is --dmax from its point",
        scene.unit * static_cast<double>(reach));
}

// What the ray brings back, through the stage that has such rays; nothing where the render has none.
std::optional<JudgedResult> judge_result(Device& device, ProgramLibrary& library, const RenderJob& job,
                                         const GivenRay& given, const HitComparison& hits, const Bvh& bvh) {
    const TraceRay& ray = given.ray;
    const bool is_as_shadow_rays = ray.t_max == 1 || std::isinf(ray.t_max);
    if (job.scene.cameras.empty() || !(given.start || is_as_shadow_rays)) return {};
    const RenderSettings settings = with_default_sky(job.scene, job.settings);
    const Needs needs = analyse_needs(job.scene, settings);
    if (given.start ? !needs.obscurance : !needs.direct()) return {};
    const ResultComparison results(job.scene, settings, hits);
    RayStages stages(device, library, job, settings, needs, bvh);
    if (!given.start) return results.judge_shadow(stages.shadow(ray), 0, true);
    const CapturedRays captured = stages.obscurance(ray, *given.start);
    check_reach(job.scene, ray, captured.rays.front().t_max);
    return results.judge_obscurance(captured, 0, stages.frame(), true);
}

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
    check.contradiction = contradiction_of(job.scene, tracer, ray, check.device);

    check.result = judge_result(device, library, job, given, hits, bvh);
    if (given.start && !check.result)
        throw InputError("--ray: ten numbers are an obscurance ray, and this render has none");
    return check;
}

}  // namespace obscura
