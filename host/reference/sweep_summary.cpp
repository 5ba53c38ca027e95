// SPDX-License-Identifier: Apache-2.0
#include "reference/sweep_summary.h"

#include "reference/accumulator.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace obscura {
namespace {

const Estimate UNKNOWN{std::nan(""), std::nan(""), std::nan("")};

// The runs of one method and budget, in the order of their seeds.
struct Cell {
    std::vector<const SweepRun*> runs;
    std::vector<const SweepResult*> pairs;  // the results with two runs
};

Cell collect(const std::vector<SweepResult>& results, const std::string& method, uint32_t budget) {
    std::vector<const SweepResult*> found;
    for (const SweepResult& result : results)
        if (result.method == method && result.budget == budget) found.push_back(&result);
    std::ranges::sort(found, {}, &SweepResult::first_seed);
    Cell cell;
    for (const SweepResult* result : found) {
        for (const SweepRun& run : result->runs)
            cell.runs.push_back(&run);
        if (result->runs.size() == 2) cell.pairs.push_back(result);
    }
    return cell;
}

template <typename Item, typename Value>
std::vector<double> values_of(const std::vector<const Item*>& items, const Value& value) {
    std::vector<double> values;
    values.reserve(items.size());
    for (const Item* item : items)
        values.push_back(value(*item));
    return values;
}

std::vector<double> of_runs(const Cell& cell, const std::string& layer, double LayerErrors::*error) {
    return values_of(cell.runs, [&](const SweepRun& run) { return run.errors.at(layer).*error; });
}

Estimate less(const Estimate& estimate, double subtracted) {
    return {estimate.value - subtracted, estimate.low - subtracted, estimate.high - subtracted};
}

LayerSummary summarise_layer(const Cell& cell, const std::string& layer, const ReferenceNoise& noise,
                             double seconds) {
    LayerSummary summary;
    const Estimate mse = estimate_mean(of_runs(cell, layer, &LayerErrors::mse));
    summary.rmse = root(less(mse, noise.mse));
    summary.relmse = less(estimate_mean(of_runs(cell, layer, &LayerErrors::relmse)), noise.relmse);
    summary.mape = estimate_mean(of_runs(cell, layer, &LayerErrors::mape));
    summary.reference_share = mse.value > 0 ? noise.mse / mse.value : 0;
    summary.efficiency = 1 / (summary.rmse.value * summary.rmse.value * seconds);

    const std::vector<double> biases = of_runs(cell, layer, &LayerErrors::bias);
    const double spread = biases.size() < 2 ? std::nan("") : student_t(biases.size() - 1);
    const double squared_error = sample_variance(biases) / static_cast<double>(biases.size());
    summary.bias_standard_error = std::sqrt(squared_error + noise.mean_error * noise.mean_error);
    summary.bias = estimate_mean(biases);
    summary.bias.low = summary.bias.value - spread * summary.bias_standard_error;
    summary.bias.high = summary.bias.value + spread * summary.bias_standard_error;

    const auto separate = [&](double LayerErrors::*error, double CommonErrors::*common, double subtracted) {
        if (cell.pairs.empty()) return std::pair(UNKNOWN, UNKNOWN);
        const auto bias = [&](const SweepResult& pair) { return pair.common.at(layer).*common; };
        const auto variance = [&](const SweepResult& pair) {
            const double both = pair.runs[0].errors.at(layer).*error + pair.runs[1].errors.at(layer).*error;
            return both / 2 - bias(pair);
        };
        return std::pair(root(less(estimate_mean(values_of(cell.pairs, bias)), subtracted)),
                         estimate_mean(values_of(cell.pairs, variance)));
    };
    std::tie(summary.rms_bias, summary.variance) = separate(&LayerErrors::mse, &CommonErrors::mse, noise.mse);
    std::tie(summary.relative_rms_bias, summary.relative_variance) =
        separate(&LayerErrors::relmse, &CommonErrors::relmse, noise.relmse);
    return summary;
}

std::optional<CellSummary> summarise_cell(const SweepMethod& method, uint32_t budget, const Cell& cell,
                                          const SweepReference& reference) {
    if (cell.runs.empty()) return std::nullopt;
    CellSummary summary{budget, method.samples(budget), cell.runs.size(), {}, 0, {}};
    summary.seconds = spread_of(values_of(cell.runs, [](const SweepRun& run) { return run.seconds; }));
    summary.rays = estimate_mean(values_of(cell.runs, [](const SweepRun& run) {
                       return static_cast<double>(run.rays);
                   })).value;
    for (const std::string& layer : method.layers()) {
        summary.layers[layer] =
            summarise_layer(cell, layer, reference.noise.at(layer), summary.seconds.median);
    }
    return summary;
}

// Exponents of the errors of each seed that all budgets have: independent of each other.
std::optional<Estimate> fit_exponent(const std::vector<Cell>& cells, const std::vector<double>& abscissas,
                                     const std::string& layer, double noise) {
    std::vector<double> exponents;
    size_t seeds = cells.front().runs.size();
    for (const Cell& cell : cells)
        seeds = std::min(seeds, cell.runs.size());
    for (size_t seed = 0; seed < seeds; ++seed) {
        std::vector<double> squares;
        squares.reserve(cells.size());
        for (const Cell& cell : cells)
            squares.push_back(cell.runs[seed]->errors.at(layer).mse - noise);
        const std::optional<PowerLaw> law = fit_power_law(abscissas, squares);
        if (!law) return std::nullopt;
        exponents.push_back(law->exponent / 2);
    }
    return estimate_mean(exponents);
}

struct Curve {
    std::vector<double> seconds, rays, relmse, variance;
};

Curve curve_of(const MethodSummary& summary) {
    Curve curve;
    for (const CellSummary& cell : summary.cells) {
        const LayerSummary& diffuse = cell.layers.at(reference::DIFFUSE_LAYER);
        curve.seconds.push_back(cell.seconds.median);
        curve.rays.push_back(cell.rays);
        curve.relmse.push_back(diffuse.relmse.value);
        curve.variance.push_back(diffuse.relative_variance.value);
    }
    return curve;
}

std::optional<double> overtaking_by(const std::vector<double>& path_x, const std::vector<double>& path_mse,
                                    const std::vector<double>& model_x,
                                    const std::vector<double>& model_variance, double floor) {
    const std::optional<PowerLaw> path = fit_power_law(path_x, path_mse);
    const std::optional<PowerLaw> model = fit_power_law(model_x, model_variance);
    return path && model ? overtaking(*path, *model, floor) : std::nullopt;
}

}  // namespace

