// SPDX-License-Identifier: Apache-2.0
// The obscurance W of rendered pictures against closed forms, by z-tests over 16 independent seeds of 65536 rays
// each.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <numbers>
#include <optional>

#include "reference/oracles.h"
#include "support/falloffs.h"
#include "support/render.h"
#include "support/scene_builder.h"
#include "support/sphere_facet.h"
#include "support/statistics.h"

namespace obscura::test {
namespace {

using Oracle = DeviceTest;

constexpr uint64_t SEEDS = 16;
constexpr uint32_t SPP = 64;
constexpr uint32_t RAYS = SPP * 1024;  // of each seed
constexpr double ROUNDING = 2.5e-7;    // of W: two units in its last place
// So narrow that all camera rays meet the same point.
constexpr double POINT_FOV = 1e-6;
const Rgb COLOR(0.8f, 0.5f, 0.2f);  // of every surface near the point

// A point whose W is known for d_max = 1 m.
struct Geometry {
    std::string name;
    Scene scene;
    std::vector<Falloff> falloffs;
    std::function<Bracket(const Falloff&)> obscurance;
};

// A black surface out of reach, so that R_ave differs from the colour that the rays meet.
void add_far_black(SceneBuilder& builder) {
    builder.quad({60, 0, 60}, {8, 0, 0}, {0, 0, 8}, builder.material(matte(Rgb(0))));
}

// Occluders are just large enough to be infinite for d_max, and the floor is small: rays start above it by a distance
// in proportion to its size, and W would show that.
void add_floor(SceneBuilder& builder, uint32_t material) {
    builder.quad({-0.05f, 0, 0.05f}, {0.1f, 0, 0}, {0, 0, -0.1f}, material);
}

Geometry plane_at(float height) {
    SceneBuilder builder;
    const uint32_t material = builder.material(matte(COLOR));
    add_floor(builder, material);
    builder.quad({-1.2f, height, -1.2f}, {2.4f, 0, 0}, {0, 0, 2.4f}, material);
    add_far_black(builder);
    builder.camera(V3d(0, static_cast<double>(height) / 2, 0), V3d(0, 0, 0), POINT_FOV);
    const auto w = [height](const Falloff& falloff) {
        const double value = plane_obscurance(falloff, static_cast<double>(height));
        return Bracket{value, value};
    };
    return {fmt::format("plane {}", height), builder.finish(), ALL_FALLOFFS, w};
}

// Walls at 0.25 m on the sides +x, +z and -x of the point, the first `count` of them.
Geometry walls(int count) {
    SceneBuilder builder;
    const uint32_t material = builder.material(matte(COLOR));
    add_floor(builder, material);
    builder.quad({0.25f, -0.2f, -1.2f}, {0, 0, 2.4f}, {0, 1.4f, 0}, material);
    if (count > 1) builder.quad({-1.2f, -0.2f, 0.25f}, {2.4f, 0, 0}, {0, 1.4f, 0}, material);
    if (count > 2) builder.quad({-0.25f, -0.2f, -1.2f}, {0, 0, 2.4f}, {0, 1.4f, 0}, material);
    add_far_black(builder);
    builder.camera(V3d(0, 1, 0), V3d(0, 0, 0), POINT_FOV);
    std::vector<Wall> list;
    for (int i = 0; i < count; ++i)
        list.push_back({i * std::numbers::pi / 2, 0.25});
    const auto w = [list](const Falloff& falloff) {
        const double value = floor_obscurance(falloff, list);
        return Bracket{value, value};
    };
    return {fmt::format("{} walls", count), builder.finish(), MAIN_FALLOFFS, w};
}

// The inside of a sphere of diameter 1 m.
Geometry sphere_surface() {
    SceneBuilder builder;
    builder.sphere({0, 0, 0}, 0.5f, 5, builder.material(matte(COLOR)), true);
    add_far_black(builder);
    const Scene mesh = SceneBuilder(builder).finish();
    const SphereFacet facet = find_facet(mesh, V3d(0.3, -0.5, -0.8));
    builder.camera(V3d(0, 0, 0), facet.foot, POINT_FOV);
    const auto w = [facet](const Falloff& falloff) { return facet_obscurance(facet, falloff, 1); };
    return {"sphere", builder.finish(), MAIN_FALLOFFS, w};
}

const std::vector<Geometry>& geometries() {
    static const std::vector<Geometry> list{plane_at(0.1f), plane_at(0.25f), plane_at(0.5f),
                                            walls(1),       walls(3),        sphere_surface()};
    return list;
}

RenderSettings one_point(SamplerKind sampler, bool bleeding, const Falloff& falloff, uint32_t rays = RAYS) {
    RenderSettings settings = picture(1, 1, SPP, rays / SPP);
    settings.sampler = sampler;
    settings.bleeding = bleeding;
    settings.falloff = falloff;
    settings.ambient_light = Rgb(1);
    settings.direct = false;
    return settings;
}

// Estimates of the seeds first_seed, first_seed + 1 ...: colourless W, and W per channel.
struct Estimates {
    std::vector<double> colourless;
    std::array<std::vector<double>, 3> colour;
    RgbD average_reflectivity;
};

Estimates estimate_point(const Scene& scene, RenderSettings settings, uint64_t first_seed) {
    Estimates estimates;
    for (uint64_t seed = 0; seed < SEEDS; ++seed) {
        settings.seed = first_seed + seed;
        const RenderResult result = render(scene, settings, {"ao", "obscurance"});
        estimates.colourless.push_back(channel(result.image, "ao", 0).at(0));
        for (size_t c = 0; c < 3; ++c)
            estimates.colour[c].push_back(channel(result.image, "obscurance", c).at(0));
        estimates.average_reflectivity = result.radiometry.average_reflectivity;
    }
    return estimates;
}

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
struct VarianceRatio {
    double sum = 0;
    double count = 0;

