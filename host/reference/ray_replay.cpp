// SPDX-License-Identifier: Apache-2.0
#include "reference/ray_replay.h"

#include "base/error.h"
#include "bvh/bvh.h"
#include "device/launch.h"
#include "wavefront/features.h"
#include "wavefront/frame.h"

#include <array>
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

// A stream takes a ray that is alone at a node or in a leaf another way than one of a few, and that another way than one of many
// (kernels/lib/stream_node.clh, stream_leaf.clh): so many of the ray go down the tree together.
constexpr std::array<uint32_t, 3> COPIES{1, 4, 16};
constexpr uint32_t MOST_COPIES = COPIES.back();

// The stages that rays go through, with queues for the copies of one.
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
                            {0, 0, 1, 1}, MOST_COPIES);
        queues_ =
            allocate_queues(device, queue_shape(needs_, settings_, plane_count(planes)), MOST_COPIES, 1, {0});
        queues_.frame.upload(std::span(&frame_, 1));
    }

    const Frame& frame() const { return frame_; }

    // The stage shadow, with nothing but this ray in its queue.
    CapturedRays shadow(const TraceRay& ray, uint32_t copies) {
        const uint64_t capacity = uint64_t{queues_.shape.light_samples} * MOST_COPIES;
        std::vector<f32x4> origins;
        origins.reserve(copies);
        for (uint32_t result = 0; result < copies; ++result)
            origins.push_back(lane(ray.origin, std::bit_cast<float>(result)));
        queues_.shadow_rays.upload(origins, SHADOW_ORIGIN * capacity);
        queues_.shadow_rays.upload(std::vector(copies, lane(ray.direction, ray.t_max)),
                                   SHADOW_DIRECTION * capacity);
        DeviceStatus counters{};
        counters[COUNT_SHADOWS] = copies;
        queues_.counters.upload(counters);
        const StageInfo& stage = stage_info(Stage::shadow);
        const cl::Kernel kernel = library_.kernel(std::string(stage.name), options(Stage::shadow));
        launch({device_, kernel, stage.name, copies, library_.local_size()},
               stage_arguments(stage, scene_, queues_, {}));
        return {{ray}, {}, {}, {queues_.visibility.contents<f32x4>().front()}};
    }

    // The stage obscurance draws its own rays: a kernel beside it takes this one through its functions.
    CapturedRays obscurance(const TraceRay& ray, const V3f& start, uint32_t copies) {
        const Buffer ray_buffer = Buffer::holding(device_, "rays", "check", pack(std::vector(copies, ray)));
        const Buffer start_buffer =
            Buffer::holding(device_, "starts", "check", std::vector(copies, lane(start, 0)));
        const Buffer out(device_, "results", "check", uint64_t{3} * copies * sizeof(f32x4));
        const cl::Kernel kernel = library_.kernel(
            {"obscurance_results", options(Stage::obscurance), "check.cl", "obscurance_results"});
        launch(device_, kernel, "obscurance_results", copies, library_.local_size(), queues_.frame,
               scene_.nodes, scene_.blocks, scene_.triangles, scene_.materials, scene_.texels, scene_.tables,
               ray_buffer, start_buffer, out, copies);
        const std::vector<f32x4> found = out.contents<f32x4>();
        return {{{ray.origin, ray.direction, found[copies].x}},
                {hit_of(found[0])},
                {start},
                {found[size_t{2} * copies]}};
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
                             uint32_t copies, const TraceHit& nearest) {
    const bool blocked = tracer.occluded(std::vector(copies, ray)).front() != 0;
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

// One ray again and again.
class Replay {
  public:
    Replay(Device& device, ProgramLibrary& library, const RenderJob& job, const GivenRay& given)
        : given_(given),
          scene_(job.scene),
          hits_(job.scene),
          bvh_(build_bvh(job.scene)),
          tracer_(device, library, bvh_, stage_options(Stage::trace, {}, false, job.portable)),
          truth_(hits_.oracle().closest(given.ray)) {
        hits_.embree().closest({&given.ray, 1}, {&embree_, 1});
        const bool is_as_shadow_rays = given.ray.t_max == 1 || std::isinf(given.ray.t_max);
        if (job.scene.cameras.empty() || !(given.start || is_as_shadow_rays)) return;
        settings_ = with_default_sky(job.scene, job.settings);
        needs_ = analyse_needs(job.scene, settings_);
        if (given.start ? !needs_.obscurance : !needs_.direct()) return;
        results_.emplace(job.scene, settings_, hits_);
        stages_.emplace(device, library, job, settings_, needs_, bvh_);
    }

    RayCheck check(uint32_t copies) {
        const TraceRay& ray = given_.ray;
        RayCheck check;
        check.device = tracer_.closest(std::vector(copies, ray)).front();
        check.embree = embree_;
        check.truth = truth_;
        const HitTally tally = hits_.compare({&ray, 1}, {&check.device, 1}, {&check.embree, 1}, 1);
        if (!tally.disagreements.empty()) check.outcome = tally.disagreements.front().outcome;
        check.contradiction = contradiction_of(scene_, tracer_, ray, copies, check.device);
        check.result = judge_result(copies);
        return check;
    }

  private:
    // What the ray brings back, through the stage that has such rays; nothing where the render has none.
    std::optional<JudgedResult> judge_result(uint32_t copies) {
        const TraceRay& ray = given_.ray;
        if (!stages_) return {};
        if (!given_.start) return results_->judge_shadow(stages_->shadow(ray, copies), 0, true);
        const CapturedRays captured = stages_->obscurance(ray, *given_.start, copies);
        check_reach(scene_, ray, captured.rays.front().t_max);
        return results_->judge_obscurance(captured, 0, stages_->frame(), true);
    }

    const GivenRay& given_;
    const Scene& scene_;
    HitComparison hits_;
    Bvh bvh_;
    DeviceTracer tracer_;
    BruteHit truth_;
    TraceHit embree_{};
    RenderSettings settings_;
    Needs needs_;
    // Only where the render has such rays.
    std::optional<ResultComparison> results_;
    std::optional<RayStages> stages_;
};

}  // namespace

RayCheck replay_ray(Device& device, ProgramLibrary& library, const RenderJob& job, const GivenRay& given) {
    Replay replay(device, library, job, given);
    RayCheck alone = replay.check(COPIES.front());
    if (given.start && !alone.result)
        throw InputError("--ray: ten numbers are an obscurance ray, and this render has none");
    if (alone.is_device_wrong()) return alone;
    for (const uint32_t copies : std::span(COPIES).subspan(1)) {
        RayCheck check = replay.check(copies);
        if (check.is_device_wrong()) return check;
    }
    return alone;
}

}  // namespace obscura
