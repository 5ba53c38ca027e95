// SPDX-License-Identifier: Apache-2.0
// See devices.h.
#include "cli/devices.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>

#include "base/units.h"
#include "cli/json_output.h"
#include "device/selector.h"

namespace obscura {

namespace {

Json to_json(const std::vector<DeviceInfo>& devices) {
    const int chosen = default_device(devices);
    Json rows = Json::array();
    for (const DeviceInfo& info : devices) {
        Json row = {{"platform", info.platform}, {"usable", info.usable}, {"reason", info.reason}};
        if (info.platform_index >= 0) {
            row["platform_index"] = info.platform_index;
            row["platform_version"] = info.platform_version;
        }
        if (info.index >= 0)
            row.update({{"index", info.index},
                        {"device_index", info.device_index},
                        {"name", info.name},
                        {"driver_version", info.driver_version},
                        {"opencl_version", info.opencl_version},
                        {"compute_units", info.compute_units},
                        {"max_sub_devices", info.max_sub_devices},
                        {"memory_bytes", info.memory_bytes},
                        {"max_allocation_bytes", info.max_allocation_bytes},
                        {"float_features", info.float_features}});
        rows.push_back(std::move(row));
    }
    Json result = {{"default", nullptr}, {"devices", std::move(rows)}};
    if (chosen >= 0) result["default"] = devices[static_cast<size_t>(chosen)].index;
    return result;
}

void print_table(const std::vector<DeviceInfo>& devices) {
    const int chosen = default_device(devices);
    for (size_t i = 0; i < devices.size(); ++i) {
        const DeviceInfo& info = devices[i];
        if (info.index < 0) {
            fmt::print("-  {}\n     not usable: {}\n", info.platform, info.reason);
            continue;
        }
        fmt::print("{}  {}{}\n", info.index, info.name, static_cast<int>(i) == chosen ? "  (default)" : "");
        fmt::print("     platform        {} ({}:{})\n", info.platform, info.platform_index,
                   info.device_index);
        fmt::print("     driver          {}, {}\n", info.driver_version, info.opencl_version);
        fmt::print("     compute units   {}{}\n", info.compute_units,
                   info.max_sub_devices > 0
                       ? fmt::format(", which make up to {} sub-devices", info.max_sub_devices)
                       : "");
        fmt::print("     memory          {}, at most {} in one buffer\n", bytes_text(info.memory_bytes),
                   bytes_text(info.max_allocation_bytes));
        fmt::print("     floats          {}\n", fmt::join(info.float_features, ", "));
        fmt::print("     usable          {}\n", info.usable ? "yes" : "no: " + info.reason);
    }
    if (chosen < 0)
        fmt::print("obscura can use none of them.\n");
    else
        fmt::print(
            "Choose one with --device or OBSCURA_DEVICE: an index, platform:device, or part of its or its "
            "platform's name or version.\nSeveral, separated by commas, share a render; SELECTOR/N splits a "
            "device into N sub-devices.\n");
}

}  // namespace

void add_devices_command(CLI::App& app, ExitCode& exit_code) {
    CLI::App* const command =
        app.add_subcommand("devices", "List every OpenCL device, usable or not and why");
    const auto json_target = std::make_shared<std::string>();
    command->add_option("--json", *json_target, "Write the list as JSON to FILE; - is standard output")
        ->type_name("FILE|-");
    command->callback([json_target, &exit_code] {
        const std::vector<DeviceInfo> devices = list_devices();
        if (json_target->empty()) {
            print_table(devices);
        } else {
            write_json(*json_target, to_json(devices));
        }
        const bool any_usable =
            std::ranges::any_of(devices, [](const DeviceInfo& info) { return info.usable; });
        exit_code = any_usable ? ExitCode::ok : ExitCode::device_failure;
    });
}

}  // namespace obscura
