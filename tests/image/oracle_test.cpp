// SPDX-License-Identifier: Apache-2.0
// The obscurance W of rendered points against closed forms: every geometry with every falloff and several d_max, by
// z-tests over 16 independent randomisations of 65536 rays each. The table of Owen's points is also written to the build
// tree, for tools/report.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <set>

#include "support/oracle_table.h"

namespace obscura::test {
namespace {

using Oracle = DeviceTest;

const std::vector<double> UNIT_REACH{1};

// The falloff whose W is the mean of rho^2; nullopt where it has no closed form here.
std::optional<Falloff> squared(const Falloff& falloff) {
    switch (falloff.kind) {
        case FalloffKind::step:
            return falloff;
        case FalloffKind::sqrt:
            return LINEAR;
        case FalloffKind::cbrt:
            return Falloff{FalloffKind::pow, 2.0 / 3};
        case FalloffKind::pow:
            return Falloff{FalloffKind::pow, 2 * falloff.parameter};
        default:
            return std::nullopt;
    }
}

// Mean of (estimate - W)^2 over its exact variance for independent rays.
void expect_variance_of_independent_rays(const OracleTable& table) {
    double sum = 0, count = 0;
    for (const OracleTable::Row& row : table.rows) {
        const auto square = squared(row.falloff);
        if (!square) continue;
        const Bracket w = row.geometry->obscurance(row.falloff, row.d_max);
        const Bracket second_moment = row.geometry->obscurance(*square, row.d_max);
        const double variance = (second_moment.low - w.low * w.low) / ORACLE_RAYS;
        // Tessellated geometry has no exact variance; closed or open geometry has none at all.
        if (w.low < w.high || variance < 1e-15) continue;
        for (const double value : row.values)
            sum += (value - w.low) * (value - w.low) / variance;
        count += static_cast<double>(row.values.size());
    }
    ASSERT_GE(count, 200);
    EXPECT_NEAR(sum / count, 1, 3.5 * std::sqrt(2 / count)) << "3.5 standard errors of the mean of chi^2";
}

// Every value multiplied by 1.01: each row must notice, unless W is 0.
void expect_planted_percent_found(const OracleTable& table) {
    for (size_t i = 0; i < table.rows.size(); ++i) {
        const Comparison& row = table.colourless.rows()[i];
        if (row.high < row.rounding) continue;
        std::vector<double> values = table.rows[i].values;
        for (double& value : values)
            value *= 1.01;
        const Comparison planted{row.name, estimate(values), row.low, row.high, row.rounding};
        EXPECT_GT(planted.z(), table.colourless.limit()) << row.name;
    }
}

// Where nothing or everything is open there is nothing to round.
void expect_extremes_exact(const OracleTable& table) {
    size_t open = 0, closed = 0;
    for (size_t i = 0; i < table.rows.size(); ++i) {
        const Comparison& row = table.colourless.rows()[i];
        if (row.high > 1e-12 && row.low < 1 - 1e-12) continue;
        const double extreme = std::round(row.low);
        (extreme == 1 ? open : closed) += 1;
        EXPECT_EQ(table.rows[i].values, std::vector<double>(16, extreme)) << row.name;
    }
    EXPECT_GE(open, 36u) << "empty space at three d_max, the cube of two d_max";
    EXPECT_GE(closed, 5u) << "the step falloff in cube, sphere and dome";
}

void expect_closed_forms(const OracleTable& table) {
    for (const ZTable* comparisons : {&table.colourless, &table.colour}) {
        comparisons->expect_no_failure();
        comparisons->expect_one_percent_matters();
    }
}

TEST_F(Oracle, OwenRaysWithBleedingGiveClosedForms) {
    const OracleTable table = measure_oracles(SamplerKind::owen, true, ALL_FALLOFFS, ORACLE_REACHES);
    write_oracles(table, OBSCURA_BINARY_DIR "/reports/oracles.json");
    EXPECT_EQ(table.rows.size(), oracle_geometries().size() * ALL_FALLOFFS.size() * ORACLE_REACHES.size());
    expect_closed_forms(table);
    table.colourless.expect_student_spread();
    expect_extremes_exact(table);
    expect_planted_percent_found(table);
}

TEST_F(Oracle, RandomRaysWithBleedingGiveClosedForms) {
    const OracleTable table = measure_oracles(SamplerKind::random, true, MAIN_FALLOFFS, UNIT_REACH);
    table.colourless.expect_no_failure();
    table.colour.expect_no_failure();
    expect_variance_of_independent_rays(table);
}

TEST_F(Oracle, LatticeRaysWithoutBleedingGiveClosedForms) {
    expect_closed_forms(measure_oracles(SamplerKind::lattice, false, MAIN_FALLOFFS, UNIT_REACH));
}

TEST_F(Oracle, FalloffsOfTheTableAreOfEveryKind) {
    std::set<FalloffKind> kinds;
    for (const Falloff& falloff : ALL_FALLOFFS)
        kinds.insert(falloff.kind);
    EXPECT_EQ(kinds.size(), static_cast<size_t>(FalloffKind::pow) + 1);
}

TEST_F(Oracle, ColourlessObscuranceIsTheSameWithBleeding) {
    for (const OracleGeometry& geometry : oracle_geometries()) {
        for (const Falloff& falloff : MAIN_FALLOFFS) {
            const auto ao = [&](bool bleeding) {
                RenderSettings settings = oracle_settings(SamplerKind::owen, falloff, 1, 1024);
                settings.bleeding = bleeding;
                return channel(render(geometry.scene, settings, {"ao"}).image, "ao", 0);
            };
            EXPECT_EQ(ao(true), ao(false)) << geometry.name << ", " << falloff_text(falloff);
        }
    }
}

TEST_F(Oracle, OnePercentMoreReachIsDetected) {
    for (const OracleGeometry& geometry : oracle_geometries()) {
        const Bracket w = geometry.obscurance(SQRT, 1);
        if (w.low == 1) continue;  // nothing within reach
        for (const SamplerKind sampler : {SamplerKind::random, SamplerKind::owen}) {
            const RenderSettings settings = oracle_settings(sampler, SQRT, 1.01);
            ZTable table;
            table.add("sqrt", channel(render(geometry.scene, settings, {"ao"}).image, "ao", 0), w.low, w.high,
                      W_ROUNDING);
            EXPECT_FALSE(table.failures().empty())
                << geometry.name << ", sampler " << static_cast<int>(sampler);
        }
    }
}

}  // namespace
}  // namespace obscura::test
