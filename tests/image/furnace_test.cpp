// SPDX-License-Identifier: Apache-2.0
// The furnace: inside a closed sphere of uniform reflectivity R and emission E all light is known:
// beauty = E (1 + R + R^2 / (1 - R) W), W of the sphere's surface for sigma = diameter / d_max; with bleeding too.
// The camera looks at one facet's foot, where W is bracketed for the tessellated sphere; its 16 pixels are 16
// independent randomisations of the same point.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/errors.h"
#include "support/falloffs.h"
#include "support/render.h"
#include "support/scene_builder.h"
#include "support/sphere_facet.h"
#include "support/statistics.h"

namespace obscura::test {
namespace {

using Furnace = DeviceTest;

constexpr float RADIUS = 1;
constexpr int LEVELS = 4;
const Rgb EMISSION(1, 2, 0.5f);
// R = 0, 0.2, 0.5, 0.9, 0.99: one for each channel of two scenes.
const std::vector<Rgb> REFLECTIVITIES{Rgb(0, 0.2f, 0.5f), Rgb(0.9f, 0.99f, 0.5f)};
RenderSettings furnace_settings(uint32_t width, uint32_t height, double d_max) {
    RenderSettings settings = picture(width, height, 4, 256);
    settings.light_samples = 64;
    settings.d_max.value = d_max;
    return settings;
}

// The furnace with a camera at its centre that sees nothing but one point of a facet.
struct Point {
    Scene scene;
    SphereFacet facet;
};

Point facet_point(const Rgb& reflectivity) {
    Scene scene = furnace_sphere(reflectivity, EMISSION, RADIUS, LEVELS);
    const SphereFacet facet = find_facet(scene, V3d(0.4, 0.3, -0.85));
    SceneBuilder camera;
    camera.camera(V3d(0, 0, 0), facet.foot, 1e-6);
    scene.cameras = camera.finish().cameras;
    return {std::move(scene), facet};
}

// Needs no device.
TEST(FurnaceRadiometry, EqualsItsClosedForm) {
    for (const Rgb& reflectivity : REFLECTIVITIES) {
        const Radiometry radiometry =
            compute_radiometry(furnace_sphere(reflectivity, EMISSION, RADIUS, LEVELS));
        for (int c = 0; c < 3; ++c) {
            const auto r = static_cast<double>(reflectivity[c]);
            const auto e = static_cast<double>(EMISSION[c]);
            EXPECT_NEAR(radiometry.average_reflectivity[c], r, 1e-12 * r);
            EXPECT_NEAR(radiometry.ambient_bleeding[c], e / (1 - r), 1e-12 * e / (1 - r));
            EXPECT_NEAR(radiometry.ambient_colourless[c], e * r / (1 - r), 1e-12 * e * r / (1 - r));
        }
    }
}

TEST_F(Furnace, LightEqualsItsClosedForm) {
    ZTable table;
    uint64_t seed = 0;
    for (const Rgb& reflectivity : REFLECTIVITIES) {
        const Point point = facet_point(reflectivity);
        for (const double sigma : {0.5, 1.0, 2.0}) {
            RenderSettings settings = furnace_settings(4, 4, 2 * static_cast<double>(RADIUS) / sigma);
            for (const Falloff& falloff : ALL_FALLOFFS) {
                const Bracket w = facet_obscurance(point.facet, falloff, settings.d_max.value);
                for (const bool bleeding : {true, false}) {
                    settings.bleeding = bleeding;
                    settings.falloff = falloff;
                    settings.seed = seed++;
                    const RenderResult result =
                        render(point.scene, settings, {"emission", "direct", "ambient"});
                    for (int c = 0; c < 3; ++c) {
                        const auto i = static_cast<size_t>(c);
                        const auto r = static_cast<double>(reflectivity[c]);
                        const auto e = static_cast<double>(EMISSION[c]);
                        const std::string name =
                            fmt::format("R {}, sigma {}, {}, bleeding {}: ", reflectivity[c], sigma,
                                        falloff_text(falloff), bleeding);
                        // Float rounding of products and sums, relative to the largest value.
                        const double bounced = e * r * r / (1 - r);
                        const double rounding = 1e-6 * (e / (1 - r));
                        table.add(name + "emission", channel(result.image, "emission", i), e, e, rounding);
                        table.add(name + "direct", channel(result.image, "direct", i), e * r, e * r,
                                  rounding);
                        table.add(name + "ambient", channel(result.image, "ambient", i), bounced * w.low,
                                  bounced * w.high, rounding);
                        table.add(name + "beauty", channel(result.image, "", i),
                                  e * (1 + r) + bounced * w.low, e * (1 + r) + bounced * w.high, rounding);
                    }
                }
            }
        }
    }
    EXPECT_EQ(table.size(), 2u * 3 * ALL_FALLOFFS.size() * 2 * 3 * 4);
    table.expect_no_failure();
    table.expect_one_percent_matters();
}

TEST_F(Furnace, OnePercentOfDistanceIsDetected) {
    const Point point = facet_point(REFLECTIVITIES[1]);
    RenderSettings settings = furnace_settings(4, 4, 4.04);
    settings.falloff.kind = FalloffKind::sqrt;
    const RenderResult result = render(point.scene, settings, {"ambient"});
    const Bracket w = facet_obscurance(point.facet, settings.falloff, 4);
    const auto r = static_cast<double>(REFLECTIVITIES[1].x);
    const double bounced = static_cast<double>(EMISSION.x) * r * r / (1 - r);
    ZTable table;
    table.add("ambient", channel(result.image, "ambient", 0), bounced * w.low, bounced * w.high,
              1e-6 * bounced);
    EXPECT_FALSE(table.failures().empty());
}

// From here on the whole sphere is seen.
TEST_F(Furnace, NothingWithinReachGivesTheFullAmbientLight) {
    for (const Rgb& reflectivity : REFLECTIVITIES) {
        const Scene scene = furnace_sphere(reflectivity, EMISSION, RADIUS, LEVELS);
        RenderSettings settings = furnace_settings(16, 12, 1e-5);
        for (const bool bleeding : {true, false}) {
            settings.bleeding = bleeding;
            const RenderResult result = render(scene, settings, {"ambient"});
            for (int c = 0; c < 3; ++c) {
                const auto r = static_cast<double>(reflectivity[c]);
                const double bounced = static_cast<double>(EMISSION[c]) * r * r / (1 - r);
                for (const double value : channel(result.image, "ambient", static_cast<size_t>(c)))
                    EXPECT_NEAR(value, bounced, 1e-5 * bounced);
            }
        }
    }
}

TEST_F(Furnace, StepClosesASphereWithinReach) {
    for (const double d_max : {2.0, 4.0, std::numeric_limits<double>::infinity()}) {
        RenderSettings settings = furnace_settings(16, 12, d_max);
        if (std::isinf(d_max)) settings.d_max = parse_max_distance("inf");
        settings.falloff.kind = FalloffKind::step;
        for (const bool bleeding : {true, false}) {
            settings.bleeding = bleeding;
            const Scene scene = furnace_sphere(REFLECTIVITIES[1], EMISSION, RADIUS, LEVELS);
            const RenderResult result = render(scene, settings, {"ambient", "ao"});
            EXPECT_EQ(channel(result.image, "ao", 0), std::vector<double>(16 * 12, 0.0));
            EXPECT_EQ(channel(result.image, "ambient", 0), std::vector<double>(16 * 12, 0.0));
        }
    }
}

TEST_F(Furnace, DirectLightIsUniform) {
    const Rgb reflectivity = REFLECTIVITIES[1];
    RenderSettings settings = furnace_settings(16, 12, 1);
    settings.obscurance = false;
    std::array<std::vector<double>, 3> means;  // of the picture, for 16 seeds
    for (settings.seed = 0; settings.seed < 16; ++settings.seed) {
        const RenderResult result =
            render(furnace_sphere(reflectivity, EMISSION, RADIUS, LEVELS), settings, {"direct"});
        for (size_t c = 0; c < 3; ++c)
            means[c].push_back(estimate(channel(result.image, "direct", c)).mean);
    }
    ZTable table;
    for (int c = 0; c < 3; ++c) {
        const double expected = static_cast<double>(EMISSION[c]) * static_cast<double>(reflectivity[c]);
        table.add(fmt::format("channel {}", c), means[static_cast<size_t>(c)], expected, expected,
                  1e-6 * expected);
    }
    table.expect_no_failure();
}

// Where light is reflected for ever, what needs no ambient light is still known.
TEST_F(Furnace, WhiteWallsNeedAnAmbientLight) {
    const Scene scene = furnace_sphere(Rgb(1), EMISSION, RADIUS, LEVELS);
    RenderSettings settings = furnace_settings(4, 4, 1);
    EXPECT_INPUT_ERROR(render(scene, settings), "red channel reaches 1");
    settings.ambient_light = Rgb(0.25f);
    settings.d_max.value = 1e-5;
    for (const double value : channel(render(scene, settings, {"ambient"}).image, "ambient", 2))
        EXPECT_NEAR(value, 0.25, 1e-6);
    settings.obscurance = false;
    const std::vector<double> red = channel(render(scene, settings).image, "", 0);
    EXPECT_NEAR(estimate(red).mean, 2, 0.05) << "emission and its first reflection";
}

}  // namespace
}  // namespace obscura::test
