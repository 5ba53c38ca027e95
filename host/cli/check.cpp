// SPDX-License-Identifier: Apache-2.0
// See check.h.
#include "cli/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/log.h"
#include "base/progress.h"
#include "cli/interrupt.h"
#include "cli/json_output.h"
#include "cli/output_paths.h"
#include "cli/render_options.h"
#include "reference/check.h"
#include "reference/ray_replay.h"
#include "reference/ray_text.h"
#include "reference/self_test.h"
#include "scene/gltf.h"

namespace obscura {
namespace {

struct CheckOptions {
    std::string json;
    std::vector<long double> ray;  // as ray_of_numbers() takes it
    bool self_test = false;
    std::string only;  // cases of the self-test
};

Json to_json(const HitTally& tally) {
    return {{"rays", tally.rays},
            {"hits", tally.hits},
            {"device_wrong", tally.device_wrong},
            {"embree_wrong", tally.embree_wrong},
            {"ties", tally.ties},
            {"edges", tally.edges},
            {"judged", tally.judged},
            {"distance_error_of_bound", tally.distance_share},
            {"weight_error_of_bound", tally.weight_share},
            {"distance_error_relative", tally.distance_relative},
            {"distance_error_ulps", tally.distance_ulps}};
}

// What was checked, and how to tell it.
struct Checked {
    std::vector<QueueCheck> rows;
    bool is_self_test;  // the rows are its cases, else queues
    uint64_t rendered_rays;
    const Scene& scene;     // whose frame the rays are in
    const char* all_right;  // the verdict