    void add(const std::vector<double>& values, double w, double second_moment) {
        const double variance = (second_moment - w * w) / RAYS;
        for (const double value : values)
            sum += (value - w) * (value - w) / variance;
        count += static_cast<double>(values.size());
    }
};

struct Tables {
    ZTable z;
    VarianceRatio variance;
};

// Every geometry with every falloff of its list. With bleeding the rays' colours must follow W = R_Q (W_rho - W_AO)
// + R_ave W_AO too, which holds for occluders of one colour.
Tables compare_all(SamplerKind sampler, bool bleeding) {
    Tables tables;
    uint64_t first_seed = 1000 * static_cast<uint64_t>(sampler);
    for (const Geometry& geometry : geometries()) {
        const Bracket closed = geometry.obscurance(STEP);
        for (const Falloff& falloff : geometry.falloffs) {
            const Estimates found =
                estimate_point(geometry.scene, one_point(sampler, bleeding, falloff), first_seed);
            first_seed += SEEDS;
            const Bracket w = geometry.obscurance(falloff);
            const std::string name = geometry.name + ", " + falloff_text(falloff);
            tables.z.add(name, found.colourless, w.low, w.high, ROUNDING);
            // A sphere within reach leaves nothing open to the step: no variance.
            if (const auto square = squared(falloff); square && w.low == w.high && w.low > 0) {
                tables.variance.add(found.colourless, w.low, geometry.obscurance(*square).low);
            }
            for (int c = 0; c < 3; ++c) {
                const double hit = bleeding ? static_cast<double>(COLOR[c]) : 1;
                const double drop = hit - (bleeding ? found.average_reflectivity[c] : 1);
                tables.z.add(fmt::format("{}, channel {}", name, c), found.colour[static_cast<size_t>(c)],
                             hit * w.low - drop * closed.high, hit * w.high - drop * closed.low, ROUNDING);
            }
        }
    }
    return tables;
}

TEST_F(Oracle, RandomRaysWithBleedingGiveClosedForms) {
    const Tables tables = compare_all(SamplerKind::random, true);
    tables.z.expect_no_failure();
    // Independent rays have exactly the variance that they should: 3.5 standard errors of the mean of chi^2.
    ASSERT_GE(tables.variance.count, 200);
    EXPECT_NEAR(tables.variance.sum / tables.variance.count, 1, 3.5 * std::sqrt(2 / tables.variance.count));
}

TEST_F(Oracle, OwenRaysWithBleedingGiveClosedForms) {
    const Tables tables = compare_all(SamplerKind::owen, true);
    tables.z.expect_no_failure();
    tables.z.expect_one_percent_matters();
}

TEST_F(Oracle, LatticeRaysWithoutBleedingGiveClosedForms) {
    const Tables tables = compare_all(SamplerKind::lattice, false);
    tables.z.expect_no_failure();
    tables.z.expect_one_percent_matters();
}

TEST_F(Oracle, ColourlessObscuranceIsTheSameWithBleeding) {
    for (const Geometry& geometry : geometries()) {
        for (const Falloff& falloff : geometry.falloffs) {
            const auto ao = [&](bool bleeding) {
                const RenderSettings settings = one_point(SamplerKind::owen, bleeding, falloff, 1024);
                return channel(render(geometry.scene, settings, {"ao"}).image, "ao", 0);
            };
            EXPECT_EQ(ao(true), ao(false)) << geometry.name << ", " << falloff_text(falloff);
        }
    }
}

TEST_F(Oracle, OnePercentMoreReachIsDetected) {
    for (const SamplerKind sampler : {SamplerKind::random, SamplerKind::owen}) {
        for (const Geometry& geometry : geometries()) {
            RenderSettings settings = one_point(sampler, true, SQRT);
            settings.d_max.value = 1.01;
            ZTable table;
            const Bracket w = geometry.obscurance(SQRT);
            table.add("sqrt", estimate_point(geometry.scene, settings, 77).colourless, w.low, w.high,
                      ROUNDING);
            EXPECT_FALSE(table.failures().empty())
                << geometry.name << ", sampler " << static_cast<int>(sampler);
        }
    }
}

}  // namespace
}  // namespace obscura::test
