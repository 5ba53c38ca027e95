// SPDX-License-Identifier: Apache-2.0
// What `obscura render` leaves behind: the picture, its preview, figures, and where the time went.
#pragma once

#include <CLI/App.hpp>

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/stopwatch.h"
#include "base/trace.h"
#include "cli/stats.h"
#include "scene/scene.h"
#include "wavefront/render.h"

namespace obscura {

enum class ExrNames { plain, blender };

struct OutputOptions {
    std::string output;
    std::string preview;
    std::string stats;
    std::string trace;
    std::string heat_map;
    bool profile = false;
    std::vector<std::string> layers{"emission",        "direct",           "ambient",   "specular.emission",
                                    "specular.direct", "specular.ambient", "obscurance"};
    double exposure_stops = 0;
    bool half_color = false;
    ExrNames names = ExrNames::plain;

    bool needs_visits() const { return profile || !heat_map.empty(); }
};

// Registers the options on the subcommand.
std::shared_ptr<OutputOptions> add_output_options(CLI::App& command);
// Throws InputError if an output can't be written or is the scene.
void check_output_options(const OutputOptions& out, const std::string& scene_file);

// The trace alone, if one is wanted.
void write_trace(const OutputOptions& out, std::span<const RenderDevice> devices, const TraceRecord& trace);
// Everything that is wanted; whatever fails, the rest is written. portable: the kernels were; run: since the
// program's start. Of seconds, write and total are filled.
void write_outputs(const OutputOptions& out, const Scene& scene, std::span<const RenderDevice> devices,
                   TraceRecord& trace, RenderResult& result, bool portable, RunSeconds& seconds,
                   const Stopwatch& run);

}  // namespace obscura
