// SPDX-License-Identifier: Apache-2.0
#include "wavefront/stage_figures.h"

#include "base/error.h"
#include "wavefront/stages.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string_view>

namespace obscura {
namespace {

// Above this share of what the device can do, that is what holds a stage up.
constexpr double BOUND_SHARE = 0.5;
// A copy also fetches the lines that it writes, three for two that count: what moves more than this many times its bytes
// per second finds them in a cache.
constexpr double MOST_FROM_MEMORY = 1.5;

// The queue whose rays a row traces, nullptr if it traces none.
const RayVisits* visits_of(std::string_view row, const RenderVisits& visits) {
    static constexpr std::array<std::string_view, RAY_QUEUES.size()> ROWS{"trace_camera", "shadow",
                                                                          "trace_glossy", "obscurance"};
    const auto found = std::ranges::find(ROWS, row);
    return found == ROWS.end() ? nullptr : &visits.queues[static_cast<size_t>(found - ROWS.begin())];
}

// 16-byte lanes of queues, path slots and film that a stage reads and writes. An estimate: a lane that is read twice counts
// once, and that part of an item which ends early isn't left out.
class LaneCount {
  public:
    explicit LaneCount(const DeviceWork& result) : result_(result) {}

    uint64_t of(Stage stage, uint64_t items) const {
        const QueueShape& shape = result_.shape;
        const RayCounts& rays = result_.rays;
        const uint64_t planes = shape.layer_planes;
        const uint64_t light_lanes = uint64_t{shape.light_samples} * shape.light_lobes;
        switch (stage) {
            case Stage::camera:
                // The ray without its hit, throughput, sample.
                return items * (RAY_LANES - 1 + 2);
            case Stage::trace:
                return items * RAY_LANES;
            case Stage::shade:
                // Ray, throughput, sample; ambient, light contributions, layers; what is appended, and the
                // throughput of paths that go on.
                return items * (RAY_LANES + 2) + items * (1 + light_lanes) +
                       started(rays.camera, {LAYER_EMISSION, LAYER_POSITION, LAYER_NORMAL, LAYER_SHADING,
                                             LAYER_UV, LAYER_ALBEDO}) +
                       added_to(rays.glossy, {LAYER_SPECULAR_EMISSION}) + rays.shadow * SHADOW_LANES +
                       points() * POINT_LANES + rays.glossy * (RAY_LANES + 1);
            case Stage::shadow:
                return items * (SHADOW_LANES + 1);
            case Stage::obscurance:
                // Points and their samples; a result for each ray.
                return points() * (POINT_LANES + 1) + items;
            case Stage::gather:
                // Slot, ambient, light contributions; visibility, results; layers, and for obscurance the flag in
                // the lane of the sample.
                return items * (2 + light_lanes) + rays.shadow + rays.obscurance +
                       started(rays.camera,
                               {LAYER_DIRECT, LAYER_AMBIENT, LAYER_SPECULAR_EMISSION, LAYER_SPECULAR_DIRECT,
                                LAYER_SPECULAR_AMBIENT, LAYER_OBSCURANCE}) +
                       added_to(points(), {LAYER_OBSCURANCE}) +
                       added_to(rays.glossy, {LAYER_SPECULAR_DIRECT, LAYER_SPECULAR_AMBIENT}) +
                       added_to(shape.light_lobes > 1 ? rays.glossy : 0, {LAYER_SPECULAR_EMISSION});
            case Stage::film:
                // Layers of the samples; sums of the pixels, read and written. The first pass only writes them, which
                // isn't told apart.
                return rays.camera * planes + 2 * items * planes * (sizeof(FilmSum) / sizeof(f32x4));
        }
        return 0;
    }

  private:
    uint64_t points() const {
        const uint32_t k_count = result_.shape.obscurance_rays;
        return k_count > 0 ? result_.rays.obscurance / k_count : 0;
    }
    // Those of the layers that are kept, written for each item.
    uint64_t started(uint64_t items, std::initializer_list<uint32_t> layers) const {
        const auto is_kept = [&](uint32_t layer) { return result_.planes[layer] != NO_PLANE; };
        return items * static_cast<uint64_t>(std::ranges::count_if(layers, is_kept));
    }
    // The same, read and written.
    uint64_t added_to(uint64_t items, std::initializer_list<uint32_t> layers) const {
        return 2 * started(items, layers);
    }

