// SPDX-License-Identifier: Apache-2.0
#include "cli/reference.h"

#include <CLI/CLI.hpp>
#include <array>
#include <memory>
#include <optional>
#include <string>

#include "base/log.h"
#include "base/progress.h"
#include "base/units.h"
#include "cli/choice_option.h"
#include "cli/interrupt.h"
#include "cli/output_paths.h"
#include "cli/picture_output.h"
#include "cli/render_options.h"
#include "cli/validators.h"
#include "film/attributes.h"
#include "reference/reference_render.h"
#include "scene/gltf.h"

namespace obscura {
namespace {

using reference::IntegratorKind;

constexpr uint32_t MAX_SETS = 1u << 20;

// What shapes obscurances, or leaves out a part of the light, is nothing to a path tracer of all light. Its paths have no
// end but roulette.
constexpr std::array NOT_OF_PATHS = {
    "--obscurance-rays", "--rho",           "--dmax",      "--ambient",     "--bleeding",  "--ambient-light",
    "--ambient-scale",   "--no-obscurance", "--no-direct", "--no-specular", "--max-depth", "--roulette"};

struct ReferenceOptions {
    std::string output;
    IntegratorKind integrator = IntegratorKind::obscurance;
    uint32_t sets = 16;
    bool resume = false;
};

void check_integrator(const CLI::App& command, const ReferenceOptions& options) {
    if (options.integrator != IntegratorKind::path) return;
    for (const char* name : NOT_OF_PATHS) {
        if (command.count(name) > 0)
            throw InputError("{} says nothing to --integrator path, which traces all light", name);
    }
}

bool is_complete(const Image& picture) {
    const auto found = picture.attributes.find(attribute::COMPLETE);
    return found != picture.attributes.end() && attribute_text(found->second) == "yes";
}

ExitCode run_reference(const CLI::App& command, const RenderOptions& options, const ReferenceOptions& own) {
    set_quiet(options.quiet);
    check_integrator(command, own);
    const std::filesystem::path scene_file = find_scene_file(options.scene);
    check_outputs({{"--output", own.output, ".exr"}}, {scene_file.string()});
    const RenderSettings settings = settings_of(options);
    const std::optional<Image> previous = own.resume ? std::optional(read_exr(own.output)) : std::nullopt;
    const Scene scene = load_gltf(scene_file);
    catch_interrupts();
    log_info("{}: {}, {}", scene.name, counted(scene.triangles.size(), "triangle"),
             counted(scene.objects.size(), "object"));
    const std::string previous_name = "--resume: " + own.output;
    const reference::ReferenceJob job{
        scene, settings, own.integrator, own.sets, previous ? &*previous : nullptr, previous_name};
    Progress progress("reference", "path");
    const reference::ReferenceResult result = render_reference(job, [&](double fraction, uint64_t samples) {
        progress.update(fraction, samples);
        return !is_interrupted();
    });
    if (result.image.layers.empty()) {
        log_warning("stopped before every pixel had a sample: nothing is written");
        return ExitCode::interrupted;
    }
    if (previous && is_complete(*previous) && result.complete && result.samples == 0) {
        log_info("{} is complete already: it has all samples of --sets {}", own.output, own.sets);
        return ExitCode::ok;
    }
    progress.finish(result.samples);
    ignore_interrupts();
    save_picture(result.image, own.output, false);
    log_info("wrote {}", own.output);
    if (result.image.find_layer("Variance") == nullptr)
        log_warning("there is no layer Variance: it takes two finished sets of samples");
    if (result.complete) return ExitCode::ok;
    log_warning("stopped early: the picture is saved with the samples it has; --resume goes on with it");
    return ExitCode::interrupted;
}

}  // namespace

void add_reference_command(CLI::App& app, ExitCode& exit_code) {
    CLI::App* command = app.add_subcommand(
        "reference",
        "Compute a picture on the CPU in double precision, with the variance of each pixel's mean");
    const auto options = add_host_options(*command);
    const auto own = std::make_shared<ReferenceOptions>();
    const char* group = "Output";
    command->add_option("-o,--output,--outfile", own->output, "The picture with its variance (EXR)")
        ->required()
        ->check(not_empty())
        ->type_name("X.exr")
        ->group(group);
    command
        ->add_flag("--resume", own->resume, "Go on with the picture that is there, to the number of --sets")
        ->group(group);
    add_choice<IntegratorKind>(*command, "--integrator", own->integrator,
                               {{"obscurance", IntegratorKind::obscurance}, {"path", IntegratorKind::path}},
                               "The model of obscura render, or path tracing of all light")
        ->default_str("obscurance")
        ->group("Reference");
    command
        ->add_option("--sets", own->sets,
                     "Independent sets of --spp samples, with the seeds --seed, --seed + 1 ...")
        ->check(whole_number(1, MAX_SETS))
        ->capture_default_str()
        ->group("Reference");
    command->callback(
        [command, options, own, &exit_code] { exit_code = run_reference(*command, *options, *own); });
}

}  // namespace obscura
