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
constexpr Argument first_pass{"first_pass", &Work::first_pass};
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
    return std::min(work.count, work.pixels);
}

}  // namespace

// clang-format off
constinit const std::array<StageInfo, STAGE_COUNT> STAGES{{
    {Stage::camera, "camera", {"camera", "camera"}, "", always, each,
     {frame, tables, sample_order, rays, paths, first_pixel, first_pass, count}},

    {Stage::trace, "trace", {"trace_camera", "trace_glossy"}, "", always, each,
     {frame, nodes, blocks, rays, counters, count}},

    {Stage::shade, "shade", {"shade", "shade"},
     "textures smooth_normals glossy mirror transmission area_lights point_lights spot_lights directional_lights "
     "emission background ambient obscurance specular_paths",
     always, each,
     {frame, triangles, materials, area_lights, point_lights, texels, tables, rays, paths, next_rays, shadow_rays,
      points, counters, count, depth}},

    {Stage::shadow, "shadow", {"shadow", "shadow"},
     "textures transmission area_lights point_lights spot_lights directional_lights",
     [](const Needs& needs) { return needs.direct(); }, each_light_sample,
     {frame, nodes, blocks, triangles, materials, texels, tables, shadow_rays, visibility, counters}},

    {Stage::obscurance, "obscurance", {"obscurance", "obscurance"},
     "textures transmission bleeding falloff",
     [](const Needs& needs) { return needs.obscurance; }, each,
     {frame, nodes, blocks, triangles, materials, texels, tables, points, paths, results, counters, depth}},

    {Stage::gather, "gather", {"gather", "gather"},
     "glossy area_lights point_lights spot_lights directional_lights ambient obscurance",
     [](const Needs& needs) { return needs.direct() || needs.ambient; }, each,
     {frame, rays, visibility, results, paths, count, depth}},

    {Stage::film, "film", {"film", "film"}, "", always, each_pixel,
     {frame, paths, sums, counters, first_pixel, first_pass, count}},
}};
// clang-format on

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
