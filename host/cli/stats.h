// SPDX-License-Identifier: Apache-2.0
// The figures of a run as JSON, for --stats.
#pragma once

#include <span>
#include <string>

#include "cli/profile_report.h"
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

// path: a file, or "-" for standard output. profiles: of each device, or none. Throws InputError.
void write_stats(const std::string& path, const Scene& scene, std::span<const RenderDevice> devices,
                 const RenderResult& result, const RunSeconds& seconds,
                 std::span<const RenderProfile> profiles);

}  // namespace obscura
