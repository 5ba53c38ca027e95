// SPDX-License-Identifier: Apache-2.0
// See bench.h.
#include "cli/bench.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

#include "base/file.h"
#include "base/log.h"
#include "base/progress.h"
#include "cli/bench_report.h"
#include "cli/interrupt.h"
#include "cli/output_paths.h"
#include "cli/render_options.h"
#include "scene/gltf.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

struct BenchOptions {
    std::string json;
    std::string rays;
};

SceneBench run_scene(const RenderOptions& options, const Scene& scene, Device& device, RayDump* dump) {
    ProgramLibrary library(device, options.local_size);
    Progress progress("bench", "ray");
    uint64_t traced = 0;
    const RenderJob job{
        scene, settings_of(options), {}, parse_bytes(options.memory), options.wave_size, options.portable};
    SceneBench result = bench_scene(device, library, job, dump, [&](double fraction, uint64_t rays) {
        traced = rays;
        progress.update(fraction, rays);
        return !is_interrupted();
    });
    progress.finish(traced);
    return result;
}

ExitCode run_bench(const RenderOptions& options, const BenchOptions& bench) {
    set_quiet(options.quiet);
    check_outputs({{"--json", bench.json}, {"--dump-rays", bench.rays}}, {options.scene});
    if (bench.rays == "-") throw InputError("--dump-rays -: rays are written to files only");
    const fs::path file = find_scene_file(options.scene);
    const Scene scene = load_gltf(file);
    Device device = open_device(options.device);
    catch_interrupts();
    SceneBench result;
    if (bench.rays.empty()) {
        result = run_scene(options, scene, device, nullptr);
    } else {
        write_atomically(bench.rays, [&](const fs::path& path) {
            RayDump dump(path, bench.rays, scene);
            result = run_scene(options, scene, device, &dump);
            dump.close();
        });
    }
    if (!result.is_timed() && !result.complete) {
        log_warning("stopped before the first rays were timed: there are no figures");
        return ExitCode::interrupted;
    }
    report_bench(result, scene, device.info(), bench.json);
    if (!std::ranges::all_of(result.queues, &QueueBench::agrees)) return ExitCode::check_failed;
    if (result.complete) return ExitCode::ok;
    log_warning("stopped early: the figures are those of the rays until then");
    return ExitCode::interrupted;
}

}  // namespace

void add_bench_command(CLI::App& app, ExitCode& exit_code) {
    CLI::App* command = app.add_subcommand(
        "bench", "Rays per second of every queue of a render, beside Embree on the same rays and threads");
    const auto options = add_render_options(*command);
    const auto bench = std::make_shared<BenchOptions>();
    const char* group = "Bench";
    command->add_option("--json", bench->json, "Write the numbers to a file (- for standard output)")
        ->type_name("FILE.json|-")
        ->group(group);
    command
        ->add_option("--dump-rays", bench->rays,
                     "Write the triangles, the rays and their hits; the README has the layout")
        ->type_name("FILE")
        ->group(group);
    command->footer(fmt::format(
        "Up to {} waves of the render, spread evenly, are replayed: first through each mode of Embree to "
        "find\n"
        "the best, then {} times in turns with the kernels. It takes minutes; use an idle machine.",
        BENCH_WAVES, BENCH_PAIRS));
    command->callback([options, bench, &exit_code] { exit_code = run_bench(*options, *bench); });
}

}  // namespace obscura
