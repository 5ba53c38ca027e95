// SPDX-License-Identifier: Apache-2.0
#include "cli/render_output.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "base/error.h"
#include "base/log.h"
#include "base/units.h"
#include "cli/choice_option.h"
#include "cli/output_paths.h"
#include "cli/picture_output.h"
#include "cli/profile_report.h"
#include "cli/validators.h"
#include "film/blender_names.h"
#include "film/image.h"
#include "film/visit_map.h"

namespace obscura {
namespace {

constexpr const char* GROUP = "Output";

void add_picture_options(CLI::App& command, OutputOptions& out) {
    command.add_option("-o,--output,--outfile", out.output, "The picture with all its layers (EXR)")
        ->required()
        ->check(not_empty())
        ->type_name("X.exr")
        ->group(GROUP);
    CLI::Option* const preview =
        command.add_option("--preview", out.preview, "The beauty layer as an 8-bit PNG too")
            ->type_name("X.png")
            ->group(GROUP);
    command.add_option("--exposure", out.exposure_stops, "The preview's exposure in stops")
        ->needs(preview)
        ->check(exposure_range())
        ->capture_default_str()
        ->group(GROUP);
    command
        .add_option("--layers", out.layers,
                    "Layers, separated by commas, or all, or none; beauty is always written")
        ->delimiter(',')
        ->capture_default_str()
        ->group(GROUP);
    command.add_flag("--exr-half", out.half_color, "Colours as 16-bit floats: half the file")->group(GROUP);
    add_choice<ExrNames>(command, "--exr-names", out.names,
                         {{"plain", ExrNames::plain}, {"blender", ExrNames::blender}},
                         "Names of the EXR's channels: obscura's, or as in Blender's multi-layer EXRs")
        ->default_str("plain")
        ->group(GROUP);
}

void add_figure_options(CLI::App& command, OutputOptions& out) {
    command.add_option("--stats", out.stats, "Write the run's figures as JSON; - is standard output")
        ->type_name("FILE.json|-")
        ->group(GROUP);
    command
        .add_option("--trace", out.trace,
                    "Write what the host and the device did when, for ui.perfetto.dev or chrome://tracing")
        ->type_name("FILE.json")
        ->group(GROUP);
    command
        .add_flag("--profile", out.profile,
                  "Print where each stage's time goes and what its rays visit; takes about as long again")
        ->group(GROUP);
    command
        .add_option("--heatmap", out.heat_map,
                    "Draw the nodes that each pixel's rays visit; the EXR gets them as the layer visits")
        ->type_name("X.png")
        ->group(GROUP);
}

void print_summary(const RenderResult& result, std::span<const RenderDevice> devices,
                   const RunSeconds& seconds) {
    const double rays = static_cast<double>(result.rays.total());
    log_info("{} {} in {}, {} rays/s (camera {}, shadow {}, glossy {}, obscurance {})", si_count(rays),
             plural(result.rays.total(), "ray"), duration_text(result.seconds.render),
             si_count(rays / result.seconds.render), si_count(static_cast<double>(result.rays.camera)),
             si_count(static_cast<double>(result.rays.shadow)),
             si_count(static_cast<double>(result.rays.glossy)),
             si_count(static_cast<double>(result.rays.obscurance)));
    log_info("load {}, build {}, compile {}, upload {}, render {}, write {}; device memory at most {}",
             duration_text(seconds.load), duration_text(result.seconds.build),
             duration_text(result.seconds.compile), duration_text(result.seconds.upload),
             duration_text(result.seconds.render), duration_text(seconds.write),
             bytes_text(result.bytes.at("peak_device")));
    if (devices.size() == 1) return;
    for (size_t i = 0; i < devices.size(); ++i) {
        const double share =
            static_cast<double>(result.devices[i].rays.camera) / static_cast<double>(result.rays.camera);
        log_info("{}: {:.0f} % of the samples", devices[i].device.name(), 100 * share);
    }
}

void write_heat_map(const RenderResult& result, const std::string& path) {
    const VisitRange range = write_visit_map_png(result.image, result.nodes_per_sample, path);
    log_info("wrote {}: from black for 0 to pale yellow for {:.0f} nodes per sample; the most are {:.0f}",
             path, range.brightest, range.most);
}

std::vector<RenderProfile> make_profiles(const RenderResult& result, std::span<const RenderDevice> devices,
                                         TraceRecord& trace, bool portable) {
    std::vector<RenderProfile> profiles;
    for (size_t i = 0; i < devices.size(); ++i) {
        const TraceStep step(&trace, TraceCategory::host, "measure the device");
        const DeviceWork& work = result.devices[i];
        const DeviceRates rates = measure_rates(devices[i].device, devices[i].programs, portable);
        profiles.push_back({rates, stage_figures(work, rates), *work.visits});
    }
    return profiles;
}

void print_profiles(const std::vector<RenderProfile>& profiles, std::span<const RenderDevice> devices) {
    for (size_t i = 0; i < profiles.size(); ++i) {
        if (profiles.size() > 1) fmt::print("{}{}\n", i > 0 ? "\n" : "", devices[i].device.name());
        print_profile(profiles[i]);
    }
}

}  // namespace

std::shared_ptr<OutputOptions> add_output_options(CLI::App& command) {
    auto out = std::make_shared<OutputOptions>();
    add_picture_options(command, *out);
    add_figure_options(command, *out);
    return out;
}

void check_output_options(const OutputOptions& out, const std::string& scene_file) {
    check_outputs({{"--output", out.output, ".exr"},
                   {"--preview", out.preview, ".png"},
                   {"--stats", out.stats},
                   {"--trace", out.trace},
                   {"--heatmap", out.heat_map, ".png"}},
                  {scene_file});
    if (out.trace == "-") throw InputError("--trace -: traces are written to files only");
}

void write_trace(const OutputOptions& out, std::span<const RenderDevice> devices, const TraceRecord& trace) {
    if (out.trace.empty()) return;
    for (const RenderDevice& device : devices)
        device.device.commands()->flush();
    trace.write(out.trace);
    log_info("wrote {}", out.trace);
}

void write_outputs(const OutputOptions& out, const Scene& scene, std::span<const RenderDevice> devices,
                   TraceRecord& trace, RenderResult& result, bool portable, RunSeconds& seconds,
                   const Stopwatch& run) {
    const Stopwatch writing;
    const auto step = [&](const char* name) { return TraceStep(&trace, TraceCategory::host, name); };
    if (!out.heat_map.empty()) result.image.layers.push_back(visit_layer(result.nodes_per_sample));
    write_all({[&] {
                   const TraceStep traced = step("write picture");
                   if (out.names == ExrNames::blender) use_blender_names(result.image);
                   save_picture(result.image, out.output, out.half_color);
                   log_info("wrote {}", out.output);
               },
               [&] {
                   if (out.preview.empty()) return;
                   const TraceStep traced = step("write preview");
                   write_preview_png(result.image, out.preview, out.exposure_stops);
                   log_info("wrote {}", out.preview);
               },
               [&] {
                   if (out.heat_map.empty()) return;
                   const TraceStep traced = step("write heat map");
                   write_heat_map(result, out.heat_map);
               },
               [&] {
                   seconds.write = writing.seconds();
                   seconds.total = run.seconds();
                   std::vector<RenderProfile> profiles;
                   if (out.profile) profiles = make_profiles(result, devices, trace, portable);
                   if (out.stats != "-") print_profiles(profiles, devices);
                   if (out.stats.empty()) return;
                   write_stats(out.stats, scene, devices, result, seconds, profiles);
               },
               [&] { write_trace(out, devices, trace); }});
    print_summary(result, devices, seconds);
}

}  // namespace obscura
