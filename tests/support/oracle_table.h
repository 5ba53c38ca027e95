// SPDX-License-Identifier: Apache-2.0
// The obscurance W of every oracle geometry, falloff and d_max as the device finds it, beside its closed form.
#pragma once

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sampling/sample_order.h"
#include "support/falloffs.h"
#include "support/oracle_geometry.h"
#include "support/render.h"
#include "support/statistics.h"

namespace obscura::test {

// Each of the 16 pixels that see the point is a randomisation of its own.
constexpr uint32_t ORACLE_SPP = 64;
constexpr uint32_t ORACLE_RAYS = ORACLE_SPP * 1024;  // of each pixel: 2^16, so that a point has 2^20
// Of W: two units in the last place of 1.
constexpr double W_ROUNDING = 2.5e-7;
// Of a channel of W: the film adds up samples that may all be R_ave, each sum off by half a unit in the last place.
constexpr double CHANNEL_ROUNDING = ORACLE_SPP * 0x1p-24;

inline RenderSettings oracle_settings(SamplerKind sampler, const Falloff& falloff, double d_max,
                                      uint32_t rays = ORACLE_RAYS) {
    RenderSettings settings = picture(4, 4, ORACLE_SPP, rays / ORACLE_SPP);
    settings.sampler = sampler;
    settings.falloff = falloff;
    settings.d_max.value = d_max;
    settings.ambient_light = Rgb(1);
    settings.direct = false;
    return settings;
}

// A row for each geometry, falloff and d_max, each with a seed of its own.
struct OracleTable {
    struct Row {
        const OracleGeometry* geometry;
        Falloff falloff;
        double d_max;  // m
        std::vector<double> values;
    };
    SamplerKind sampler;
    std::vector<Falloff> falloffs;
    std::vector<double> reaches;
    std::vector<Row> rows;
    ZTable colourless;
    ZTable colour;  // W of each channel
};

inline OracleTable measure_oracles(SamplerKind sampler, bool bleeding, const std::vector<Falloff>& falloffs,
                                   const std::vector<double>& reaches) {
    // A point has 1024 work-items: in groups of 64 they are too few for PoCL to share them among cores.
    constexpr RenderCut SMALL_GROUPS{.local_size = 16};
    OracleTable table{sampler, falloffs, reaches, {}, {}, {}};
    uint64_t seed = 1000 * static_cast<uint64_t>(sampler);
    for (const OracleGeometry& geometry : oracle_geometries()) {
        for (const Falloff& falloff : falloffs) {
            for (const double d_max : reaches) {
                RenderSettings settings = oracle_settings(sampler, falloff, d_max);
                settings.bleeding = bleeding;
                settings.seed = seed++;
                const RenderResult found =
                    render(geometry.scene, settings, {"ao", "obscurance"}, SMALL_GROUPS);
                const std::string name =
                    fmt::format("{}, {}, d_max {}", geometry.name, falloff_text(falloff), d_max);
                const Bracket w = geometry.obscurance(falloff, d_max);
                table.rows.push_back({&geometry, falloff, d_max, channel(found.image, "ao", 0)});
                table.colourless.add(name, table.rows.back().values, w.low, w.high, W_ROUNDING);

                const Bracket closed = geometry.obscurance(STEP, d_max);
                const RgbD hit = bleeding ? RgbD(ORACLE_COLOR) : RgbD(1);
                const RgbD open = bleeding ? found.radiometry.average_reflectivity : RgbD(1);
                const RgbD low = bleeding_obscurance(w.low, closed.high, hit, open);
                const RgbD high = bleeding_obscurance(w.high, closed.low, hit, open);
                for (int c = 0; c < 3; ++c)
                    table.colour.add(fmt::format("{}, channel {}", name, c),
                                     channel(found.image, "obscurance", static_cast<size_t>(c)), low[c],
                                     high[c], CHANNEL_ROUNDING);
            }
        }
    }
    return table;
}

// As JSON, for tools/report.
inline void write_oracles(const OracleTable& table, const std::filesystem::path& path) {
    nlohmann::json document{{"device", shared_device().name()},
                            {"sampler", sampler_name(table.sampler)},
                            {"rays", ORACLE_RAYS * table.rows.front().values.size()},
                            {"randomisations", table.rows.front().values.size()},
                            {"rounding", W_ROUNDING},
                            {"z_limit", table.colourless.limit()},
                            {"d_max", table.reaches}};
    for (const OracleGeometry& geometry : oracle_geometries())
        document["geometries"].push_back(geometry.name);
    for (const Falloff& falloff : table.falloffs)
        document["falloffs"].push_back(falloff_text(falloff));
    for (size_t i = 0; i < table.rows.size(); ++i) {
        const OracleTable::Row& row = table.rows[i];
        const Comparison& comparison = table.colourless.rows()[i];
        document["rows"].push_back({{"geometry", row.geometry->name},
                                    {"rho", falloff_text(row.falloff)},
                                    {"d_max", row.d_max},
                                    {"value", comparison.found.mean},
                                    {"closed_form", {comparison.low, comparison.high}},
                                    {"standard_error", comparison.found.standard_error},
                                    {"z", comparison.z()}});
    }
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << document.dump(1) << '\n';
}

}  // namespace obscura::test
