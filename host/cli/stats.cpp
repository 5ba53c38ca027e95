// SPDX-License-Identifier: Apache-2.0
#include "cli/stats.h"

#include <fmt/ranges.h>

#include <set>

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

// What the run and each of its devices are told by alike.
Json work_figures(const DeviceWork& work) {
    Json kernels = Json::object();
    for (const auto& [name, row] : work.profile)
        kernels[name] = {{"launches", row.launches}, {"items", row.items}, {"ms", row.ms}};
    return {{"wave_capacity", work.wave_capacity},
            {"rays",
             {{"camera", work.rays.camera},
              {"shadow", work.rays.shadow},
              {"glossy", work.rays.glossy},
              {"obscurance", work.rays.obscurance}}},
            {"kernels", std::move(kernels)},
            {"bytes", work.bytes}};
}

// Only where there are several.
Json device_rows(std::span<const RenderDevice> devices, const RenderResult& result,
                 std::span<const RenderProfile> profiles) {
    Json rows = Json::array();
    for (size_t i = 0; i < devices.size(); ++i) {
        const Device& device = devices[i].device;
        Json row = work_figures(result.devices[i]);
        row.update({{"device", device.name()},
                    {"driver", device.info().driver_version},
                    {"compute_units", device.info().compute_units}});
        if (!profiles.empty()) row["profile"] = profile_json(profiles[i]);
        rows.push_back(std::move(row));
    }
    return rows;
}

std::string drivers(std::span<const RenderDevice> devices) {
    std::set<std::string> versions;
    for (const RenderDevice& device : devices)
        versions.insert(device.device.info().driver_version);
    return fmt::format("{}", fmt::join(versions, ", "));
}

}  // namespace

void write_stats(const std::string& path, const Scene& scene, std::span<const RenderDevice> devices,
                 const RenderResult& result, const RunSeconds& seconds,
                 std::span<const RenderProfile> profiles) {
    const RenderSettings& settings = result.settings;
    Json stats{
        {"version", OBSCURA_VERSION},
        {"scene", scene.name},
        {"device", device_names(devices)},
        {"driver", drivers(devices)},
        {"width", settings.width},
        {"height", settings.height},
        {"spp", settings.spp},
        {"obscurance_rays", settings.obscurance_rays},
        {"seed", settings.seed},
        {"sampler", sampler_name(settings.sampler)},
        {"rho", falloff_text(settings.falloff)},
        {"d_max", result.d_max},
        {"complete", result.complete},
        {"R_ave", rgb(result.radiometry.average_reflectivity)},
        {"I_A", rgb(resolve_ambient(result.radiometry, settings))},
        {"triangles", scene.triangles.size()},
        {"objects", scene.objects.size()},
        {"seconds",
         {{"load", seconds.load},
          {"build", result.seconds.build},
          {"compile", result.seconds.compile},
          {"upload", result.seconds.upload},
          {"first_wave", seconds.first_wave},
          {"render", result.seconds.render},
          {"write", seconds.write},
          {"total", seconds.total}}},
        {"needs", needed_names(scene, settings)},
    };
    stats.update(work_figures(result));
    if (devices.size() > 1) {
        stats["devices"] = device_rows(devices, result, profiles);
    } else if (!profiles.empty()) {
        stats["profile"] = profile_json(profiles.front());
    }
    write_json(path, stats);
}

}  // namespace obscura