    const DeviceWork& result_;
};

// A work item of the stage obscurance has K rays.
uint64_t busy_work_items(Stage stage, uint64_t items, const QueueShape& shape) {
    return stage == Stage::obscurance ? items / shape.obscurance_rays : items;
}

double over(double a, double b) {
    return b > 0 ? a / b : 0;
}

// All but what bounds it.
StageFigures measured_figures(const StageInfo& info, const std::string& name, const DeviceWork& result,
                              const DeviceRates& rates) {
    StageFigures figures;
    figures.row = name;
    figures.profile = result.profile.at(name);
    const StageProfile& profile = figures.profile;
    double all_ms = 0;
    for (const auto& [other, row] : result.profile)
        all_ms += row.ms;
    const auto items = static_cast<double>(profile.items);
    figures.share = over(profile.ms, all_ms);
    figures.ns_per_item = over(profile.ms * 1e6, items);
    figures.bytes = LaneCount(result).of(info.stage, profile.items) * sizeof(f32x4);
    figures.gb_per_s = over(static_cast<double>(figures.bytes) * 1e-6, profile.ms);
    if (const RayVisits* const visits = visits_of(name, *result.visits)) {
        figures.mrays_per_s = over(items * 1e-3, profile.ms);
        figures.visits_per_ray = mean(visits->nodes) + mean(visits->blocks);
    }

    const auto work_items = static_cast<double>(profile.work_items);
    const auto busy = static_cast<double>(busy_work_items(info.stage, profile.items, result.shape));
    figures.fill = over(busy, work_items);
    const double idle_ms = static_cast<double>(profile.launches) * rates.launch_ms +
                           (work_items - busy) * rates.idle_item_ns * 1e-6;
    figures.idle_share = over(std::min(idle_ms, profile.ms), profile.ms);
    return figures;
}

}  // namespace

std::string bound_text(const StageFigures& figures, uint64_t bvh_bytes, const DeviceRates& rates) {
    const double copy_share = over(figures.gb_per_s, rates.copy_gb_per_s);
    if (figures.idle_share >= BOUND_SHARE)
        return fmt::format("launching: {:.0f} % are launches and idle work items", 100 * figures.idle_share);
    if (copy_share > MOST_FROM_MEMORY)
        return fmt::format("cache bandwidth: {:.1f} times a copy's", copy_share);
    if (copy_share >= BOUND_SHARE)
        return fmt::format("memory bandwidth: {:.0f} % of a copy's", 100 * copy_share);
    const double core_ns = figures.ns_per_item * rates.cores;
    if (figures.visits_per_ray == 0)
        return fmt::format("computing: {:.0f} ns of a core per item, {:.0f} % of a copy's bandwidth", core_ns,
                           100 * copy_share);
    const double visit_ns = core_ns / figures.visits_per_ray;
    const double visit_share = figures.visits_per_ray * rates.visit_ns / core_ns;
    if (visit_share >= BOUND_SHARE)
        return fmt::format("traversal: {:.1f} visits a ray at {:.1f} ns of a core", figures.visits_per_ray,
                           visit_ns);
    if (bvh_bytes > rates.cache_bytes && rates.cache_bytes > 0)
        return fmt::format(
            "memory latency: {:.1f} ns of a core for a visit, {:.0f} times those of a small tree", visit_ns,
            1 / visit_share);
    return fmt::format("computing: {:.1f} visits a ray would take {:.0f} % of its {:.0f} ns of a core",
                       figures.visits_per_ray, 100 * visit_share, core_ns);
}

std::vector<StageFigures> stage_figures(const DeviceWork& result, const DeviceRates& rates) {
    OBSCURA_CHECK(result.visits, "visits were not counted");
    std::vector<StageFigures> rows;
    for (const StageInfo& info : STAGES) {
        for (const uint32_t depth : {0u, 1u}) {
            const auto found = result.profile.find(std::string(info.row(depth)));
            const bool is_listed = depth > 0 && info.row(depth) == info.row(0);
            if (found == result.profile.end() || is_listed) continue;
            rows.push_back(measured_figures(info, found->first, result, rates));
            rows.back().bound = bound_text(rows.back(), result.bytes.at("bvh"), rates);
        }
    }
    return rows;
}

}  // namespace obscura
