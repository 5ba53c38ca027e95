// SPDX-License-Identifier: Apache-2.0
#include "cli/render.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <exception>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/log.h"
#include "base/progress.h"
#include "base/stopwatch.h"
#include "base/units.h"
#include "cli/interrupt.h"
#include "cli/render_options.h"
#include "cli/render_output.h"
#include "film/develop.h"
#include "scene/gltf.h"
#include "wavefront/render.h"

namespace obscura {
namespace {

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

// What the other thread prepares while the device is opened.
struct Input {
    std::unique_ptr<const Scene> scene;
    RenderJob job;
    RenderSetup setup;
};

ExitCode run_render(const RenderOptions& options, const OutputOptions& out) {
    set_quiet(options.quiet);
    TraceRecord trace;
    const Stopwatch run;
    const std::filesystem::path scene_file = find_scene_file(options.scene);
    check_output_options(out, scene_file.string());
    const RenderSettings settings = settings_of(options);
    const std::vector<std::string> layers = resolve_layers(out.layers);
    const uint64_t queue_bytes = parse_bytes(options.memory);
    // The scene is read, and its BVH begun, while the driver starts: in the other thread of the two, as Oclgrind 21.10
    // crashes when a device is used by another thread than the one that opened it.
    RunSeconds seconds;
    std::atomic<bool> has_no_device = false;
    std::future<Input> reading = std::async(std::launch::async, [&] {
        std::optional<TraceStep> step(std::in_place, &trace, TraceCategory::host, "load");
        auto scene = std::make_unique<const Scene>(load_gltf(scene_file));
        seconds.load = run.seconds();
        step.reset();
        RenderJob job{*scene, settings, layers, queue_bytes, options.wave_size, options.portable};
        job.count_visits = out.needs_visits();
        const RenderSetup setup = set_up_render(job);
        if (!has_no_device) job.bvh = start_building(job, &trace);
        return Input{std::move(scene), std::move(job), setup};
    });
    std::vector<std::unique_ptr<Device>> opened;
    std::exception_ptr no_device;
    try {
        const TraceStep step(&trace, TraceCategory::host, "open device");
        opened = open_devices(options.device);
    } catch (const std::exception&) {
        no_device = std::current_exception();
        has_no_device = true;
    }
    Input input = reading.get();  // what is wrong with the scene is told first
    if (no_device) std::rethrow_exception(no_device);
    const Scene& scene = *input.scene;
    std::vector<std::unique_ptr<ProgramLibrary>> libraries;
    std::vector<RenderDevice> devices;
    for (const auto& device : opened) {
        if (!out.trace.empty()) device->log_commands(trace);
        libraries.push_back(std::make_unique<ProgramLibrary>(*device, options.local_size));
        devices.push_back({*device, *libraries.back()});
    }
    catch_interrupts();
    log_info("{}: {}, {}; {} {}", scene.name, counted(scene.triangles.size(), "triangle"),
             counted(scene.objects.size(), "object"), plural(devices.size(), "device"),
             device_names(devices));
    std::unique_ptr<Progress> progress;
    const auto after_wave = [&](double fraction, const RayCounts& rays) {
        if (!progress) {
            seconds.first_wave = run.seconds();
            progress = std::make_unique<Progress>("render", "ray");
        }
        progress->update(fraction, rays.total());
        return !is_interrupted();
    };
    RenderResult result = render_scene(devices, input.job, input.setup, after_wave);
    if (progress) progress->finish(result.rays.total());
    progress.reset();

    ignore_interrupts();
    if (result.rays.camera == 0) {
        write_trace(out, devices, trace);
        log_warning("stopped before the first sample: no picture is written");
        return ExitCode::interrupted;
    }
    write_outputs(out, scene, devices, trace, result, options.portable, seconds, run);
    if (result.complete) return ExitCode::ok;
    log_warning("stopped early: the picture is saved with the samples it has");
    return ExitCode::interrupted;
}

}  // namespace

void add_render_command(CLI::App& app, ExitCode& exit_code) {
    CLI::App* command = app.add_subcommand("render", "Render a scene with ray-traced obscurances");
    const auto options = add_render_options(*command);
    const auto out = add_output_options(*command);
    command->callback([options, out, &exit_code] { exit_code = run_render(*options, *out); });
}

}  // namespace obscura
