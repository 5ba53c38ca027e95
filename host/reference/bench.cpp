// SPDX-License-Identifier: Apache-2.0
#include "reference/bench.h"

#include "base/log.h"
#include "base/stopwatch.h"
#include "bvh/bvh.h"
#include "wavefront/features.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>
#include <utility>

namespace obscura {
namespace {

enum QueueIndex : uint32_t { CAMERA, SHADOW, GLOSSY, OBSCURANCE };

// Triangles whose hits are less apart meet there, or nearly.
constexpr float DISTANCE_TOLERANCE = 1e-4f;  // relative

constexpr int SURVEY_RUNS = 2;  // of each mode of Embree

// A stage's launch of one depth of a wave.
struct ReplayLaunch {
    QueueIndex queue;
    Stage stage;
    const DepthView& view;
    const CapturedRays& captured;
};

// The device's answers as Embree gives them.
std::vector<TraceHit> device_hits(const ReplayLaunch& launch) {
    if (launch.queue != SHADOW) return launch.captured.hits;
    std::vector<TraceHit> hits;
    for (size_t i = 0; i < launch.captured.rays.size(); ++i) {
        const f32x4& passed = launch.captured.results[i];
        // Panes dim the light.
        const bool free = passed.x > 0 || passed.y > 0 || passed.z > 0;
        hits.push_back({launch.captured.rays[i].t_max, 0, 0, free ? NO_PRIMITIVE : 0});
    }
    return hits;
}

bool differs(const TraceHit& device, const TraceHit& embree, RayQuery query) {
    const bool hit = device.primitive != NO_PRIMITIVE;
    if (hit != (embree.primitive != NO_PRIMITIVE)) return true;
    return hit && query == RayQuery::closest && device.primitive != embree.primitive &&
           std::abs(device.t - embree.t) > DISTANCE_TOLERANCE * embree.t;
}

uint64_t count_differing(const std::vector<TraceHit>& device, const std::vector<TraceHit>& embree,
                         RayQuery query) {
    uint64_t count = 0;
    for (size_t i = 0; i < device.size(); ++i)
        if (differs(device[i], embree[i], query)) ++count;
    return count;
}

// As any_occluder_will_do() of the kernels.
RayQuery obscurance_query(const RenderSettings& settings) {
    return settings.falloff.kind == FalloffKind::step ? RayQuery::any : RayQuery::closest;
}

// As many threads as the device has, if it runs on the same processor.
int embree_threads(const DeviceInfo& device) {
    const uint32_t threads = device.is_cpu ? device.compute_units : std::thread::hardware_concurrency();
    return static_cast<int>(std::max(threads, 1u));
}

class Bench {
  public:
    Bench(Device& device, ProgramLibrary& library, const RenderJob& job, const BenchCallback& go_on)
        : device_(device),
          library_(library),
          job_(job),
          go_on_(go_on),
          bvh_(build_bvh(job.scene, job.bvh_quality)),
          options_(stage_options(Stage::trace, {}, false, job.portable)),
          capture_(device, library, bvh_, options_),
          visits_(device, library, bvh_, options_),
          embree_(job.scene, embree_threads(device.info())) {
        static constexpr std::array NAMES{"camera", "shadow", "glossy", "obscurance"};
        for (size_t i = 0; i < NAMES.size(); ++i) {
            result_.queues[i].name = NAMES[i];
            for (const EmbreeMode& mode : embree_modes())
                result_.queues[i].modes.push_back({mode});
        }
        result_.queues[SHADOW].query = RayQuery::opaque;
        result_.queues[OBSCURANCE].query = obscurance_query(job.settings);
        result_.has_panes = embree_.has_panes();
        result_.threads = embree_threads(device.info());
        result_.bvh_bytes = bvh_.bytes();
        result_.build_seconds = bvh_.build_seconds;
        result_.robust = embree_.cost(true);
        result_.fast = embree_.cost(false);
    }

    SceneBench run(RayDump* dump) {
        result_.waves = replay(0, [&](const ReplayLaunch& launch) { survey(launch, dump); });
        const MutedWarnings given_before;
        if (!stopped_) replay(0.5, [&](const ReplayLaunch& launch) { time_pairs(launch); });
        result_.complete = !stopped_;
        return std::move(result_);
    }

  private:
    using Replay = std::function<void(const ReplayLaunch&)>;

    uint32_t replay(double fraction_before, const Replay& replay_launch);
    void survey(const ReplayLaunch& launch, RayDump* dump);
    void time_pairs(const ReplayLaunch& launch);
    double time_device(const ReplayLaunch& launch) const;

