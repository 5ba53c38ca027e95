// SPDX-License-Identifier: Apache-2.0
// The first hit's facts - coverage, position, depth, normals, albedo - are what geometry and materials say they are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scene/albedo_table.h"
#include "scene/material.h"
#include "support/render.h"
#include "support/scene_builder.h"
#include "support/statistics.h"

namespace obscura::test {
namespace {

using FirstHit = DeviceTest;

// 16 x 12 pixels of 1 m each, seen along -z; (0, 0) is the middle of the picture.
Camera metre_camera() {
    SceneBuilder builder;
    builder.camera({0, 0, 10}, {0, 0, 0});
    Camera camera = builder.finish().cameras.front();
    camera.orthographic = true;
    camera.half_height = 6;
    return camera;
}

TEST_F(FirstHit, AlphaIsCoverage) {
    // Covers columns 4 .. 9 whole, 0.7 of column 3 and 0.25 of column 10, in rows 3 .. 8.
    SceneBuilder builder;
    builder.quad({-4.7f, -3, 0}, {6.95f, 0, 0}, {0, 6, 0}, builder.material(matte(Rgb(0.5f))));
    Scene scene = builder.finish();
    scene.cameras = {metre_camera()};
    std::vector<double> left, right;
    for (uint64_t seed = 0; seed < 16; ++seed) {
        RenderSettings settings = picture(16, 12, 16, 1);
        settings.seed = seed;
        const std::vector<double> alpha = channel(render(scene, settings).image, "", 3);
        for (size_t i = 0; i < alpha.size(); ++i) {
            const size_t x = i % 16, y = i / 16;
            const bool row = y >= 3 && y < 9;
            if (row && (x == 3 || x == 10)) continue;
            EXPECT_EQ(alpha[i], row && x > 3 && x < 10 ? 1 : 0) << x << ", " << y;
        }
        left.push_back(alpha[5 * 16 + 3]);
        right.push_back(alpha[5 * 16 + 10]);
    }
    ZTable table;
    table.add("left", left, 0.7, 0.7, 1e-6);
    table.add("right", right, 0.25, 0.25, 1e-6);
    table.expect_no_failure();
}

// A black sheet before a sky: every sample is 0 or the sky's radiance, so alpha tells the variance.
TEST_F(FirstHit, VarianceIsThatOfTheSamples) {
    constexpr uint32_t SPP = 16;
    SceneBuilder builder;
    builder.quad({-4.7f, -3, 0}, {6.95f, 0, 0}, {0, 6, 0}, builder.material(matte(Rgb(0))));
    Scene scene = builder.finish();
    scene.cameras = {metre_camera()};
    RenderSettings settings = picture(16, 12, SPP, 1);
    const Rgb SKY(2, 0.5f, 0);
    settings.background = SKY;
    const Image image = render(scene, settings, {"Variance", "RelativeVariance"}).image;
    const std::vector<double> alpha = channel(image, "", 3);
    size_t mixed = 0;
    for (size_t i = 0; i < alpha.size(); ++i) {
        if (alpha[i] > 0 && alpha[i] < 1) ++mixed;
        for (size_t c = 0; c < 3; ++c) {
            const double sky = static_cast<double>(SKY[static_cast<int>(c)]);
            const double mean = sky * (1 - alpha[i]);
            const double variance = sky * sky * alpha[i] * (1 - alpha[i]) * SPP / (SPP - 1);
            EXPECT_NEAR(channel(image, "", c)[i], mean, 1e-6);
            EXPECT_NEAR(channel(image, "Variance", c)[i], variance, 1e-5);
            EXPECT_NEAR(channel(image, "RelativeVariance", c)[i], mean > 0 ? variance / mean : 0, 1e-5);
        }
    }
    EXPECT_GE(mixed, 12U) << "the sheet's edges";
    settings.spp = 1;
    const Image one = render(scene, settings, {"Variance"}).image;
    EXPECT_EQ(channel(one, "Variance", 0), std::vector<double>(16 * 12, 0.0))
        << "one sample varies from nothing";
}

TEST_F(FirstHit, OfAWallIsWhereItStands) {
    SceneBuilder builder;
    builder.quad({-20, -20, 3}, {40, 0, 0}, {0, 40, 0}, builder.material(matte(Rgb(0.2f, 0.4f, 0.6f))));
    Scene scene = builder.finish();
    scene.cameras = {metre_camera()};
    const Image image = render(scene, picture(16, 12, 8, 1), {"P", "Z", "N", "Ns", "u", "v", "Albedo"}).image;
    for (size_t i = 0; i < 16 * 12; ++i) {
        const double x = static_cast<double>(i % 16) - 7.5, y = 5.5 - static_cast<double>(i / 16);
        const auto value = [&](const char* layer, size_t c) { return channel(image, layer, c)[i]; };
        // Means over the pixel of stratified samples.
        EXPECT_NEAR(value("P", 0), x, 0.15);
        EXPECT_NEAR(value("P", 1), y, 0.15);
        EXPECT_NEAR(value("P", 2), 3, 1e-5);
        EXPECT_NEAR(value("Z", 0), 7, 1e-5);
        EXPECT_NEAR(value("u", 0), (value("P", 0) + 20) / 40, 1e-6);
        EXPECT_NEAR(value("v", 0), (value("P", 1) + 20) / 40, 1e-6);
        for (const char* normal : {"N", "Ns"}) {
            EXPECT_EQ(value(normal, 0), 0);
            EXPECT_EQ(value(normal, 1), 0);
            EXPECT_EQ(value(normal, 2), 1);
        }
        for (size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(value("Albedo", c), 0.2 * static_cast<double>(c + 1), 1e-6);
    }
}

TEST_F(FirstHit, DepthOfAPerspectiveCameraIsAlongItsAxis) {
    SceneBuilder builder;
    builder.quad({-99, 0, 99}, {198, 0, 0}, {0, 0, -198}, builder.material(matte(Rgb(0.5f))));
    const V3d eye(1, 2, 5), target(0, 0.5, 0);
    builder.camera(eye, target, 0.5);
    const Image image = render(builder.finish(), picture(16, 12, 1, 1), {"P", "Z", "N"}).image;
    const V3d forward = (target - eye).normalized();
    for (size_t i = 0; i < 16 * 12; ++i) {
        const V3d p(channel(image, "P", 0)[i], channel(image, "P", 1)[i], channel(image, "P", 2)[i]);
        EXPECT_NEAR(p.y, 0, 1e-6);
        const double depth = (p - eye).dot(forward);
        EXPECT_NEAR(channel(image, "Z", 0)[i], depth, 1e-6 * depth);
        EXPECT_EQ(channel(image, "N", 1)[i], 1);
        // Right of the middle is right, above it is farther.
        const V3d right = forward.cross(V3d(0, 1, 0)).normalized();
        EXPECT_EQ((p - eye).dot(right) > 0, i % 16 >= 8);
        EXPECT_EQ((p - eye).dot(right.cross(forward)) > 0, i / 16 < 6);
    }
}

TEST_F(FirstHit, ShadingNormalOfASmoothSphereIsRadial) {
    SceneBuilder builder;
    builder.sphere({0, 0, 0}, 1, 4, builder.material(matte(Rgb(0.5f))), false, true);
    builder.camera({0, 0, 3}, {0, 0, 0}, 0.4);
    const Image image = render(builder.finish(), picture(16, 16, 1, 1), {"P", "N", "Ns"}).image;
    double facets = 0;
    for (size_t i = 0; i < 16 * 16; ++i) {
        const auto vector = [&](const char* layer) {
            return V3d(channel(image, layer, 0)[i], channel(image, layer, 1)[i], channel(image, layer, 2)[i]);
        };
        const V3d radial = vector("P").normalized();
        EXPECT_LT((vector("Ns") - radial).length(), 1e-3);
        EXPECT_LT((vector("N") - radial).length(), 0.05);
        facets = std::max(facets, (vector("N") - radial).length());
    }
    EXPECT_GT(facets, 0.01);  // the geometric normal stays flat
}

TEST_F(FirstHit, AlbedoIsDiffusePlusSpecular) {
    Material plastic = matte(Rgb(0.2f, 0.5f, 0.8f));
    plastic.specular = 1;
    plastic.roughness = 0.5f;
    for (const Material& material :
         {plastic, metal(Rgb(0.9f, 0.6f, 0.2f), 0.7f), metal(Rgb(0.9f, 0.6f, 0.2f), 0)}) {
        SceneBuilder builder;
        builder.quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, builder.material(material));
        builder.camera({0, 3, 4}, {0, 0, 0}, 1e-6);
        const Image image = render(builder.finish(), picture(1, 1), {"Albedo"}).image;
        const SurfaceModel model = surface_model(material);
        const AlbedoTerms terms = directional_albedo(0.8, static_cast<double>(model.alpha));
        for (int c = 0; c < 3; ++c) {
            const double specular =
                static_cast<double>(model.f0[c]) * terms.a + static_cast<double>(model.f90[c]) * terms.b;
            const double diffuse = static_cast<double>(material.base_color[c]) *
                                   static_cast<double>(model.diffuse_scale[c]) * (1 - specular);
            EXPECT_NEAR(channel(image, "Albedo", static_cast<size_t>(c)).at(0), diffuse + specular, 2e-6);
        }
    }
}

}  // namespace
}  // namespace obscura::test
