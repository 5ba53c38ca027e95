// SPDX-License-Identifier: Apache-2.0
// Reads two images, checks that they can be compared, and reports as a table or as JSON. The headline numbers
// are those of one layer: the chosen one, else beauty, else the first.
#include "cli/compare.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/log.h"
#include "base/units.h"
#include "cli/json_output.h"
#include "cli/output_paths.h"
#include "cli/validators.h"
#include "film/attributes.h"
#include "film/image.h"
#include "film/metrics.h"

namespace obscura {
namespace {

const std::map<std::string, Metric> METRICS = {
    {"rmse", Metric::rmse}, {"relmse", Metric::relmse}, {"mape", Metric::mape}, {"max_abs", Metric::max_abs}};

constexpr const char* ALL_LAYERS = "all";

struct CompareOptions {
    std::string image;
    std::string reference;
    std::string layer = ALL_LAYERS;
    std::string metric = "rmse";
    double bound = 0;
    std::string heat_map;
    std::string json;
};

// What was compared and what came of it.
struct Verdict {
    ImageDifference difference;
    size_t headline = 0;  // the layer whose numbers stand for the image: the chosen one, beauty, or the first
    bool same_channels = true;
    bool identical = true;
    bool within_bound = true;
};

std::string attribute_or_none(const Image& image, const char* name) {
    const auto found = image.attributes.find(name);
    return found == image.attributes.end() ? "not known" : attribute_text(found->second);
}

void check_comparable(const CompareOptions& options, const Image& image, const Image& reference) {
    if (image.full_width != reference.full_width || image.full_height != reference.full_height) {
        throw InputError("{}: it is {} x {} pixels, but {} is {} x {}", options.image, image.full_width,
                         image.full_height, options.reference, reference.full_width, reference.full_height);
    }
    if (image.x0 != reference.x0 || image.x1 != reference.x1 || image.y0 != reference.y0 ||
        image.y1 != reference.y1) {
        throw InputError("{}: it holds the crop [{}, {}) x [{}, {}), but {} holds [{}, {}) x [{}, {})",
                         options.image, image.x0, image.x1, image.y0, image.y1, options.reference,
                         reference.x0, reference.x1, reference.y0, reference.y1);
    }
    for (const char* name : {attribute::SPP, attribute::SEED}) {
        const std::string a = attribute_or_none(image, name);
        const std::string b = attribute_or_none(reference, name);
        if (a == b) continue;
        log_warning("The images were made with different settings: {} is {} in {} and {} in {}.", name, a,
                    options.image, b, options.reference);
    }
}

void warn_of_missing(const std::vector<std::string>& channels, const std::string& owner) {
    if (channels.empty()) return;
    log_warning("Only {} has the {} {}, left out of the comparison.", owner,
                plural(channels.size(), "channel"), fmt::join(channels, " "));
}

// Drops all layers but the chosen one. Beauty loses its name: it is compared whatever the two files call it.
void keep_layer(Image& image, const std::string& title, const std::string& file) {
    std::vector<std::string> titles;
    for (const Layer& layer : image.layers)
        titles.push_back(layer.title());
    auto chosen = std::ranges::find(image.layers, title, &Layer::title);
    if (chosen == image.layers.end() && title == "beauty")
        chosen = std::ranges::find(image.layers, BLENDER_BEAUTY, &Layer::name);
    if (chosen == image.layers.end()) {
        throw InputError("{}: it has no layer {}, only {}", file, title, fmt::join(titles, ", "));
    }
    const bool is_beauty = &*chosen == image.beauty();
    Layer kept = std::move(*chosen);
    if (is_beauty) kept.name.clear();
    image.layers.clear();
    image.layers.push_back(std::move(kept));
}

Verdict judge(const CompareOptions& options, const Image& image, const Image& reference) {
    Verdict verdict{compare_images(image, reference)};
    warn_of_missing(verdict.difference.only_in_image, options.image);
    warn_of_missing(verdict.difference.only_in_reference, options.reference);
    const auto& layers = verdict.difference.layers;
    if (layers.empty()) {
        throw InputError("{}: it has no channel in common with {}", options.image, options.reference);
    }
    verdict.same_channels =
        verdict.difference.only_in_image.empty() && verdict.difference.only_in_reference.empty();
    verdict.identical = verdict.same_channels;
    // What only one has is beyond any bound, unless a layer was chosen: then what both have of it counts.
    verdict.within_bound = verdict.same_channels || (options.layer != ALL_LAYERS && options.bound > 0);
    const Metric metric = METRICS.at(options.metric);
    const Layer* const beauty = reference.beauty();
    for (size_t i = 0; i < layers.size(); ++i) {
        if (beauty != nullptr && layers[i].title == beauty->title()) verdict.headline = i;
        verdict.identical = verdict.identical && layers[i].identical;
        verdict.within_bound = verdict.within_bound && layers[i].is_within(metric, options.bound);
    }
    return verdict;
}

Json numbers(const LayerDifference& layer) {
    return {{"identical", layer.identical},
            {"max_abs", layer.max_abs},
            {"rmse", layer.rmse},
            {"relmse", layer.relmse},
            {"mape", layer.mape},
            {"mse", layer.mse},
            {"bias", layer.bias},
            {"pixels", layer.pixel_count},
            {"values", layer.value_count},
            {"differing_pixels", layer.differing_pixel_count},
            {"not_finite", layer.not_finite_count}};
}

Json to_json(const CompareOptions& options, const Verdict& verdict) {
    const auto& layers = verdict.difference.layers;
    Json json = numbers(layers[verdict.headline]);
    json["identical"] = verdict.identical;
    json["layer"] = layers[verdict.headline].title;
    json["metric"] = options.metric;
    json["bound"] = options.bound;
    json["within_bound"] = verdict.within_bound;
    for (const LayerDifference& layer : layers)
        json["layers"][layer.title] = numbers(layer);
    json["only_in_image"] = verdict.difference.only_in_image;
    json["only_in_reference"] = verdict.difference.only_in_reference;
    return json;
}

std::string conclusion(const CompareOptions& options, const Verdict& verdict) {
    if (verdict.identical) return "The images are bit-identical.";
    if (!verdict.same_channels && !verdict.within_bound)
        return "The images differ: they have different channels.";
    if (options.bound == 0) return "The images differ.";
    return fmt::format("The images differ, {} the bound: {} at most {} in every layer.",
                       verdict.within_bound ? "within" : "beyond", options.metric, options.bound);
}

void print_table(const CompareOptions& options, const Verdict& verdict) {
    const auto& layers = verdict.difference.layers;
    size_t width = 5;
    for (const LayerDifference& layer : layers)
        width = std::max(width, layer.title.size());
    fmt::print("{:<{}}  identical  {:>10}  {:>10}  {:>10}  {:>10}  not finite\n", "layer", width, "max_abs",
               "rmse", "relmse", "mape");
    for (const LayerDifference& layer : layers) {
        fmt::print("{:<{}}  {:>9}  {:>10.4g}  {:>10.4g}  {:>10.4g}  {:>10.4g}  {:>10}\n", layer.title, width,
                   layer.identical ? "yes" : "no", layer.max_abs, layer.rmse, layer.relmse, layer.mape,
                   layer.not_finite_count);
    }
    fmt::print("{}\n", conclusion(options, verdict));
}

ExitCode run_compare(const CompareOptions& options) {
    check_outputs({{"--heatmap", options.heat_map, ".png"}, {"--json", options.json}},
                  {options.image, options.reference});
    Image image = read_exr(options.image);
    Image reference = read_exr(options.reference);
    check_comparable(options, image, reference);
    if (options.layer != ALL_LAYERS) {
        keep_layer(image, options.layer, options.image);
        keep_layer(reference, options.layer, options.reference);
    }
    const Verdict verdict = judge(options, image, reference);
    if (!options.heat_map.empty()) {
        const std::string title = verdict.difference.layers[verdict.headline].title;
        write_heat_map_png(image, reference, title == "beauty" ? "" : title, options.heat_map);
    }
    if (options.json.empty()) {
        print_table(options, verdict);
    } else {
        write_json(options.json, to_json(options, verdict));
    }
    return verdict.within_bound ? ExitCode::ok : ExitCode::check_failed;
}

}  // namespace

void add_compare_command(CLI::App& app, ExitCode& exit_code) {
    const auto options = std::make_shared<CompareOptions>();
    CLI::App* command = app.add_subcommand(
        "compare", "Measure how far an image is from a reference; exit code 0 within the bound, 1 beyond it");
    command->add_option("image", options->image, "The image (EXR)")->required()->type_name("X.exr");
    command->add_option("reference", options->reference, "The reference (EXR)")
        ->required()
        ->type_name("X.exr");
    command
        ->add_option("--layer", options->layer, "A layer's name, beauty, or all, which both images must have")
        ->type_name("NAME")
        ->capture_default_str();
    command->add_option("--metric", options->metric, "What the bound limits: rmse, relmse, mape or max_abs")
        ->check(CLI::IsMember(METRICS))
        ->capture_default_str();
    command->add_option("--bound", options->bound, "The largest error allowed; 0 asks for identical bits")
        ->check(number_between(0, static_cast<double>(std::numeric_limits<float>::max())))
        ->capture_default_str();
    command->add_option("--heatmap", options->heat_map, "Write the relative error per pixel as PNG")
        ->type_name("X.png");
    command->add_option("--json", options->json, "Write the numbers to a file (- for standard output)")
        ->type_name("FILE.json|-");
    command->callback([options, &exit_code] { exit_code = run_compare(*options); });
}

}  // namespace obscura
