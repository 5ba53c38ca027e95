// SPDX-License-Identifier: Apache-2.0
// Areas, R_ave, I_A and what the lights put in, against closed forms.
#include "scene/radiometry.h"

#include "scene/material.h"
#include "support/errors.h"
#include "support/scene_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace obscura {
namespace {

using test::matte;
using test::SceneBuilder;

constexpr double PI = std::numbers::pi;

double exact(float value) {
    return static_cast<double>(value);
}

// Volume inside a closed surface by the divergence theorem: negative if the front sides look inwards.
double enclosed_volume(const Scene& scene) {
    double volume = 0;
    for (uint32_t i = 0; i < scene.triangles.size(); ++i)
        volume +=
            V3d(scene.corner(i, 0).position).dot(geometric_normal(scene, i)) * triangle_area(scene, i) / 3;
    return volume;
}

TEST(SceneBuilder, FrontSidesLookAsStated) {
    for (const bool inwards : {false, true}) {
        const double sign = inwards ? -1 : 1;
        SceneBuilder box;
        box.box(V3f(1, 2, 3), V3f(2, 4, 6), box.material(matte(Rgb(0.5f))), inwards);
        EXPECT_NEAR(enclosed_volume(box.finish()), sign * 6, 1e-6);
        SceneBuilder sphere;
        sphere.sphere(V3f(1, 0, 0), 2, 4, sphere.material(matte(Rgb(0.5f))), inwards, true);
        const Scene ball = sphere.finish();
        EXPECT_NEAR(enclosed_volume(ball), sign * 32 * PI / 3, 0.4);
        EXPECT_GT(geometric_normal(ball, 7).dot(V3d(ball.corner(7, 1).normal)), 0.9);
    }
}

TEST(Radiometry, FurnaceHasTheClosedForm) {
    for (const float r : {0.0f, 0.1f, 0.5f, 0.9f, 0.99f, 0.9999f}) {
        const Radiometry result =
            compute_radiometry(test::furnace_sphere(Rgb(r, r / 2, 0), Rgb(2, 3, 1), 1.5f));
        const double expected = exact(r) / (1 - exact(r)) * 2;
        EXPECT_NEAR(result.average_reflectivity.x, exact(r), 1e-12);
        EXPECT_NEAR(result.ambient_colourless.x, expected, 1e-12 * std::max(1.0, expected)) << r;
        EXPECT_NEAR(result.ambient_bleeding.x, 2 / (1 - exact(r)), 1e-12 * 2 / (1 - exact(r))) << r;
        EXPECT_NEAR(result.ambient_bleeding.y, 3 / (1 - exact(r / 2)), 1e-11);
        EXPECT_EQ(result.ambient_colourless.z, 0);
        EXPECT_NEAR(result.ambient_bleeding.z, 1, 1e-12);
        EXPECT_NEAR(result.emitted.x, 2 * result.area, 1e-11 * result.area);
    }
}

TEST(Radiometry, CubeOfDifferentWallsAveragesByArea) {
    SceneBuilder builder;
    const uint32_t lamp = builder.material(matte(Rgb(0, 0, 0), Rgb(10, 10, 10)));
    const uint32_t grey = builder.material(matte(Rgb(0.5f, 0.25f, 0.75f)));
    builder.quad(V3f(0, 2, 0), V3f(1, 0, 0), V3f(0, 0, 1), lamp);  // area 1
    builder.quad(V3f(0, 0, 0), V3f(0, 0, 2), V3f(4, 0, 0), grey);  // area 8
    const Radiometry result = compute_radiometry(builder.finish());
    EXPECT_DOUBLE_EQ(result.area, 9);
    EXPECT_DOUBLE_EQ(result.average_reflectivity.x, 4.0 / 9);
    EXPECT_DOUBLE_EQ(result.average_reflectivity.y, 2.0 / 9);
    EXPECT_DOUBLE_EQ(result.average_reflectivity.z, 6.0 / 9);
    EXPECT_DOUBLE_EQ(result.emitted.x, 10);
    EXPECT_DOUBLE_EQ(result.ambient_bleeding.x, 10.0 / 9 / (5.0 / 9));
    EXPECT_DOUBLE_EQ(result.ambient_colourless.x, 10.0 / 9 / (5.0 / 9) * 4 / 9);
}

TEST(Radiometry, DoubleSidedSheetCountsBothSides) {
    SceneBuilder builder;
    Material sheet = matte(Rgb(0.5f, 0.5f, 0.5f), Rgb(3, 3, 3));
    sheet.double_sided = true;
    builder.quad(V3f(0, 0, 0), V3f(1, 0, 0), V3f(0, 1, 0), builder.material(sheet));
    const Radiometry result = compute_radiometry(builder.finish());
    EXPECT_DOUBLE_EQ(result.area, 2);
    EXPECT_DOUBLE_EQ(result.emitted.x, 6);
    EXPECT_DOUBLE_EQ(result.average_reflectivity.x, 0.5);
}

TEST(Radiometry, UnlitSurfaceHasAreaOnly) {
    SceneBuilder builder;
    Material picture = matte(Rgb(1, 1, 1), Rgb(9, 9, 9));
    picture.transmission = 0.5f;  // that of a pane, which an unlit surface isn't
    picture.unlit = true;
    builder.quad(V3f(0, 0, 0), V3f(1, 0, 0), V3f(0, 1, 0), builder.material(picture));
    builder.quad(V3f(0, 0, 1), V3f(1, 0, 0), V3f(0, 1, 0), builder.material(matte(Rgb(0.5f, 0.5f, 0.5f))));
    const Scene scene = builder.finish();
    const Radiometry result = compute_radiometry(scene);
    EXPECT_DOUBLE_EQ(result.area, 2);
    EXPECT_DOUBLE_EQ(result.average_reflectivity.x, 0.25);
    EXPECT_EQ(result.emitted, RgbD(0, 0, 0));
    EXPECT_FALSE(has_light(scene));
}

TEST(Radiometry, PaneWeighsItsOpacity) {
    SceneBuilder builder;
    Material pane = matte(Rgb(0.5f, 0.5f, 0.5f));
    pane.transmission = 0.75f;
    builder.quad(V3f(0, 0, 0), V3f(1, 0, 0), V3f(0, 1, 0), builder.material(pane));
    const Radiometry result = compute_radiometry(builder.finish());
    const double opacity = 1 - 0.75 * (1 - mean_pane_reflectance());
    EXPECT_NEAR(result.area, opacity, 1e-15);
    EXPECT_NEAR(result.average_reflectivity.x, 0.25 * 0.5 / opacity, 1e-15);
}

TEST(Radiometry, SmallestTriangleCounts) {
    SceneBuilder builder;
    builder.triangle(V3f(0, 0, 0), V3f(1e-20f, 0, 0), V3f(0, 1e-20f, 0),
                     builder.material(matte(Rgb(0.5f), Rgb(1))));
    const Radiometry result = compute_radiometry(builder.finish());
    EXPECT_NEAR(result.area / 0.5e-40, 1, 1e-6);
    EXPECT_NEAR(result.average_reflectivity.x, 0.5, 1e-12);
    EXPECT_NEAR(result.ambient_bleeding.x, 2, 1e-12);
}

TEST(Radiometry, NoTrianglesGiveZeros) {
    const Radiometry result = compute_radiometry(Scene{});
    EXPECT_EQ(result.area, 0);
    EXPECT_EQ(result.average_reflectivity, RgbD(0, 0, 0));
    EXPECT_EQ(result.ambient_bleeding, RgbD(0, 0, 0));
}

TEST(Radiometry, FullReflectivityHasNoFiniteAmbientLight) {
    const Scene scene = test::furnace_sphere(Rgb(0.5f, 1, 0.5f), Rgb(1));
    const Radiometry result = compute_radiometry(scene);
    EXPECT_GT(result.area, 0);
    EXPECT_NEAR(result.average_reflectivity.y, 1, 1e-12);
    EXPECT_NEAR(result.ambient_bleeding.x, 2, 1e-12);
    EXPECT_TRUE(std::isinf(result.ambient_bleeding.y) && std::isinf(result.ambient_colourless.y));
    EXPECT_INPUT_ERROR(check_ambient(scene, result, {}), "green channel reaches 1");
    RenderSettings constant;
    constant.ambient = Ambient::constant;
    EXPECT_INPUT_ERROR(check_ambient(scene, result, constant), "green channel reaches 1");
}

TEST(Radiometry, AmbientLightIsCheckedOnlyWhereItIsNeeded) {
    const Scene scene = test::furnace_sphere(Rgb(0.5f, 1, 0.5f), Rgb(1));
    const Radiometry radiometry = compute_radiometry(scene);
    RenderSettings none, without, given;
    none.ambient = Ambient::none;
    without.obscurance = false;
    given.ambient_light = Rgb(1);
    for (const RenderSettings& settings : {none, without, given})
        EXPECT_NO_THROW(check_ambient(scene, radiometry, settings));
    EXPECT_NEAR(resolve_ambient(radiometry, given).y, 1, 1e-12);
}

TEST(Radiometry, PointLightGivesFourTimesItsIntensity) {
    Scene scene = test::furnace_sphere(Rgb(0.5f), Rgb(0));
    PunctualLight light;
    light.intensity = Rgb(1, 2, 3);
    light.range = 5;
    scene.lights.push_back(light);
    EXPECT_DOUBLE_EQ(compute_radiometry(scene).emitted.y, 8);
    EXPECT_TRUE(has_light(scene));
}

TEST(Radiometry, SpotLightIntegratesItsSoftEdge) {
    for (const auto& [inner, outer] :
         {std::pair{0.0, 0.7}, {0.3, 1.2}, {0.5, 0.5001}, {0.0, 0.02}, {0.0, PI / 2}}) {
        Scene scene = test::furnace_sphere(Rgb(0.5f), Rgb(0));
        PunctualLight light;
        light.type = LightType::spot;
        light.intensity = Rgb(1, 1, 1);
        light.cos_inner = static_cast<float>(std::cos(inner));
        light.cos_outer = static_cast<float>(std::cos(outer));
        scene.lights.push_back(light);
        // KHR_lights_punctual, integrated by the midpoint rule.
        const double scale = 1 / std::max(0.001, exact(light.cos_inner) - exact(light.cos_outer));
        const int count = 1000000;
        double sum = 0;
        for (int i = 0; i < count; ++i) {
            const double cosine = (i + 0.5) / count;
            const double t = std::clamp((cosine - exact(light.cos_outer)) * scale, 0.0, 1.0);
            sum += 2 * PI * t * t / count;
        }
        EXPECT_NEAR(compute_radiometry(scene).emitted.x, sum / PI, 1e-5 * sum) << inner << " " << outer;
    }
}

TEST(Radiometry, DirectionalLightCountsWhatItReachesFirst) {
    SceneBuilder builder;
    const uint32_t grey = builder.material(matte(Rgb(0.5f)));
    builder.box(V3f(-1, 0, -1), V3f(1, 3, 1), grey);                       // a house
    builder.quad(V3f(-0.5f, 1, -0.5f), V3f(1, 0, 0), V3f(0, 0, 1), grey);  // a table in it
    const Scene house = builder.finish();
    EXPECT_NEAR(lit_area(house, V3f(0, -1, 0)), 4, 1e-9);
    EXPECT_NEAR(lit_area(house, V3f(0, 1, 0)), 4, 1e-9);
    EXPECT_NEAR(lit_area(house, V3f(1, 0, 0)), 6, 1e-9);
    const V3f slanted = V3f(1, -1, 0).normalized();
    EXPECT_NEAR(lit_area(house, slanted), (6 + 4) / std::sqrt(2.0), 0.01);
    Scene lit = house;
    PunctualLight sun;
    sun.type = LightType::directional;
    sun.direction = V3f(0, -1, 0);
    sun.intensity = Rgb(2, 2, 2);
    lit.lights.push_back(sun);
    EXPECT_NEAR(compute_radiometry(lit).emitted.x, 2 * 4 / PI, 1e-9);
}

TEST(Radiometry, SilhouetteOfASphereIsADisc) {
    const Scene sphere = test::furnace_sphere(Rgb(0.5f), Rgb(0), 2, 5);
    for (const V3f& direction : {V3f(0, 1, 0), V3f(0.3f, -0.9f, 0.2f), V3f(-1, 0.1f, 0)})
        EXPECT_NEAR(lit_area(sphere, direction), 4 * PI, 0.004 * 4 * PI);
}

TEST(Ambient, BleedingPicksItsOwnFormula) {
    const Radiometry radiometry = compute_radiometry(test::furnace_sphere(Rgb(0.5f, 0.25f, 0), Rgb(1)));
    RenderSettings settings;
    EXPECT_EQ(resolve_ambient(radiometry, settings), radiometry.ambient_bleeding);
    settings.bleeding = false;
    EXPECT_EQ(resolve_ambient(radiometry, settings), radiometry.ambient_colourless);
    settings.ambient_scale = 3;
    EXPECT_EQ(resolve_ambient(radiometry, settings), 3.0 * radiometry.ambient_colourless);
}

TEST(Ambient, ConstantTermIsColourless) {
    const Radiometry radiometry = compute_radiometry(test::furnace_sphere(Rgb(0.5f, 0.25f, 0), Rgb(1)));
    RenderSettings settings;
    settings.ambient = Ambient::constant;
    EXPECT_EQ(resolve_ambient(radiometry, settings), radiometry.ambient_colourless);
}

TEST(Ambient, GivenLightIsTheRadianceAtAnOpenPoint) {
    const Radiometry radiometry = compute_radiometry(test::furnace_sphere(Rgb(0.5f, 0.25f, 0), Rgb(1)));
    RenderSettings settings;
    settings.ambient_light = Rgb(1, 1, 1);
    const RgbD ambient = resolve_ambient(radiometry, settings);
    EXPECT_NEAR(ambient.x * radiometry.average_reflectivity.x, 1, 1e-12);
    EXPECT_NEAR(ambient.y * radiometry.average_reflectivity.y, 1, 1e-12);
    EXPECT_EQ(ambient.z, 0);  // nothing reflects blue
    settings.bleeding = false;
    EXPECT_EQ(resolve_ambient(radiometry, settings), RgbD(1, 1, 1));
}

TEST(DefaultSky, LightsOnlyScenesWithoutLight) {
    const Scene dark = test::furnace_sphere(Rgb(0.5f), Rgb(0));
    testing::internal::CaptureStderr();
    const RenderSettings lit = with_default_sky(dark, {});
    EXPECT_NE(testing::internal::GetCapturedStderr().find("no light"), std::string::npos);
    EXPECT_EQ(lit.background, Rgb(1, 1, 1));
    EXPECT_EQ(lit.ambient_light, Rgb(1, 1, 1));
    RenderSettings own;
    own.background = Rgb(0, 0, 1);
    EXPECT_FALSE(with_default_sky(dark, own).ambient_light.has_value());
    EXPECT_FALSE(with_default_sky(test::furnace_sphere(Rgb(0.5f), Rgb(1)), {}).background.has_value());
}

TEST(TriangleColors, FactorMultipliesTheTexturesMean) {
    SceneBuilder builder;
    Material material = matte(Rgb(0.5f, 1, 0.25f));
    Texture texture{"half",
                    2,
                    1,
                    Wrap::clamp_to_edge,
                    Wrap::clamp_to_edge,
                    TextureFilter::nearest,
                    {255, 255, 255, 255, 0, 0, 0, 255}};
    material.base_color_texture = builder.texture(texture);
    builder.quad(V3f(0, 0, 0), V3f(1, 0, 0), V3f(0, 1, 0), builder.material(material));
    builder.quad(V3f(0, 0, 0), V3f(1, 0, 0), V3f(0, 1, 0), builder.material(matte(Rgb(0.125f))));
    const std::vector<RgbD> colors = triangle_base_colors(builder.finish());
    ASSERT_EQ(colors.size(), 4u);
    // White left half: the triangle below the diagonal has 1/4 of its area there, the other 3/4.
    EXPECT_NEAR(colors[0].x, 0.5 * 0.25, 1e-12);
    EXPECT_NEAR(colors[1].x, 0.5 * 0.75, 1e-12);
    EXPECT_NEAR(colors[1].z, 0.25 * 0.75, 1e-12);
    EXPECT_EQ(colors[2], RgbD(0.125));
}

}  // namespace
}  // namespace obscura
