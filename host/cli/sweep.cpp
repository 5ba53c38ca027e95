// SPDX-License-Identifier: Apache-2.0
// See sweep.h.
#include "cli/sweep.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <set>
#include <string>

#include "base/file.h"
#include "base/log.h"
#include "base/progress.h"
#include "base/stopwatch.h"
#include "base/units.h"
#include "cli/interrupt.h"
#include "cli/output_paths.h"
#include "cli/render_options.h"
#include "cli/sweep_record.h"
#include "cli/sweep_report.h"
#include "cli/validators.h"
#include "film/attributes.h"
#include "reference/sweep_reference.h"
#include "scene/gltf.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;
using reference::IntegratorKind;

// What each method sets by itself, and what leaves a part of the light out.
constexpr std::array NOT_OF_SWEEPS = {"--spp",           "--obscurance-rays", "--sampler",
                                      "--ambient",       "--bleeding",        "--needs",
                                      "--no-obscurance", "--no-direct",       "--no-specular"};

struct SweepOptions {
    std::string output;
    std::string references;
    std::string json;
    std::vector<std::string> methods;
    uint32_t budgets = 6;
    uint32_t seeds = 10;
};

// Everything that shapes errors or times.
Json describe_sweep(const RenderOptions& options, const SweepOptions& own, const RenderSettings& s,
                    const Scene& scene, const DeviceInfo& device) {
    const auto rgb = [](const std::optional<Rgb>& color) {
        return color ? Json{color->x, color->y, color->z} : Json();
    };
    return {{"version", OBSCURA_VERSION},
            {"scene", scene.name},
            {"triangles", scene.triangles.size()},
            {"width", s.width},
            {"height", s.height},
            {"cropwindow", {s.crop.x0, s.crop.x1, s.crop.y0, s.crop.y1}},
            {"camera", s.camera},
            {"filter", static_cast<uint32_t>(s.filter)},
            {"rho", falloff_text(s.falloff)},
            {"dmax", max_distance_text(s.d_max)},
            {"background", rgb(s.background)},
            {"ambient_light", rgb(s.ambient_light)},
            {"ambient_scale", s.ambient_scale},
            {"light_samples", s.light_samples},
            {"max_depth", s.max_depth},
            {"roulette", s.roulette},
            {"seed", s.seed},
            {"budgets", own.budgets},
            {"device", device.name},
            {"driver", device.driver_version},
            {"platform", device.platform_version},
            {"compute_units", device.compute_units},
            {"memory", options.memory},
            {"wave_size", options.wave_size},
            {"local_size", options.local_size},
            {"portable_kernels", options.portable}};
}

Json describe_references(const SweepReferences& references) {
    Json json;
    for (const auto& [integrator, reference] : references) {
        const auto& attributes = reference.image.attributes;
        const auto text = [&](const char* name) { return attribute_text(attributes.at(name)); };
        Json& entry = json[integrator_name(integrator)];
        entry = {{"samples_per_pixel", std::get<int64_t>(attributes.at(attribute::SPP))},
                 {"independent_sets", std::get<int64_t>(attributes.at(attribute::SETS))},
                 {"seconds", std::get<double>(attributes.at(attribute::SECONDS))},
                 {"tracer", text(attribute::DEVICE)}};
        for (const auto& [layer, noise] : reference.noise)
            entry["standard_error"][layer.empty() ? "beauty" : layer] = std::sqrt(noise.mse);
    }
    return json;
}

class Sweep {
  public:
    Sweep(const RenderOptions& options, const SweepOptions& own, const fs::path& scene_file)
        : options_(options),
          own_(own),
          folder_(own.output.empty() ? fs::path("out") / ("sweep-" + scene_file.stem().string())
                                     : fs::path(own.output)),
          settings_(settings_of(options)),
          methods_(choose_methods(sweep_methods(settings_), own.methods)),
          scene_(load_gltf(scene_file)),
          device_(open_device(options.device)) {}

    ExitCode run();

  private:
    bool make_references();
    bool render_all(SweepRecord& record);
    void save_picture(const SweepTask& task, uint64_t seed, const Image& picture) const;
    void report(const SweepRecord& record, bool complete) const;

    const RenderOptions& options_;
    const SweepOptions& own_;
    fs::path folder_;
    RenderSettings settings_;
    std::vector<SweepMethod> methods_;
    Scene scene_;
    Device device_;
    SweepReferences references_;
};

bool Sweep::make_references() {
    const fs::path folder = own_.references.empty() ? folder_ : fs::path(own_.references);
    make_folder(folder);
    SweepReferenceJob job{scene_, settings_, own_.budgets, IntegratorKind::obscurance, folder};
    std::unique_ptr<MutedWarnings> given_before;
    for (const SweepMethod& method : methods_) {
        job.integrator = method.reference;
        if (references_.contains(job.integrator)) continue;
        const char* name = integrator_name(job.integrator);
        Progress progress(fmt::format("reference {}", name), "path");
        std::optional<SweepReference> made = make_reference(job, [&](double fraction, uint64_t samples) {
            progress.update(fraction, samples);
            return !is_interrupted();
        });
        if (!made) return false;
        write_preview_png(made->image, folder_ / "pictures" / fmt::format("reference-{}.png", name), 0);
        references_[job.integrator] = std::move(*made);
        given_before = std::make_unique<MutedWarnings>();
    }
    return true;
}

void Sweep::save_picture(const SweepTask& task, uint64_t seed, const Image& picture) const {
    if (seed > 0) return;
    write_preview_png(picture, folder_ / "pictures" / fmt::format("{}-{}.png", task.method.name, task.budget),
                      0);
}

