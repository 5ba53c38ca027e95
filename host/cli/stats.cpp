// SPDX-License-Identifier: Apache-2.0
#include "cli/stats.h"

#include "cli/json_output.h"
#include "sampling/sample_order.h"
#include "scene/needs.h"
#include "scene/radiometry.h"

namespace obscura {
namespace {

Json rgb(const V3d& v) {
    return {v.x, v.y, v.z};
}

Json needed_names(const Scene& scene, const RenderSettings& settings) {
    Json names = Json::array();
    for (const Need& need : explain_needs(scene, settings)) {
        if (need.needed) names.push_back(need.name);
    }
    return names;
}

Json kernel_rows(const RenderResult& result) {
    Json rows = Json::object();
    for (const auto& [name, row] : result.profile) {
        rows[name] = {{"launches", row.launches}, {"items", row.items}, {"ms", row.ms}};
    }
    return rows;
}

}  // namespace

void write_stats(const std::string& path, const Scene& scene, const DeviceInfo& device,
                 const RenderResult& result, const RunSeconds& seconds,
                 const std::optional<RenderProfile>& profile) {
    const RenderSettings& settings = result.settings;
    Json stats{
        {"version", OBSCURA_VERSION},
        {"scene", scene.name},
        {"device", device.name},
        {"driver", device.driver_version},
        {"width", settings.width},
        {"height", settings.height},
        {"spp", settings.spp},
        {"obscurance_rays", settings.obscurance_rays},
        {"seed", settings.seed},
        {"sampler", sampler_name(settings.sampler)},
        {"rho", falloff_text(settings.falloff)},
        {"d_max", result.d_max},
        {"complete", result.complete},
        {"wave_capacity", result.wave_capacity},
        {"R_ave", rgb(result.radiometry.average_reflectivity)},
        {"I_A", rgb(resolve_ambient(result.radiometry, settings))},
        {"triangles", scene.triangles.size()},
        {"objects", scene.objects.size()},
        {"rays",
         {{"camera", result.rays.camera},
          {"shadow", result.rays.shadow},
          {"glossy", result.rays.glossy},
          {"obscurance", result.rays.obscurance}}},
        {"seconds",
         {{"load", seconds.load},
          {"build", result.seconds.build},
          {"compile", result.seconds.compile},
          {"upload", result.seconds.upload},
          {"first_wave", seconds.first_wave},
          {"render", result.seconds.render},
          {"write", seconds.write},
          {"total", seconds.total}}},
        {"kernels", kernel_rows(result)},
        {"bytes", result.bytes},
        {"needs", needed_names(scene, settings)},
    };
    if (profile) stats["profile"] = profile_json(*profile);
    write_json(path, stats);
}

}  // namespace obscura
