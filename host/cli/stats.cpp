// SPDX-License-Identifier: Apache-2.0
#include "cli/stats.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/file.h"
#include "sampling/sample_order.h"
#include "scene/needs.h"
#include "scene/radiometry.h"

namespace obscura {
namespace {

nlohmann::json rgb(const V3d& v) {
    return {v.x, v.y, v.z};
}

nlohmann::json needed_names(const Scene& scene, const RenderSettings& settings) {
    nlohmann::json names = nlohmann::json::array();
    for (const Need& need : explain_needs(scene, settings)) {
        if (need.needed) names.push_back(need.name);
    }
    return names;
}

nlohmann::json kernel_rows(const RenderResult& result) {
    nlohmann::json rows = nlohmann::json::object();
    for (const auto& [name, row] : result.profile) {
        rows[name] = {{"launches", row.launches}, {"items", row.items}, {"ms", row.ms}};
    }
    return rows;
}

}  // namespace

void write_stats(const std::string& path, const Scene& scene, const DeviceInfo& device,
                 const RenderResult& result, const RunSeconds& seconds) {
    const RenderSettings& settings = result.settings;
    const nlohmann::json stats{
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
          {"render", result.seconds.render},
          {"write", seconds.write},
          {"total", seconds.total}}},
        {"kernels", kernel_rows(result)},
        {"bytes", result.bytes},
        {"needs", needed_names(scene, settings)},
    };
    const std::string text = stats.dump(2) + "\n";
    if (path == "-") {
        fmt::print("{}", text);
    } else {
        write_text(path, text);
    }
}

}  // namespace obscura
