// SPDX-License-Identifier: Apache-2.0
// What a sweep concludes from its renders: errors of layers, bias apart from noise, intervals, ratios and crossings, each
// against numbers worked out by hand.
#include "reference/sweep_summary.h"

#include "reference/accumulator.h"
#include "support/errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

namespace obscura {
namespace {

using reference::DIFFUSE_LAYER;
using reference::IntegratorKind;

Layer rgb(const std::string& name, std::vector<float> pixels) {
    return {name, {"R", "G", "B"}, std::move(pixels)};
}

TEST(SweepErrors, AreThoseOfTheColors) {
    const Layer reference = rgb("", {1, 2, 0, 0, 0, 0});
    // Alpha is far off, but no colour.
    const Layer render{"", {"R", "G", "B", "A"}, {2, 2, 0, 9, 0, 0, -1, 9}};
    const LayerErrors errors = measure_errors(render, reference);
    EXPECT_DOUBLE_EQ(errors.mse, 2.0 / 6);
    EXPECT_DOUBLE_EQ(errors.relmse, (1 / 1.01 + 1 / 0.01) / 6);
    EXPECT_DOUBLE_EQ(errors.mape, (1 / 1.01 + 1 / 0.01) / 6);
    EXPECT_DOUBLE_EQ(errors.bias, 0);
    const CommonErrors common = measure_common_errors(render, rgb("", {4, 2, 0, 0, 0, 2}), reference);
    EXPECT_DOUBLE_EQ(common.mse, (1.0 * 3 - 1 * 2) / 6);
    EXPECT_DOUBLE_EQ(common.relmse, (1.0 * 3 / 1.01 - 1 * 2 / 0.01) / 6);
}

TEST(SweepErrors, NoiseIsTheReferencesVariance) {
    const ReferenceNoise noise = measure_noise(rgb("", {1, 0, 0, 0, 0, 0}), rgb("", {2, 1, 0, 0, 0, 0}));
    EXPECT_DOUBLE_EQ(noise.mse, 0.5);
    EXPECT_DOUBLE_EQ(noise.relmse, (2 / 1.01 + 1 / 0.01) / 6);
    EXPECT_DOUBLE_EQ(noise.mean_error, std::sqrt(0.5 / 2));
}

// Renders with a known bias and a known noise, and a noisy reference.
TEST(SweepErrors, PairsTellBiasFromNoise) {
    constexpr size_t VALUES = 3 * 40000;
    constexpr double BIAS = 0.3, NOISE = 0.5, REFERENCE_NOISE = 0.2;
    std::mt19937 random(1);
    const auto noisy = [&](double mean, double deviation) {
        std::normal_distribution<float> normal(static_cast<float>(mean), static_cast<float>(deviation));
        std::vector<float> values(VALUES);
        for (float& value : values)
            value = normal(random);
        return rgb("", values);
    };
    const Layer reference = noisy(1, REFERENCE_NOISE);
    const Layer first = noisy(1 + BIAS, NOISE), second = noisy(1 + BIAS, NOISE);
    const double common = measure_common_errors(first, second, reference).mse;
    const double mse = (measure_errors(first, reference).mse + measure_errors(second, reference).mse) / 2;
    const double subtracted = measure_noise(reference, rgb("", std::vector<float>(VALUES, 0.04f))).mse;
    EXPECT_NEAR(common - subtracted, BIAS * BIAS, 5e-3);
    EXPECT_NEAR(mse - common, NOISE * NOISE, 5e-3);
    EXPECT_NEAR(mse - subtracted, BIAS * BIAS + NOISE * NOISE, 5e-3);
}

std::set<std::string> names_of(const RenderSettings& base) {
    std::set<std::string> names;
    for (const SweepMethod& method : sweep_methods(base))
        EXPECT_TRUE(names.insert(method.name).second) << method.name;
    return names;
}

const SweepMethod& named(const std::vector<SweepMethod>& methods, const std::string& name) {
    return *std::ranges::find(methods, name, &SweepMethod::name);
}

TEST(SweepMethods, BudgetsAreWholeSamples) {
    const std::vector<SweepMethod> methods = sweep_methods({});
    const std::vector<uint32_t> paper{5, 10, 20, 40}, even{10, 20, 40, 80};
    EXPECT_EQ(named(methods, "lattice").budgets(4), paper);
    EXPECT_EQ(named(methods, "k10").budgets(4), even);
    EXPECT_EQ(named(methods, "k2").budgets(4), even);
    EXPECT_EQ(named(methods, "k1").budgets(4), paper);
    for (const auto& [name, samples] : {std::pair{"lattice", 8},
                                        {"k10", 4},
                                        {"k2", 20},
                                        {"k1", 40},
                                        {"none", 8},
                                        {"constant", 8},
                                        {"path", 8}})
        EXPECT_EQ(named(methods, name).samples(40), static_cast<uint32_t>(samples)) << name;
}

TEST(SweepMethods, LeaveOutWhatTheBaseIsAlready) {
    const std::set<std::string> names = names_of({});
    EXPECT_TRUE(names.contains("rho-sqrt") && names.contains("dmax-x2") && !names.contains("rho-exp"));
    RenderSettings base;
    base.falloff = parse_falloff("sqrt");
    base.d_max = parse_max_distance("inf");
    const std::set<std::string> others = names_of(base);
    EXPECT_TRUE(others.contains("rho-exp") && !others.contains("rho-sqrt") && !others.contains("dmax-x2"));
}

TEST(SweepMethods, ThoseOfNoNameAreRefused) {
    const std::vector<SweepMethod> methods = sweep_methods({});
    EXPECT_EQ(choose_methods(methods, {}).size(), methods.size());
    const std::vector<std::string> chosen{"path", "owen"};
    ASSERT_EQ(choose_methods(methods, chosen).size(), 2u);
    EXPECT_EQ(choose_methods(methods, chosen)[0].name, "owen") << "in the order of the list";
    const std::vector<std::string> wrong{"owen", "sobol"};
    EXPECT_NE(test::input_error([&] { choose_methods(methods, wrong); }).find("sobol"), std::string::npos);
}

TEST(SweepPlan, GoesThroughAllMethodsTwoSeedsAtATime) {
    const std::vector<std::string> names{"lattice", "k10"};
    const std::vector<SweepTask> tasks = plan_sweep(choose_methods(sweep_methods({}), names), 2, 3);
    ASSERT_EQ(tasks.size(), 8u);
    EXPECT_EQ(tasks[1].method.name, "k10");
    EXPECT_EQ(tasks[1].budget, 10u);
    EXPECT_EQ(tasks[3].budget, 20u);
    EXPECT_EQ(tasks[3].runs, 2u);
    EXPECT_EQ(tasks[4].first_seed, 2u);
    EXPECT_EQ(tasks[4].runs, 1u) << "the third seed is alone";
}

// A result whose two runs have the errors of this one in every layer.
SweepResult result(const std::string& method, uint32_t budget, uint64_t seed, std::array<double, 2> mse,
                   double common, double seconds) {
    SweepResult made{method, budget, seed, {}, {}};
    for (size_t i = 0; i < 2; ++i) {
        SweepRun run{seconds * static_cast<double>(i + 1), budget * 100, {}};
        for (const char* layer : {"", DIFFUSE_LAYER, "obscurance"})
            run.errors[layer] = {mse[i], 2 * mse[i], 0.1, i == 0 ? 0.1 : 0.3};
        made.runs.push_back(run);
    }
    for (const char* layer : {"", DIFFUSE_LAYER, "obscurance"})
        made.common[layer] = {common, 2 * common};
    return made;
}

SweepReferences noisy_references() {
    SweepReferences references;
    for (const IntegratorKind kind : {IntegratorKind::obscurance, IntegratorKind::path}) {
        for (const char* layer : {"", DIFFUSE_LAYER, "obscurance"})
            references[kind].noise[layer] = {0.01, 0.02, 0.03};
    }
    return references;
}

TEST(SweepSummary, SubtractsTheReferencesNoise) {
    const std::vector<SweepMethod> methods = sweep_methods({});
    const std::vector<SweepResult> results{result("lattice", 5, 0, {0.16, 0.18}, 0.05, 2)};
    const auto summaries = summarise(methods, 1, results, noisy_references());
    ASSERT_EQ(summaries.size(), 1u);
    const CellSummary& cell = summaries[0].cells.at(0);
    EXPECT_EQ(cell.samples, 1u);
    EXPECT_EQ(cell.runs, 2u);
    EXPECT_EQ(cell.seconds.median, 3);
    EXPECT_EQ(cell.rays, 500);
    const LayerSummary& beauty = cell.layers.at("");
    EXPECT_NEAR(beauty.rmse.value, 0.4, 1e-12);  // sqrt(0.17 - 0.01)
    // 12.7062 sqrt(2 * 0.01^2 / 1 / 2) = 0.127062 either side of the mean square
    EXPECT_NEAR(beauty.rmse.high, std::sqrt(0.16 + 0.127062), 1e-5);
    EXPECT_NEAR(beauty.relmse.value, 0.34 - 0.02, 1e-12);
    EXPECT_NEAR(beauty.mape.value, 0.1, 1e-12);
    EXPECT_NEAR(beauty.reference_share, 0.01 / 0.17, 1e-12);
    EXPECT_NEAR(beauty.efficiency, 1 / (0.16 * 3), 1e-12);
    EXPECT_NEAR(beauty.rms_bias.value, 0.2, 1e-12);  // sqrt(0.05 - 0.01)
    EXPECT_NEAR(beauty.variance.value, 0.12, 1e-12);
    EXPECT_NEAR(beauty.relative_rms_bias.value, std::sqrt(0.10 - 0.02), 1e-12);
    EXPECT_NEAR(beauty.relative_variance.value, 0.24, 1e-12);
    EXPECT_TRUE(std::isnan(beauty.variance.low)) << "one pair";
    // Seeds: 0.1 and 0.3, standard error 0.1; the reference's 0.03.
    EXPECT_NEAR(beauty.bias.value, 0.2, 1e-12);
    EXPECT_NEAR(beauty.bias_standard_error, std::hypot(0.1, 0.03), 1e-12);
}

TEST(SweepSummary, FitsTheExponentOfEachSeed) {
    // Squared errors beyond the noise fall as 1 / rays and as 1 / rays^2: exponents -1/2 and -1 of the RMSE.
    const std::vector<SweepResult> results{result("owen", 5, 0, {0.41, 0.41}, 0, 1),
                                           result("owen", 10, 0, {0.21, 0.11}, 0, 4)};
    const auto fit =
        summarise(sweep_methods({}), 2, results, noisy_references())[0].convergence.at("obscurance");
    ASSERT_TRUE(fit.by_rays && fit.by_seconds);
    EXPECT_NEAR(fit.by_rays->value, -0.75, 1e-12);
    EXPECT_NEAR(fit.by_rays->high, -0.75 + 12.7062 * 0.25, 1e-3);
    EXPECT_NEAR(fit.by_seconds->value, -0.375, 1e-12) << "a budget twice as large took four times as long";
    const std::vector<SweepResult> noise{result("owen", 5, 0, {0.41, 0.41}, 0, 1),
                                         result("owen", 10, 0, {0.21, 0.009}, 0, 4)};
    EXPECT_FALSE(summarise(sweep_methods({}), 2, noise, noisy_references())[0].convergence.at("").by_rays);
}

TEST(SweepSummary, FindsHowMuchLessVarianceThanRandomPoints) {
    const std::vector<SweepResult> results{result("lattice", 5, 0, {0.3, 0.3}, 0.1, 1),
                                           result("random", 5, 0, {0.7, 0.7}, 0.1, 1)};
    const auto ratios = variance_ratios(summarise(sweep_methods({}), 1, results, noisy_references()));
    ASSERT_EQ(ratios.size(), 3u);
    EXPECT_NEAR(ratios[0].ratio, 3, 1e-12);
    EXPECT_EQ(ratios[0].method, "lattice");
}

TEST(SweepSummary, FindsWherePathTracingIsBetterThanAModel) {
    // Path tracing: 4 / rays beyond the noise. The model: variance 2 / rays, floor 0.001.
    std::vector<SweepResult> results;
    for (const uint32_t budget : {5u, 10u}) {
        const double path = 4.0 / (100 * budget) + 0.01, model = 2.0 / (100 * budget) + 0.011;
        for (const uint64_t seed : {0u, 2u}) {
            results.push_back(result("path", budget, seed, {path, path}, 0.01, 1));
            results.push_back(result("ao", budget, seed, {model, model}, 0.011, 1));
        }
    }
    const auto summaries = summarise(sweep_methods({}), 2, results, noisy_references());
    const auto found = find_overtakings(summaries);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].method, "ao");
    EXPECT_NEAR(found[0].floor.value, std::sqrt(0.002), 1e-9) << "of the relative error, twice the other";
    ASSERT_TRUE(found[0].rays);
    EXPECT_NEAR(*found[0].rays, 2000, 1e-3);
    EXPECT_FALSE(found[0].seconds) << "all budgets took as long";
}

TEST(SweepSummary, TellsNoCrossingWhereTheFloorIsWithinTheNoise) {
    std::vector<SweepResult> results;
    for (const uint32_t budget : {5u, 10u}) {
        for (const uint64_t seed : {0u, 2u}) {
            results.push_back(result("path", budget, seed, {0.5, 0.5}, 0.01, 1));
            results.push_back(result("ao", budget, seed, {0.5, 0.5}, seed == 0 ? 0.005 : 0.017, 1));
        }
    }
    const auto found = find_overtakings(summarise(sweep_methods({}), 2, results, noisy_references()));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_FALSE(found[0].rays);
}

}  // namespace
}  // namespace obscura
