// SPDX-License-Identifier: Apache-2.0
// What the renders of a sweep tell together: errors with their intervals, bias and variance apart from each other, and how
// fast each method converges. What the reference's own noise adds to squared errors is subtracted.
#pragma once

#include "reference/bench_statistics.h"
#include "reference/sweep.h"
#include "reference/sweep_statistics.h"

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace obscura {

// A layer of all pictures of one method and budget.
struct LayerSummary {
    Estimate rmse, relmse, mape;
    Estimate bias;  // the mean error; the interval is due to the reference too
    double bias_standard_error = 0;
    Estimate rms_bias;                              // root of the mean squared bias of pixels and channels
    Estimate variance;                              // mean over pixels and channels
    Estimate relative_rms_bias, relative_variance;  // the same of relmse
    double reference_share = 0;  // of the squared error: what was subtracted as the reference's
    double efficiency = 0;       // 1 / (mse s)
};

struct CellSummary {
    uint32_t budget = 0;
    uint32_t samples = 0;  // per pixel
    size_t runs = 0;
    Spread seconds;
    double rays = 0;  // mean
    std::map<std::string, LayerSummary> layers;
};

// How a layer's error falls: exponents of power laws in rays and in seconds, fitted to the budgets' RMSE seed by seed.
struct Convergence {
    std::optional<Estimate> by_rays, by_seconds;  // nothing where an error is within the reference's noise
};

struct MethodSummary {
    SweepMethod method;
    std::vector<CellSummary> cells;
    std::map<std::string, Convergence> convergence;  // by layer
};

// Where path tracing becomes better than a model that stays at a floor.
struct Overtaking {
    std::string method;
    Estimate floor;  // of the diffuse light: its relative RMS bias, which is left with any number of samples
    std::optional<double> seconds, rays;  // of a picture; nothing if it can't be told
};

// results: any order; methods without any are left out.
std::vector<MethodSummary> summarise(const std::vector<SweepMethod>& methods, uint32_t budget_count,
                                     const std::vector<SweepResult>& results,
                                     const SweepReferences& references);

// Of all methods that are measured against all light, if path tracing is among them.
std::vector<Overtaking> find_overtakings(std::span<const MethodSummary> methods);

// How many times less variance than random points, at the same rays: of the methods that trace as many as `random`, by
// name, budget and layer.
struct VarianceRatio {
    std::string method, layer;
    uint32_t budget = 0;
    double ratio = 0;
};
std::vector<VarianceRatio> variance_ratios(std::span<const MethodSummary> methods);

}  // namespace obscura