bool Sweep::render_all(SweepRecord& record) {
    constexpr double SAVE_SECONDS = 20;
    std::vector<SweepTask> tasks = plan_sweep(methods_, own_.budgets, own_.seeds);
    std::erase_if(tasks, [&](const SweepTask& task) { return record.holds(task); });
    if (tasks.empty()) return true;
    double all = 0, done = 0;
    for (const SweepTask& task : tasks)
        all += task.cost();

    const MutedWarnings given_before;
    ProgramLibrary library(device_, options_.local_size);
    SweepRenderer renderer(
        device_, library,
        {scene_, settings_, {}, parse_bytes(options_.memory), options_.wave_size, options_.portable},
        references_);
    Progress progress("sweep", "picture");
    uint64_t pictures = 0;
    Stopwatch since_save;
    for (const SweepTask& task : tasks) {
        std::optional<SweepResult> result = renderer.run(
            task, [] { return !is_interrupted(); },
            [&](uint64_t seed, const Image& picture) { save_picture(task, seed, picture); });
        if (!result) return false;
        record.add(std::move(*result));
        done += task.cost();
        pictures += task.runs;
        progress.update(done / all, pictures);
        if (since_save.seconds() < SAVE_SECONDS) continue;
        record.save();
        since_save = {};
    }
    progress.finish(pictures);
    return true;
}

void Sweep::report(const SweepRecord& record, bool complete) const {
    const SweepReport report{
        describe_sweep(options_, own_, settings_, scene_, device_.info()), describe_references(references_),
        summarise(methods_, own_.budgets, record.results(), references_), own_.seeds, complete};
    const Json json = to_json(report);
    write_json((folder_ / "sweep.json").string(), json);
    write_text(folder_ / "sweep.csv", csv_text(report));
    if (own_.json.empty()) {
        print_tables(report);
    } else {
        write_json(own_.json, json);
    }
    log_info("wrote {}", (folder_ / "sweep.json").string());
    log_info("wrote {}; tools/report sweep {} makes a page of them", (folder_ / "sweep.csv").string(),
             folder_.string());
}

ExitCode Sweep::run() {
    make_folder(folder_ / "pictures");
    catch_interrupts();
    log_info("{}: {}, {}; device {}", scene_.name, counted(scene_.triangles.size(), "triangle"),
             counted(methods_.size(), "method"), device_.name());
    bool complete = make_references();
    if (complete) {
        Json settings = describe_sweep(options_, own_, settings_, scene_, device_.info());
        settings["scene_digest"] =
            attribute_text(references_.begin()->second.image.attributes.at(attribute::SCENE_DIGEST));
        SweepRecord record(folder_ / "runs.json", std::move(settings));
        complete = render_all(record);
        ignore_interrupts();
        record.save();
        report(record, complete);
    }
    if (complete) return ExitCode::ok;
    log_warning("stopped early: what is done is in {}; the same command goes on with it", folder_.string());
    return ExitCode::interrupted;
}

ExitCode run_sweep(const CLI::App& command, const RenderOptions& options, const SweepOptions& own) {
    set_quiet(options.quiet);
    for (const char* name : NOT_OF_SWEEPS) {
        if (command.count(name) > 0) throw InputError("{}: the methods of a sweep set it themselves", name);
    }
    const fs::path scene_file = find_scene_file(options.scene);
    check_outputs({{"--json", own.json}}, {scene_file.string()});
    return Sweep(options, own, scene_file).run();
}

}  // namespace

void add_sweep_command(CLI::App& app, ExitCode& exit_code) {
    CLI::App* command = app.add_subcommand(
        "sweep", "Error against time and rays: samplers, splits and models with growing budgets");
    const auto options = add_render_options(*command);
    options->settings.width = 200;
    options->settings.height = 150;
    for (const char* name : {"--width", "--height"})
        command->get_option(name)->capture_default_str();
    const auto own = std::make_shared<SweepOptions>();
    const char* group = "Sweep";
    command
        ->add_option(
            "-o,--output", own->output,
            "Folder for results and pictures; an interrupted sweep goes on with it [out/sweep-SCENE]")
        ->type_name("DIR")
        ->group(group);
    command->add_option("--reference-dir", own->references, "Folder of the reference pictures, if another")
        ->type_name("DIR")
        ->group(group);
    command->add_option("--methods", own->methods, "Names of methods, separated by commas; all if not given")
        ->delimiter(',')
        ->group(group);
    command
        ->add_option("--budgets", own->budgets, "Number of budgets: 5, 10, 20 ... obscurance rays per pixel")
        ->check(whole_number(1, 12))
        ->capture_default_str()
        ->group(group);
    command->add_option("--seeds", own->seeds, "Pictures of each method and budget")
        ->check(whole_number(1, 10000))
        ->capture_default_str()
        ->group(group);
    command->add_option("--json", own->json, "Write the numbers to a file too (- for standard output)")
        ->type_name("FILE.json|-")
        ->group(group);
    std::string names;
    for (const SweepMethod& method : sweep_methods({}))
        names += fmt::format("\n  {:<12}{}", method.name, method.meaning);
    command->footer(fmt::format("Methods:{}\nThe methods set these options themselves: {}.", names,
                                fmt::join(NOT_OF_SWEEPS, ", ")));
    command->callback(
        [command, options, own, &exit_code] { exit_code = run_sweep(*command, *options, *own); });
}

}  // namespace obscura
