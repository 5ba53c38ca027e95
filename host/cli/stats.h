// SPDX-License-Identifier: Apache-2.0
// The figures of a run as JSON, for --stats.
#pragma once

#include <optional>
#include <string>

#include "cli/profile_report.h"
#include "device/selector.h"
#include "scene/scene.h"
#include "wavefront/render.h"

namespace obscura {

// Wall times around the render, seconds.
struct RunSeconds {
    double load = 0;
    double first_wave = 0;  // from the start of the program to the launch of the first wave
    double write = 0;
    double total = 0;
};

// path: a file, or "-" for standard output. Throws InputError.
void write_stats(const std::string& path, const Scene& scene, const DeviceInfo& device,
                 const RenderResult& result, const RunSeconds& seconds,
                 const std::optional<RenderProfile>& profile);

}  // namespace obscura
