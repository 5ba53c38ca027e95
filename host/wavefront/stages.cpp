// SPDX-License-Identifier: Apache-2.0
#include "wavefront/stages.h"

#include <algorithm>

namespace obscura {
namespace {

constexpr Argument nodes{"nodes", &SceneBuffers::nodes};
constexpr Argument blocks{"blocks", &SceneBuffers::blocks};
constexpr Argument triangles{"triangles", &SceneBuffers::triangles};
constexpr Argument materials{"materials", &SceneBuffers::materials};
constexpr Argument area_lights{"area_lights", &SceneBuffers::area_lights};
constexpr Argument point_lights{"point_lights", &SceneBuffers::point_lights};
constexpr Argument texels{"texels", &SceneBuffers::texels};
constexpr Argument tables{"tables", &SceneBuffers::tables};
constexpr Argument frame{"frame", &Queues::frame};
constexpr Argument sample_order{"sample_order", &Queues::sample_order};
constexpr Argument pixel_order{"pixel_order", &Queues::pixel_order};
constexpr Argument rays{"rays", &Queues::rays};
constexpr Argument next_rays{"next_rays", &Queues::next_rays};
constexpr Argument paths{"paths", &Queues::paths};
constexpr Argument shadow_rays{"shadow_rays", &Queues::shadow_rays};
constexpr Argument visibility{"visibility", &Queues::visibility};
constexpr Argument points{"points", &Queues::points};
constexpr Argument results{"results", &Queues::results};
constexpr Argument counters{"counters", &Queues::counters};
constexpr Argument sums{"sums", &Queues::film};
constexpr Argument first_pixel{"first_pixel", &Work::first_pixel};
constexpr Argument pixel_count{"pixel_count", &Work::pixel_count};
constexpr Argument first_pass{"first_pass", &Work::first_pass};
constexpr Argument pass_count{"pass_count", &Work::pass_count};
constexpr Argument count{"count", &Work::count};
constexpr Argument depth{"depth", &Work::depth};

bool always(const Needs&) {
    return true;
}

uint64_t each(const Work& work, const QueueShape&) {
    return work.count;
}
uint64_t each_light_sample(const Work& work, const QueueShape& shape) {
    return uint64_t{work.count} * shape.light_samples;
}
uint64_t each_pixel(const Work& work, const QueueShape&) {
    return work.pixel_count;
}

uint64_t shadow_rays_counted(const DeviceStatus& status, const QueueShape&) {
    return status[COUNT_SHADOWS];
}
uint64_t obscurance_rays_counted(const DeviceStatus& status, const QueueShape& shape) {
    return uint64_t{status[COUNT_POINTS]} * shape.obscurance_rays;
}

// What shade appends for one ray.
constexpr std::array<Append, 3> shade_appends{{
    {Queue::next_rays, [](const QueueShape& shape) -> uint64_t { return shape.specular_paths ? 1 : 0; }},
    {Queue::shadow_rays, [](const QueueShape& shape) -> uint64_t { return shape.light_samples; }},
    {Queue::points, [](const QueueShape& shape) -> uint64_t { return shape.obscurance_rays > 0 ? 1 : 0; }},
}};
constexpr std::array<Append, 3> nothing{};

}  // namespace

using enum StageTime;
// clang-format off
constexpr std::array<StageInfo, STAGE_COUNT> STAGES{{
    {Stage::camera, "camera", wave_start, {"camera", "camera"}, "", always, each, nullptr, nothing,
     {frame, tables, sample_order, pixel_order, rays, paths, first_pixel, first_pass, pass_count, count}},

    {Stage::trace, "trace", each_depth, {"trace_camera", "trace_glossy"}, "", always, each, nullptr, nothing,
     {frame, nodes, blocks, rays, counters, count}},

    {Stage::shade, "shade", each_depth, {"shade", "shade"},
     "textures smooth_normals glossy mirror transmission area_lights point_lights spot_lights directional_lights "
     "emission background ambient obscurance specular_paths",
     always, each, nullptr, shade_appends,
     {frame, triangles, materials, area_lights, point_lights, texels, tables, rays, paths, next_rays, shadow_rays,
      points, counters, count, depth}},

    {Stage::shadow, "shadow", each_depth, {"shadow", "shadow"},
     "textures transmission area_lights point_lights spot_lights directional_lights",
     [](const Needs& needs) { return needs.direct(); }, each_light_sample, shadow_rays_counted, nothing,
     {frame, nodes, blocks, triangles, materials, texels, tables, shadow_rays, visibility, counters}},

    {Stage::obscurance, "obscurance", each_depth, {"obscurance", "obscurance"},
     "textures transmission bleeding falloff",
     [](const Needs& needs) { return needs.obscurance; }, each, obscurance_rays_counted, nothing,
     {frame, nodes, blocks, triangles, materials, texels, tables, points, paths, results, counters, depth}},

    {Stage::gather, "gather", each_depth, {"gather", "gather"},
     "glossy area_lights point_lights spot_lights directional_lights ambient obscurance",
     always, each, nullptr, nothing,
     {frame, rays, visibility, results, paths, count, depth}},

    {Stage::film, "film", wave_end, {"film", "film"}, "", always, each_pixel, nullptr, nothing,
     {frame, paths, sums, counters, first_pixel, pixel_count, first_pass, pass_count}},
}};
// clang-format on

// stage_info() looks a stage up by its number, and messages name one by the number that its kernel reports.
static_assert([] {
    for (uint32_t i = 0; i < STAGE_COUNT; ++i)
        if (STAGES[i].stage != static_cast<Stage>(i)) return false;
    return true;
}());

std::vector<Stage> needed_stages(const Needs& needs) {
    std::vector<Stage> stages;
    for (const StageInfo& info : STAGES)
        if (info.needed(needs)) stages.push_back(info.stage);
    return stages;
}

std::vector<LaunchArgument> stage_arguments(const StageInfo& stage, const SceneBuffers& scene,
                                            const Queues& queues, const Work& work) {
    struct Resolve {
        const SceneBuffers& scene;
        const Queues& queues;
        const Work& work;
        LaunchArgument operator()(Buffer SceneBuffers::*member) const {
            return LaunchArgument(scene.*member);
        }
        LaunchArgument operator()(Buffer Queues::*member) const { return LaunchArgument(queues.*member); }
        LaunchArgument operator()(uint32_t Work::*member) const { return LaunchArgument(work.*member); }
    };
    std::vector<LaunchArgument> arguments;
    for (const Argument& parameter : stage.parameters) {
        if (parameter.name.empty()) break;
        arguments.push_back(std::visit(Resolve{scene, queues, work}, parameter.source));
    }
    return arguments;
}

}  // namespace obscura