std::vector<MethodSummary> summarise(const std::vector<SweepMethod>& methods, uint32_t budget_count,
                                     const std::vector<SweepResult>& results,
                                     const SweepReferences& references) {
    std::vector<MethodSummary> summaries;
    for (const SweepMethod& method : methods) {
        MethodSummary summary{method, {}, {}};
        const auto reference = references.find(method.reference);
        if (reference == references.end()) continue;
        std::vector<Cell> cells;
        std::vector<double> seconds, rays;
        for (const uint32_t budget : method.budgets(budget_count)) {
            Cell cell = collect(results, method.name, budget);
            auto found = summarise_cell(method, budget, cell, reference->second);
            if (!found) continue;
            seconds.push_back(found->seconds.median);
            rays.push_back(found->rays);
            summary.cells.push_back(std::move(*found));
            cells.push_back(std::move(cell));
        }
        if (cells.empty()) continue;
        for (const std::string& layer : method.layers()) {
            const double noise = reference->second.noise.at(layer).mse;
            summary.convergence[layer] = {fit_exponent(cells, rays, layer, noise),
                                          fit_exponent(cells, seconds, layer, noise)};
        }
        summaries.push_back(std::move(summary));
    }
    return summaries;
}

std::vector<Overtaking> find_overtakings(std::span<const MethodSummary> methods) {
    const auto path = std::ranges::find_if(methods, [](const auto& m) { return m.method.path_traced; });
    if (path == methods.end()) return {};
    const Curve path_curve = curve_of(*path);
    std::vector<Overtaking> found;
    for (const MethodSummary& summary : methods) {
        if (summary.method.path_traced || summary.method.reference != reference::IntegratorKind::path)
            continue;
        const Curve curve = curve_of(summary);
        // The largest budget's, which has least noise.
        const Estimate& floor = summary.cells.back().layers.at(reference::DIFFUSE_LAYER).relative_rms_bias;
        found.push_back({summary.method.name, floor, std::nullopt, std::nullopt});
        if (!(floor.low > 0)) continue;  // within the noise
        const double square = floor.value * floor.value;
        found.back().seconds =
            overtaking_by(path_curve.seconds, path_curve.relmse, curve.seconds, curve.variance, square);
        found.back().rays =
            overtaking_by(path_curve.rays, path_curve.relmse, curve.rays, curve.variance, square);
    }
    return found;
}

std::vector<VarianceRatio> variance_ratios(std::span<const MethodSummary> methods) {
    const auto random =
        std::ranges::find_if(methods, [](const auto& m) { return m.method.name == "random"; });
    if (random == methods.end()) return {};
    std::vector<VarianceRatio> ratios;
    for (const MethodSummary& summary : methods) {
        if (summary.method.name != "lattice" && summary.method.name != "owen") continue;
        for (const CellSummary& cell : summary.cells) {
            const auto other = std::ranges::find(random->cells, cell.budget, &CellSummary::budget);
            if (other == random->cells.end()) continue;
            for (const auto& [layer, errors] : cell.layers) {
                ratios.push_back({summary.method.name, layer, cell.budget,
                                  other->layers.at(layer).variance.value / errors.variance.value});
            }
        }
    }
    return ratios;
}

}  // namespace obscura
