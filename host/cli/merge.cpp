// SPDX-License-Identifier: Apache-2.0
// Reads all parts, merges, and writes only when everything fits together.
#include "cli/merge.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "base/log.h"
#include "base/units.h"
#include "cli/output_paths.h"
#include "cli/validators.h"
#include "film/image.h"

namespace obscura {
namespace {

struct MergeOptions {
    std::vector<std::string> parts;
    std::string output;
    std::string preview;
    double exposure_stops = 0;
};

ExitCode run_merge(const MergeOptions& options) {
    check_outputs({{"--output", options.output, ".exr"}, {"--preview", options.preview, ".png"}},
                  options.parts);
    std::vector<Image> parts;
    for (const std::string& part : options.parts)
        parts.push_back(read_exr(part));
    const Image merged = merge_images(parts, options.parts);
    write_exr(merged, options.output);
    if (!options.preview.empty()) write_preview_png(merged, options.preview, options.exposure_stops);
    log_info("Merged {} into {} ({} x {} pixels).", counted(parts.size(), "part"), options.output,
             merged.full_width, merged.full_height);
    return ExitCode::ok;
}

}  // namespace

void add_merge_command(CLI::App& app, ExitCode& exit_code) {
    const auto options = std::make_shared<MergeOptions>();
    CLI::App* command =
        app.add_subcommand("merge", "Merge the parts of one picture (crops) into the whole, exactly");
    command->add_option("parts", options->parts, "The parts (EXR)")->required()->type_name("X.exr");
    command->add_option("-o,--output,--outfile", options->output, "The whole picture (EXR)")
        ->required()
        ->check(not_empty())
        ->type_name("X.exr");
    CLI::Option* preview =
        command->add_option("--preview", options->preview, "Write a preview (PNG) too")->type_name("X.png");
    command->add_option("--exposure", options->exposure_stops, "The preview's exposure in stops")
        ->needs(preview)
        ->check(exposure_range())
        ->capture_default_str();
    command->callback([options, &exit_code] { exit_code = run_merge(*options); });
}

}  // namespace obscura
