// SPDX-License-Identifier: Apache-2.0
#include "cli/sweep_report.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <utility>

#include "base/units.h"
#include "reference/accumulator.h"
#include "reference/sweep_reference.h"

namespace obscura {
namespace {

constexpr const char* DIFFUSE = reference::DIFFUSE_LAYER;

std::string title(const std::string& layer) {
    return layer.empty() ? "beauty" : layer;
}

// A layer's figures by name: the columns of the CSV, the keys of the JSON.
std::vector<std::pair<std::string, double>> figures(const LayerSummary& layer) {
    std::vector<std::pair<std::string, double>> named;
    const auto add = [&](const std::string& name, const Estimate& estimate) {
        named.insert(
            named.end(),
            {{name, estimate.value}, {name + "_low", estimate.low}, {name + "_high", estimate.high}});
    };
    add("rmse", layer.rmse);
    add("relmse", layer.relmse);
    add("mape", layer.mape);
    add("bias", layer.bias);
    named.emplace_back("bias_standard_error", layer.bias_standard_error);
    add("rms_bias", layer.rms_bias);
    add("variance", layer.variance);
    add("relative_rms_bias", layer.relative_rms_bias);
    add("relative_variance", layer.relative_variance);
    named.emplace_back("efficiency", layer.efficiency);
    named.emplace_back("reference_share", layer.reference_share);
    return named;
}

// JSON has neither NaN nor infinity: what can't be told is null.
Json number(double value) {
    return std::isfinite(value) ? Json(value) : Json();
}

Json to_json(const LayerSummary& layer) {
    Json json;
    for (const auto& [name, value] : figures(layer))
        json[name] = number(value);
    return json;
}

Json to_json(const CellSummary& cell) {
    Json json{{"budget", cell.budget},
              {"samples_per_pixel", cell.samples},
              {"runs", cell.runs},
              {"seconds", cell.seconds.median},
              {"seconds_min", cell.seconds.min},
              {"seconds_max", cell.seconds.max},
              {"rays", cell.rays}};
    json.update(to_json(cell.layers.at("")));
    for (const auto& [layer, summary] : cell.layers)
        if (!layer.empty()) json["layers"][layer] = to_json(summary);
    return json;
}

Json to_json(const std::optional<Estimate>& exponent) {
    if (!exponent) return {};
    return {{"exponent", exponent->value}, {"low", number(exponent->low)}, {"high", number(exponent->high)}};
}

Json to_json(const Overtaking& overtaking) {
    const auto optional = [](const std::optional<double>& x) { return x ? number(*x) : Json(); };
    return {{"floor", number(overtaking.floor.value)},
            {"floor_low", number(overtaking.floor.low)},
            {"floor_high", number(overtaking.floor.high)},
            {"path_better_after_seconds", optional(overtaking.seconds)},
            {"path_better_after_rays", optional(overtaking.rays)}};
}

std::string interval_text(const std::optional<Estimate>& e) {
    if (!e) return "within the reference's noise";
    if (std::isnan(e->low)) return fmt::format("{:6.3f}", e->value);
    return fmt::format("{:6.3f} ({:6.3f} to {:6.3f})", e->value, e->low, e->high);
}

// Column by column: budget in obscurance rays per pixel, spp, median seconds, rays, RMSE of the layers; then of the diffuse
// light bias, its standard error, RMS bias and efficiency.
void print_errors(const SweepReport& report) {
    fmt::print("{:<12} {:>6} {:>4} {:>9} {:>8}  {:>9} {:>9} {:>10}  {:>9} {:>8} {:>9} {:>10}\n", "", "", "",
               "", "", "RMSE of", "", "", "bias of", "standard", "", "");
    fmt::print("{:<12} {:>6} {:>4} {:>9} {:>8}  {:>9} {:>9} {:>10}  {:>9} {:>8} {:>9} {:>10}\n", "method",
               "budget", "spp", "seconds", "rays", "beauty", "diffuse", "obscurance", "diffuse", "error",
               "RMS bias", "1/(MSE s)");
    for (const MethodSummary& method : report.methods) {
        for (const CellSummary& cell : method.cells) {
            const auto rmse = [&](const char* layer) {
                const auto found = cell.layers.find(layer);
                return found == cell.layers.end() ? std::string("-")
                                                  : fmt::format("{:.5f}", found->second.rmse.value);
            };
            const LayerSummary& diffuse = cell.layers.at(DIFFUSE);
            fmt::print(
                "{:<12} {:>6} {:>4} {:>9.4f} {:>8}  {:>9} {:>9} {:>10}  {:>9.2g} {:>8.2g} {:>9.5f} "
                "{:>10.4g}\n",
                method.method.name, cell.budget, cell.samples, cell.seconds.median, si_count(cell.rays),
                rmse(""), rmse(DIFFUSE), rmse("obscurance"), diffuse.bias.value, diffuse.bias_standard_error,
                diffuse.rms_bias.value, diffuse.efficiency);
        }
    }
    fmt::print(
        "Diffuse: the picture without lights and sky, seen as they are or mirrored. Samplers and splits are "
        "measured\n"
        "against the reference of their own model, models against path tracing. RMS bias: what would be left "
        "with any\n"
        "number of samples.\n\n");
}

void print_convergence(const SweepReport& report) {
    fmt::print("{:<12} {:<10}  {:<28}  {:<28}\n", "RMSE falls", "layer", "as rays to the power",
               "as seconds to the power");
    for (const MethodSummary& method : report.methods) {
        for (const auto& [layer, fit] : method.convergence)
            fmt::print("{:<12} {:<10}  {:<28}  {:<28}\n", method.method.name, title(layer),
                       interval_text(fit.by_rays), interval_text(fit.by_seconds));
    }
    fmt::print("\n");
}

void print_ratios(const SweepReport& report) {
    const std::vector<VarianceRatio> ratios = variance_ratios(report.methods);
    if (ratios.empty()) return;
    fmt::print("Variance of random points over that of\n");
    for (const VarianceRatio& r : ratios)
        fmt::print("{:<12} {:<10}  {:>4} rays per pixel  {:6.2f}\n", r.method, title(r.layer), r.budget,
                   r.ratio);
    fmt::print("\n");
}

void print_overtakings(const SweepReport& report) {
    const std::vector<Overtaking> overtakings = find_overtakings(report.methods);
    if (overtakings.empty()) return;
    const auto text = [](const std::optional<double>& x, const auto& format) {
        return x ? format(*x) : std::string("unknown");
    };
    fmt::print("{:<12}  {:<28}  path tracing is better from\n", "model", "relative RMSE that is left");
    for (const Overtaking& o : overtakings) {
        fmt::print("{:<12}  {:<28}  {}, {} rays\n", o.method, interval_text(o.floor),
                   text(o.seconds, duration_text), text(o.rays, si_count));
    }
    fmt::print(
        "Path tracing on the host in double precision. From a power law of its error, beyond what was "
        "measured.\n");
}

}  // namespace

Json to_json(const SweepReport& report) {
    Json json = report.settings;
    json["seeds"] = report.seeds;
    json["complete"] = report.complete;
    json["references"] = report.references;
    json["methods"] = Json::object();
    for (const MethodSummary& method : report.methods) {
        const std::string& name = method.method.name;
        for (const CellSummary& cell : method.cells)
            json["methods"][name].push_back(to_json(cell));
        json["meaning"][name] = method.method.meaning;
        json["measured_against"][name] = integrator_name(method.method.reference);
        for (const auto& [layer, fit] : method.convergence)
            json["convergence"][name][title(layer)] = {{"rays", to_json(fit.by_rays)},
                                                       {"seconds", to_json(fit.by_seconds)}};
    }
    for (const Overtaking& overtaking : find_overtakings(report.methods))
        json["overtaking"][overtaking.method] = to_json(overtaking);
    for (const VarianceRatio& r : variance_ratios(report.methods))
        json["variance_ratio_to_random"][r.method].push_back(
            {{"budget", r.budget}, {"layer", title(r.layer)}, {"ratio", number(r.ratio)}});
    return json;
}

std::string csv_text(const SweepReport& report) {
    std::string text = "method,budget,samples_per_pixel,runs,seconds,seconds_min,seconds_max,rays,layer";
    for (const auto& [name, value] : figures({}))
        text += "," + name;
    text += "\n";
    for (const MethodSummary& method : report.methods) {
        for (const CellSummary& cell : method.cells) {
            for (const auto& [layer, summary] : cell.layers) {
                fmt::format_to(std::back_inserter(text), "{},{},{},{},{:.6g},{:.6g},{:.6g},{:.0f},{}",
                               method.method.name, cell.budget, cell.samples, cell.runs, cell.seconds.median,
                               cell.seconds.min, cell.seconds.max, cell.rays, title(layer));
                for (const auto& [name, value] : figures(summary))
                    text += std::isfinite(value) ? fmt::format(",{:.6g}", value) : ",";
                text += "\n";
            }
        }
    }
    return text;
}

void print_tables(const SweepReport& report) {
    print_errors(report);
    print_convergence(report);
    print_ratios(report);
    print_overtakings(report);
}

}  // namespace obscura