    const char* title() const { return is_self_test ? "cases" : "queues"; }
};

// All rows together.
QueueCheck sum(const std::vector<QueueCheck>& rows) {
    QueueCheck all{"all", {}, {}, true};
    for (const QueueCheck& row : rows)
        all.rays.add(row.rays);
    return all;
}

Json to_json(const Checked& checked) {
    const std::vector<QueueCheck>& rows = checked.rows;
    Json json = to_json(sum(rows).rays);
    json["rendered_rays"] = checked.rendered_rays;
    json["passed"] = std::ranges::all_of(rows, &QueueCheck::passes);
    for (const QueueCheck& row : rows) {
        Json numbers = to_json(row.rays);
        if (row.results.checked > 0) {
            numbers["results"] = {{"checked", row.results.checked},
                                  {"behind_panes", row.results.behind_panes},
                                  {"error_of_bound", row.results.worst_share},
                                  {"error", row.results.worst}};
        }
        numbers["disagreements"] = Json::array();
        for (const Disagreement& ray : row.rays.disagreements) {
            numbers["disagreements"].push_back({{"outcome", outcome_text(ray.outcome)},
                                                {"ray", ray_text(checked.scene, ray.ray)},
                                                {"device", ray.device},
                                                {"expected", ray.expected}});
        }
        json[checked.title()][row.name] = std::move(numbers);
    }
    return json;
}

void print_table(const std::vector<QueueCheck>& rows, const std::string& title) {
    size_t width = title.size();
    for (const QueueCheck& row : rows)
        width = std::max(width, row.name.size());
    fmt::print("{:<{}}  {:>10}  {:>10}  {:>6}  {:>6}  {:>12}  {:>12}  {:>8}  {:>8}  {:>8}\n", title, width,
               "rays", "hits", "ties", "edges", "Embree wrong", "device wrong", "distance", "weights",
               "results");
    const auto print_row = [&](const QueueCheck& row) {
        const HitTally& rays = row.rays;
        const std::string results =
            row.results.checked > 0 ? fmt::format("{:.3f}", row.results.worst_share) : "";
        fmt::print("{:<{}}  {:>10}  {:>10}  {:>6}  {:>6}  {:>12}  {:>12}  {:>8.3f}  {:>8.3f}  {:>8}\n",
                   row.name, width, rays.rays, rays.hits, rays.ties, rays.edges, rays.embree_wrong,
                   rays.device_wrong, rays.distance_share, rays.weight_share, results);
    };
    std::ranges::for_each(rows, print_row);
    print_row(sum(rows));
    fmt::print("The last three columns: the device's largest error, as a share of what rounding explains.\n");
}

void print_failures(const Checked& checked) {
    for (const QueueCheck& row : checked.rows) {
        if (row.rays.device_wrong == 0 && !row.passes())
            fmt::print("{}: more than {} of the rays are in doubt\n", row.name, MAX_DOUBTFUL_SHARE);
        for (const Disagreement& ray : row.rays.disagreements) {
            const bool is_doubt = ray.outcome == Outcome::tie || ray.outcome == Outcome::edge;
            const bool is_to_blame =
                row.rays.device_wrong > 0 ? ray.outcome == Outcome::device_wrong : is_doubt && !row.passes();
            if (!is_to_blame) continue;
            fmt::print("{}{}: device {}; expected {}\n    {}--ray={}\n", row.name,
                       is_doubt ? ", " + outcome_text(ray.outcome) : "", ray.device, ray.expected,
                       checked.is_self_test ? fmt::format("--case='{}' ", row.name) : "",
                       ray_text(checked.scene, ray.ray));
        }
    }
}

// Table or JSON, and the verdict.
ExitCode report(const CheckOptions& options, const Checked& checked) {
    const bool passed = std::ranges::all_of(checked.rows, &QueueCheck::passes);
    if (options.json.empty()) {
        print_table(checked.rows, checked.title());
        print_failures(checked);
        fmt::print("{}\n", passed ? checked.all_right : "The check failed.");
    } else {
        write_json(options.json, to_json(checked));
    }
    return passed ? ExitCode::ok : ExitCode::check_failed;
}

ExitCode run_ray(const RenderJob& job, const CheckOptions& check, Device& device, ProgramLibrary& library) {
    const Scene& scene = job.scene;
    const GivenRay given = ray_of_numbers(scene, check.ray);
    const RayCheck answer = replay_ray(device, library, job, given);
    fmt::print("device   {}\nEmbree   {}\noracle   {}\nverdict  {}\n", hit_text(scene, answer.device),
               hit_text(scene, answer.embree), hit_text(scene, answer.truth), outcome_text(answer.outcome));
    if (!answer.contradiction.empty()) fmt::print("but      {}: device wrong\n", answer.contradiction);
    if (answer.result) {
        fmt::print("{}\ndevice   {}\nexpected {}\nverdict  {}\n",
                   given.start ? "What it brings back as an obscurance ray:"
                               : "Light that comes through, as for a shadow ray:",
                   result_text(answer.result->given), result_text(answer.result->expected),
                   outcome_text(answer.result->outcome));
    }
    return answer.is_device_wrong() ? ExitCode::check_failed : ExitCode::ok;
}

ExitCode run_scene(const RenderJob& job, const CheckOptions& check, Device& device, ProgramLibrary& library) {
    const Scene& scene = job.scene;
    catch_interrupts();
    Progress progress("check", "ray");
    const SceneCheck result = check_scene(device, library, job, [&](double fraction, const RayCounts& rays) {
        progress.update(fraction, rays.total());
        return !is_interrupted();
    });
    progress.finish(result.rendered.total());
    const char* const all_right =
        scene.triangles.empty() ? "Nothing was checked: the scene holds no triangles." : "No hit is wrong.";
    const ExitCode exit_code = report(
        check,
        {{result.queues.begin(), result.queues.end()}, false, result.rendered.total(), scene, all_right});
    if (!is_interrupted()) return exit_code;
    log_warning("stopped early: the rays so far were checked");
    return exit_code == ExitCode::ok ? ExitCode::interrupted : exit_code;
}

ExitCode run_self_test(const RenderOptions& options, const CheckOptions& check) {
    Device device = open_device(options.device);
    ProgramLibrary library(device, options.local_size);
    if (check.ray.empty()) {
        const Scene unmoved;
        std::vector<QueueCheck> rows = self_test(device, library, options.portable, check.only);
        if (rows.empty()) throw InputError("--case {}: no case of the self-test has such a name", check.only);
        const uint64_t rays = sum(rows).rays.rays;
        return report(check, {std::move(rows), true, rays, unmoved, "No hit is wrong."});
    }
    if (check.only.empty()) throw InputError("--self-test with --ray needs --case NAME");
    ExitCode exit_code = ExitCode::ok;
    const auto replay = [&](const Scene& scene, const RenderSettings& settings) {
        RenderJob job{scene, settings, {}};
        job.portable = options.portable;
        exit_code = run_ray(job, check, device, library);
    };
    if (!with_self_test_case(check.only, replay))
        throw InputError("--case {}: with --ray, the whole name of a case of the self-test", check.only);
    return exit_code;
}

ExitCode run_check(const RenderOptions& options, const CheckOptions& check) {
    set_quiet(options.quiet);
    if (check.self_test != options.scene.empty())
        throw InputError(check.self_test ? "--self-test takes no scene"
                                         : "A scene is needed, or --self-test");
    check_outputs({{"--json", check.json}}, {options.scene});
    if (check.self_test) return run_self_test(options, check);
    const std::filesystem::path file = find_scene_file(options.scene);
    const Scene scene = load_gltf(file);
    Device device = open_device(options.device);
    ProgramLibrary library(device, options.local_size);
    const RenderJob job{
        scene, settings_of(options), {}, parse_bytes(options.memory), options.wave_size, options.portable};
    return check.ray.empty() ? run_scene(job, check, device, library) : run_ray(job, check, device, library);
}

}  // namespace

void add_check_command(CLI::App& app, ExitCode& exit_code) {
    CLI::App* command = app.add_subcommand(
        "check", "Check every ray of a render against Embree and an oracle; exit code 1 if one is wrong");
    const auto options = add_render_options(*command);
    command->get_option("scene")->required(false);
    const auto check = std::make_shared<CheckOptions>();
    const char* group = "Check";
    CLI::Option* const self_test =
        command->add_flag("--self-test", check->self_test, "Check built-in hard geometry instead of a scene")
            ->group(group);
    command->add_option("--case", check->only, "Only the cases of the self-test whose name contains this")
        ->needs(self_test)
        ->group(group);
    CLI::Option* const ray =
        command
            ->add_option(
                "--ray", check->ray,
                "Check one ray as check prints it: origin (the file's coordinates, m), direction, reach in "
                "directions, of an obscurance ray also the origin minus its point")
            ->delimiter(',')
            ->expected(7, 10)
            ->type_name("X,Y,Z,DX,DY,DZ,T[,SX,SY,SZ]")
            ->group(group);
    command->add_option("--json", check->json, "Write the numbers to a file (- for standard output)")
        ->type_name("FILE.json|-")
        ->excludes(ray)
        ->group(group);
    command->callback([options, check, &exit_code] { exit_code = run_check(*options, *check); });
}

}  // namespace obscura
