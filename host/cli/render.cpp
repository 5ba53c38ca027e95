// SPDX-License-Identifier: Apache-2.0
#include "cli/render.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include "base/log.h"
#include "base/progress.h"
#include "base/units.h"
#include "cli/choice_option.h"
#include "cli/interrupt.h"
#include "cli/output_paths.h"
#include "cli/picture_output.h"
#include "cli/render_options.h"
#include "cli/stats.h"
#include "cli/validators.h"
#include "film/blender_names.h"
#include "film/develop.h"
#include "scene/gltf.h"
#include "wavefront/render.h"

namespace obscura {
namespace {

enum class ExrNames { plain, blender };

struct OutputOptions {
    std::string output;
    std::string preview;
    std::string stats;
    std::string trace;
    std::vector<std::string> layers{"emission",        "direct",           "ambient",   "specular.emission",
                                    "specular.direct", "specular.ambient", "obscurance"};
    double exposure_stops = 0;
    bool half_color = false;
    ExrNames names = ExrNames::plain;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::vector<std::string> all_layer_names() {
    std::vector<std::string> names;
    for (const LayerInfo& info : layer_table())
        names.emplace_back(info.name);
    return names;
}

// The layers beside beauty, which is there anyway. "all" and "none" stand for themselves; anything else must be in the
// table.
std::vector<std::string> resolve_layers(std::vector<std::string> wanted) {
    std::erase(wanted, "beauty");
    std::vector<std::string> known = all_layer_names();
    if (wanted == std::vector<std::string>{"all"}) return known;
    if (wanted == std::vector<std::string>{"none"}) return {};
    std::vector<std::string> layers;
    for (const std::string& name : wanted) {
        if (name == "all" || name == "none")
            throw InputError("--layers {}: all and none stand alone, without names of layers",
                             fmt::join(wanted, ","));
        if (std::ranges::find(known, name) == known.end()) {
            throw InputError("--layers {}: there is no such layer; choose from beauty, {}, or all, or none",
                             name, fmt::join(known, ", "));
        }
        if (std::ranges::find(layers, name) == layers.end()) layers.push_back(name);
    }
    return layers;
}

void print_summary(const RenderResult& result, const RunSeconds& seconds) {
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
}

void write_trace(const std::string& path, const Device& device) {
    if (path.empty()) return;
    device.commands()->flush();
    device.trace()->write(path);
    log_info("wrote {}", path);
}

// seconds: write and total are filled.
void write_outputs(const OutputOptions& out, const Scene& scene, const Device& device,
                   const RenderResult& result, RunSeconds& seconds,
                   std::chrono::steady_clock::time_point start) {
    const auto write_start = std::chrono::steady_clock::now();
    write_all({[&] {
                   const TraceStep step(device.trace(), TraceCategory::host, "write picture");
                   save_picture(result.image, out.output, out.half_color);
                   log_info("wrote {}", out.output);
               },
               [&] {
                   if (out.preview.empty()) return;
                   const TraceStep step(device.trace(), TraceCategory::host, "write preview");
                   write_preview_png(result.image, out.preview, out.exposure_stops);
                   log_info("wrote {}", out.preview);
               },
               [&] {
                   seconds.write = seconds_since(write_start);
                   seconds.total = seconds_since(start);
                   if (!out.stats.empty()) write_stats(out.stats, scene, device.info(), result, seconds);
               },
               [&] { write_trace(out.trace, device); }});
}

ExitCode run_render(const RenderOptions& options, const OutputOptions& out) {
    set_quiet(options.quiet);
    TraceRecord trace;
    const auto start = std::chrono::steady_clock::now();
    const std::filesystem::path scene_file = find_scene_file(options.scene);
    check_outputs({{"--output", out.output, ".exr"},
                   {"--preview", out.preview, ".png"},
                   {"--stats", out.stats},
                   {"--trace", out.trace}},
                  {scene_file.string()});
    if (out.trace == "-") throw InputError("--trace -: traces are written to files only");
    const RenderSettings settings = settings_of(options);
    const std::vector<std::string> layers = resolve_layers(out.layers);
    const uint64_t queue_bytes = parse_bytes(options.memory);
    // The driver starts while the scene is read.
    std::future<std::unique_ptr<Device>> opening = std::async(std::launch::async, [&] {
        const TraceStep step(&trace, TraceCategory::host, "open device");
        return std::unique_ptr<Device>(new Device(open_device(options.device)));
    });
    const Scene scene = load_gltf(scene_file);
    RunSeconds seconds;
    seconds.load = seconds_since(start);
    trace.add_step(TraceCategory::host, "load", 0, trace.now_ns(), {});

    const std::unique_ptr<Device> opened = opening.get();
    Device& device = *opened;
    if (!out.trace.empty()) device.log_commands(trace);
    ProgramLibrary library(device, options.local_size);
    catch_interrupts();
    log_info("{}: {}, {}; device {}", scene.name, counted(scene.triangles.size(), "triangle"),
             counted(scene.objects.size(), "object"), device.name());
    std::unique_ptr<Progress> progress;
    const RenderJob job{scene, settings, layers, queue_bytes, options.wave_size, options.portable};
    RenderResult result = render_scene(device, library, job, [&](double fraction, const RayCounts& rays) {
        if (!progress) {
            seconds.first_wave = seconds_since(start);
            progress = std::make_unique<Progress>("render", "ray");
        }
        progress->update(fraction, rays.total());
        return !is_interrupted();
    });
    if (progress) progress->finish(result.rays.total());
    progress.reset();

    if (result.rays.camera == 0) {
        ignore_interrupts();
        write_trace(out.trace, device);
        log_warning("stopped before the first sample: no picture is written");
        return ExitCode::interrupted;
    }
    ignore_interrupts();
    if (out.names == ExrNames::blender) use_blender_names(result.image);
    write_outputs(out, scene, device, result, seconds, start);
    print_summary(result, seconds);
    if (result.complete) return ExitCode::ok;
    log_warning("stopped early: the picture is saved with the samples it has");
    return ExitCode::interrupted;
}

}  // namespace

void add_render_command(CLI::App& app, ExitCode& exit_code) {
    CLI::App* command = app.add_subcommand("render", "Render a scene with ray-traced obscurances");
    const auto options = add_render_options(*command);
    const auto out = std::make_shared<OutputOptions>();
    const char* group = "Output";
    command->add_option("-o,--output,--outfile", out->output, "The picture with all its layers (EXR)")
        ->required()
        ->check(not_empty())
        ->type_name("X.exr")
        ->group(group);
    CLI::Option* const preview =
        command->add_option("--preview", out->preview, "The beauty layer as an 8-bit PNG too")
            ->type_name("X.png")
            ->group(group);
    command->add_option("--exposure", out->exposure_stops, "The preview's exposure in stops")
        ->needs(preview)
        ->check(exposure_range())
        ->capture_default_str()
        ->group(group);
    command
        ->add_option("--layers", out->layers,
                     "Layers, separated by commas, or all, or none; beauty is always written")
        ->delimiter(',')
        ->capture_default_str()
        ->group(group);
    command->add_flag("--exr-half", out->half_color, "Colours as 16-bit floats: half the file")->group(group);
    add_choice<ExrNames>(*command, "--exr-names", out->names,
                         {{"plain", ExrNames::plain}, {"blender", ExrNames::blender}},
                         "Names of the EXR's channels: obscura's, or as in Blender's multi-layer EXRs")
        ->default_str("plain")
        ->group(group);
    command->add_option("--stats", out->stats, "Write the run's figures as JSON; - is standard output")
        ->type_name("FILE.json|-")
        ->group(group);
    command
        ->add_option("--trace", out->trace,
                     "Write what the host and the device did when, for ui.perfetto.dev or chrome://tracing")
        ->type_name("FILE.json")
        ->check(not_empty())
        ->group(group);
    command->callback([options, out, &exit_code] { exit_code = run_render(*options, *out); });
}

}  // namespace obscura
