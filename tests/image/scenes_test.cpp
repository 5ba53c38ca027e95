// SPDX-License-Identifier: Apache-2.0
// The shipped scenes show what their READMEs promise: closed forms at every pixel, in one picture each.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "reference/oracles.h"
#include "scene/gltf.h"
#include "support/falloffs.h"
#include "support/render.h"
#include "support/sphere_facet.h"
#include "support/statistics.h"

namespace obscura::test {
namespace {

using Scenes = DeviceTest;

// Rays start up to 2e-5 m above a floor of 40 m, whose triangles are 57 m long (kernels/lib/surface.clh): they see that
// much less of what they meet. Distances count from the floor itself. With falloffs whose slope is at most 4 / d_max
// where anything is met, d_max 1 m, that is no more than:
constexpr double LIFT = 1e-4;

Scene shipped(const std::string& name) {
    return load_gltf(find_scene_file(std::string(OBSCURA_SOURCE_DIR "/scenes/") + name));
}

// One camera ray per pixel, so that the layer P is the point whose W the pixel holds.
RenderSettings point_picture(const Falloff& falloff) {
    RenderSettings settings = picture(64, 48, 1, 64);
    settings.falloff = falloff;
    settings.ambient_light = Rgb(1);
    return settings;
}

struct Pixel {
    V3d position;
    double w;
};

// Pixels that see a point within `reach` of the world's axis: far from the rims of the floors.
std::vector<Pixel> obscurances(const Scene& scene, const Falloff& falloff, double reach) {
    const Image image = render(scene, point_picture(falloff), {"ao", "P"}).image;
    const std::vector<double> w = channel(image, "ao", 0), coverage = channel(image, "", 3);
    const std::vector<double> x = channel(image, "P", 0), y = channel(image, "P", 1),
                              z = channel(image, "P", 2);
    std::vector<Pixel> pixels;
    for (size_t i = 0; i < w.size(); ++i)
        if (coverage[i] == 1 && std::abs(x[i]) < reach && std::abs(z[i]) < reach)
            pixels.push_back({V3d(x[i], y[i], z[i]), w[i]});
    EXPECT_GT(pixels.size(), w.size() / 2);
    return pixels;
}

// W of a floor point at distance xi d_max from an infinite wall, for the step and the linear falloff: with
// B = (arccos xi - xi s) / pi the step gives 1 - B.
double beside_wall(FalloffKind kind, double xi) {
    if (xi >= 1) return 1;
    const double s = std::sqrt(1 - xi * xi);
    const double step = 1 - (std::acos(xi) - xi * s) / std::numbers::pi;
    return kind == FalloffKind::step ? step : step + 2 * xi / std::numbers::pi * (std::log((1 + s) / xi) - s);
}

TEST_F(Scenes, PlanesHaveTheirClosedForm) {
    const Scene scene = shipped("planes");
    ZTable table;
    for (const Falloff& falloff : MAIN_FALLOFFS) {
        std::vector<double> values;
        for (const Pixel& pixel : obscurances(scene, falloff, 18))
            values.push_back(pixel.w);
        const double expected = plane_obscurance(falloff, 0.25);
        table.add(falloff_text(falloff), values, expected, expected, LIFT);
    }
    table.expect_no_failure();
    table.expect_one_percent_matters();
}

TEST_F(Scenes, WallDarkensItsFloorByTheClosedForm) {
    const Scene scene = shipped("wall");
    ZTable table;
    for (const Falloff& falloff : {STEP, LINEAR}) {
        EXPECT_NEAR(beside_wall(falloff.kind, 0.3), floor_obscurance(falloff, {{0, 0.3}}), 1e-6);
        std::vector<double> near_wall, far_from_wall;
        for (const Pixel& pixel : obscurances(scene, falloff, 18)) {
            // Floor and wall shade each other alike: what counts is the distance from the other one.
            const double distance = std::max(std::abs(pixel.position.x), std::abs(pixel.position.y));
            (distance < 1 ? near_wall : far_from_wall)
                .push_back(1 + pixel.w - beside_wall(falloff.kind, distance));
        }
        ASSERT_GT(near_wall.size(), 300u);
        ASSERT_GT(far_from_wall.size(), 300u);
        table.add(falloff_text(falloff) + " within reach", near_wall, 1, 1, LIFT);
        table.add(falloff_text(falloff) + " out of reach", far_from_wall, 1, 1, 1e-6);
    }
    table.expect_no_failure();
    table.expect_one_percent_matters();
}

TEST_F(Scenes, FurnaceIsOneConstant) {
    const Scene scene = shipped("furnace");
    // Facets lie up to `dent` inside the sphere, so distances are off by about twice that; directions closer to the
    // facet than half its width, 0.04, meet it elsewhere altogether: a share 0.02^2 of the hemisphere.
    const double dent = 1 - find_facet(scene, V3d(0, 0, -1)).inner;
    const double slack = 4 * dent + 0.02 * 0.02;
    ASSERT_LT(slack, 5e-3);
    ZTable table;
    for (const Falloff& falloff : MAIN_FALLOFFS) {
        RenderSettings settings = picture(32, 24, 4, 16);
        settings.light_samples = 16;
        settings.falloff = falloff;
        settings.d_max.value = 2;
        const Image image = render(scene, settings).image;
        const double w = sphere_obscurance(falloff, 1);
        table.add(falloff_text(falloff), channel(image, "", 0), 1.5 + 0.5 * (w - slack),
                  1.5 + 0.5 * (w + slack), 1e-6);
    }
    RenderSettings settings = picture(32, 24, 4, 1);
    settings.light_samples = 16;
    settings.ambient = Ambient::constant;
    table.add("W = 1", channel(render(scene, settings).image, "", 0), 2, 2, 1e-6);
    table.expect_no_failure();
    table.expect_one_percent_matters();
}

// Above the reach of the floor nothing is near a convex body, however coarse and smoothly shaded it is.
TEST_F(Scenes, SphereDoesNotShadeItself) {
    const Scene scene = shipped("sphere");
    constexpr double REACH = 0.1;
    RenderSettings settings = point_picture(SQRT);
    settings.d_max.value = REACH;
    const Image image = render(scene, settings, {"ao", "P"}).image;
    const std::vector<double> w = channel(image, "ao", 0), y = channel(image, "P", 1);
    size_t body = 0, contact = 0;
    for (size_t i = 0; i < w.size(); ++i) {
        if (y[i] > REACH && y[i] < 1 + 1e-3) {
            ++body;
            EXPECT_EQ(w[i], 1) << "pixel " << i << ", " << y[i] << " m above the floor";
        } else if (w[i] < 1) {
            ++contact;
        }
    }
    EXPECT_GT(body, 200u);
    EXPECT_GT(contact, 0u) << "its contact with the floor is darker";
}

}  // namespace
}  // namespace obscura::test