    Device& device_;
    ProgramLibrary& library_;
    const RenderJob& job_;
    const BenchCallback& go_on_;
    Bvh bvh_;
    std::string options_;
    RayCapture capture_;
    VisitCounter visits_;
    EmbreeRunner embree_;
    SceneBench result_;
    uint64_t rays_ = 0;  // traced by both sides
    bool stopped_ = false;
};

// Half of the benchmark: renders the job and hands on the launches of BENCH_WAVES of its waves. The number of these.
uint32_t Bench::replay(double fraction_before, const Replay& replay_launch) {
    double rendered = 0;
    uint32_t waves = 0;
    bool is_picked = false;
    const auto hand_on = [&](QueueIndex queue, Stage stage, const DepthView& view,
                             const CapturedRays& captured) {
        stopped_ = stopped_ || !go_on_(fraction_before + rendered / 2, rays_);
        if (stopped_ || captured.rays.empty()) return;
        replay_launch({queue, stage, view, captured});
    };
    RenderJob job = job_;
    job.observer = [&](const DepthView& view, const Frame& frame, const Queues& queues) {
        if (view.depth == 0) {
            is_picked = rendered * BENCH_WAVES >= waves;
            waves += is_picked ? 1 : 0;
        }
        if (!is_picked || stopped_) return;
        hand_on(view.depth == 0 ? CAMERA : GLOSSY, Stage::trace, view, capture_.traced(view, frame, queues));
        hand_on(SHADOW, Stage::shadow, view, capture_.shadow(view, frame, queues));
        hand_on(OBSCURANCE, Stage::obscurance, view, capture_.obscurance(view, frame, queues));
    };
    render_scene(device_, library_, job, [&](double fraction, const RayCounts&) {
        rendered = fraction;
        return !stopped_ && waves < BENCH_WAVES;
    });
    return waves;
}

// Every mode of Embree on one launch: how fast, and whether right.
void Bench::survey(const ReplayLaunch& launch, RayDump* dump) {
    const std::vector<TraceRay>& rays = launch.captured.rays;
    const std::vector<TraceHit> hits = device_hits(launch);
    QueueBench& queue = result_.queues[launch.queue];
    queue.visits.add(visits_.count(rays, queue.query != RayQuery::closest));
    if (dump != nullptr) dump->add(launch.queue, queue.query, rays, hits);
    EmbreeRays arranged(rays);
    for (ModeResult& result : queue.modes) {
        double best = std::numeric_limits<double>::infinity();
        for (int i = 0; i < SURVEY_RUNS; ++i)
            best = std::min(best, embree_.trace(result.mode, queue.query, arranged));
        result.seconds += best;
        const std::vector<TraceHit> embree = arranged.arranged(result.mode).hits_in_order();
        result.differing += count_differing(hits, embree, queue.query);
    }
    rays_ += SURVEY_RUNS * queue.modes.size() * rays.size();
}

// Device and Embree in turns, after a run of each that isn't timed.
void Bench::time_pairs(const ReplayLaunch& launch) {
    const std::vector<TraceRay>& rays = launch.captured.rays;
    QueueBench& queue = result_.queues[launch.queue];
    EmbreeRays arranged(rays);
    const EmbreeMode robust = queue.best(true).mode;
    const EmbreeMode fast = queue.best(false).mode;
    const auto time_embree = [&](const EmbreeMode& mode) {
        return embree_.trace(mode, queue.query, arranged);
    };
    time_device(launch);
    time_embree(robust);
    time_embree(fast);
    for (size_t i = 0; i < BENCH_PAIRS; ++i) {
        queue.robust.device[i] += time_device(launch);
        queue.robust.embree[i] += time_embree(robust);
        queue.fast.device[i] += time_device(launch);
        queue.fast.embree[i] += time_embree(fast);
    }
    queue.robust.rays += rays.size();
    queue.fast.rays += rays.size();
    rays_ += 4 * BENCH_PAIRS * rays.size();
}

double Bench::time_device(const ReplayLaunch& launch) const {
    const Stopwatch watch;
    launch.view.relaunch(launch.stage);
    device_.finish(stage_info(launch.stage).name);
    return watch.seconds();
}

}  // namespace

const ModeResult& QueueBench::best(bool is_robust) const {
    const ModeResult* best = nullptr;
    for (const ModeResult& result : modes) {
        if (result.mode.robust != is_robust) continue;
        if (best == nullptr || result.seconds < best->seconds) best = &result;
    }
    return *best;
}

bool SceneBench::is_timed() const {
    return std::ranges::any_of(queues, [](const QueueBench& queue) { return queue.robust.rays > 0; });
}

uint64_t QueueBench::differing() const {
    uint64_t most = 0;
    for (const ModeResult& result : modes)
        if (result.mode.robust) most = std::max(most, result.differing);
    return most;
}

bool QueueBench::agrees() const {
    const double share = MAX_DIFFERING_SHARE * static_cast<double>(visits.rays);
    return differing() <= MAX_DIFFERING_RAYS || static_cast<double>(differing()) <= share;
}

SceneBench bench_scene(Device& device, ProgramLibrary& library, const RenderJob& job, RayDump* dump,
                       const BenchCallback& go_on) {
    return Bench(device, library, job, go_on).run(dump);
}

}  // namespace obscura
