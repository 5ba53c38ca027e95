// SPDX-License-Identifier: Apache-2.0
// The obscurance W where float arithmetic is short of digits: scenes far from the world's origin, tiny and huge ones,
// coarse and flattened meshes, the ends of R_ave and d_max.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "film/attributes.h"
#include "reference/oracles.h"
#include "scene/local_frame.h"
#include "support/falloffs.h"
#include "support/gltf_load.h"
#include "support/gltf_sphere.h"
#include "support/oracle_geometry.h"
#include "support/render.h"
#include "support/statistics.h"

namespace obscura::test {
namespace {

using HardScenes = DeviceTest;

RenderSettings point_settings(const Falloff& falloff, double d_max) {
    RenderSettings settings = picture(4, 4, 64, 256);
    settings.falloff = falloff;
    settings.d_max.value = d_max;
    settings.ambient_light = Rgb(1);
    settings.direct = false;
    return settings;
}

// A corner of two walls, `reach` metres large, its floor point at (offset, -offset, offset).
OracleGeometry corner(double reach, double offset) {
    const V3d point(offset, -offset, offset);
    SceneBuilder builder;
    const uint32_t material = builder.material(matte(ORACLE_COLOR));
    const auto quad = [&](const V3d& a, const V3d& u, const V3d& v) {
        const V3f corner(point + reach * a);
        builder.quad(corner, V3f(point + reach * (a + u)) - corner, V3f(point + reach * (a + v)) - corner,
                     material);
    };
    quad({-0.05, 0, 0.05}, {0.1, 0, 0}, {0, 0, -0.1});
    quad({0.25, -0.2, -2}, {0, 0, 4}, {0, 2.2, 0});
    quad({-2, -0.2, 0.25}, {4, 0, 0}, {0, 2.2, 0});
    builder.camera(point + V3d(0, reach, 0), point, ONE_POINT_FOV);
    // The closed form is that of the walls as floats have them.
    const double distance = static_cast<double>(static_cast<float>(offset + 0.25 * reach)) - offset;
    const std::vector<Wall> walls{{0, distance}, {std::numbers::pi / 2, distance}};
    return {fmt::format("corner of {:g} m, {:g} m off", reach, offset), builder.finish(),
            [walls](const Falloff& falloff, double d_max) {
                std::vector<Wall> scaled = walls;
                for (Wall& wall : scaled)
                    wall.distance /= d_max;
                const double w = floor_obscurance(falloff, scaled);
                return Bracket{w, w};
            }};
}

void expect_closed_form(const OracleGeometry& geometry, double reach) {
    for (const Falloff& falloff : {STEP, SQRT, EXP}) {
        const RenderResult found = render(geometry.scene, point_settings(falloff, reach), {"ao"});
        const double w = geometry.obscurance(falloff, reach).low;
        const Estimate ao = estimate(channel(found.image, "ao", 0));
        EXPECT_GT(ao.standard_error, 0);
        EXPECT_NEAR(ao.mean, w, 3 * ao.standard_error) << geometry.name << ", " << falloff_text(falloff);
    }
}

TEST_F(HardScenes, ScaledCornersHaveTheirClosedForm) {
    for (const double scale : {1e-6, 1e-4, 1e-2, 1e2, 1e4, 1e6})
        expect_closed_form(corner(scale, 0), scale);
}

// As readers leave them.
TEST_F(HardScenes, CornersFarFromTheOriginHaveTheirClosedForm) {
    for (const double offset : {1e4, 1e5, 1e6, 1e7}) {
        for (const double share : {1e-3, 1e-4}) {
            OracleGeometry far = corner(share * offset, offset);
            move_near_origin(far.scene);
            expect_closed_form(far, share * offset);
        }
    }
}

// The picture tells of the world, not of the frame that it was rendered in.
TEST_F(HardScenes, PositionsAndCameraOfAMovedSceneAreThoseOfTheWorld) {
    constexpr double OFFSET = 1e6;
    OracleGeometry far = corner(1000, OFFSET);
    const M44d world_to_camera = far.scene.cameras[0].camera_to_world.inverse();
    move_near_origin(far.scene);
    EXPECT_NE(far.scene.origin, V3d(0));
    const Image image = render(far.scene, picture(1, 1), {"P"}).image;
    for (size_t axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(channel(image, "P", axis).at(0), axis == 1 ? -OFFSET : OFFSET, 0.0625);
    const auto matrix = std::get<M44d>(image.attributes.at(attribute::WORLD_TO_CAMERA));
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            EXPECT_NEAR(matrix[row][column], world_to_camera[row][column], 1e-9 * OFFSET);
}

// A coarse sphere with the normals of a fine one, from near and at its horizon.
TEST_F(HardScenes, LoneCoarseSphereIsOpenExactly) {
    for (const int levels : {0, 1, 2}) {
        for (const float radius : {1e-3f, 1.0f, 1e3f}) {
            for (const double distance : {1.3, 3.0}) {
                SceneBuilder builder;
                builder.sphere({0.3f * radius, 0, 0}, radius, levels, builder.material(matte(ORACLE_COLOR)),
                               false, true);
                const auto r = static_cast<double>(radius);
                builder.camera(V3d(0.3 * r, 0, distance * r), V3d(0.3 * r, 0, 0), 1.4);
                RenderSettings settings = picture(96, 96, 4, 16);
                settings.falloff = SQRT;
                settings.ambient_light = Rgb(1);
                settings.d_max.value = r;
                const RenderResult found =
                    render(builder.finish(), settings, {"ao", "obscurance", "Ns", "ambient"});
                EXPECT_EQ(channel(found.image, "ao", 0), channel(found.image, "", 3))
                    << levels << ", " << radius;
                for (const Layer& layer : found.image.layers)
                    for (const float value : layer.pixels)
                        ASSERT_TRUE(std::isfinite(value)) << layer.name;
            }
        }
    }
}

// A sphere that its node squeezes to a plate: nothing stands above anything else. Along the axes that is exact; askew,
// rounding crumples the plate, and what starts within 1e-6 of its plane may meet it again.
TEST_F(HardScenes, FlattenedSphereIsOpen) {
    const nlohmann::json turn = {{"rotation", {0.1826, 0.3651, 0.5477, 0.7303}}};
    const auto scale = [](const std::array<double, 3>& factors) {
        return nlohmann::json{{"scale", factors}};
    };
    for (const auto& [chain, tolerance] :
         {std::pair{std::vector{scale({1, 0, 1})}, 0.0},
          {{scale({1, 1e-20, 1}), turn}, 0.0},
          {{scale({1, -1e-20, 1})}, 0.0},
          {{scale({1e-20, 1, 1}), turn}, 0.0},
          {{scale({1e10, 1e-25, 1e10}), turn, scale({1e-10, 1e-10, -1e-10})}, 0.0},
          {{turn, scale({1, 1e-20, 1})}, 1e-5}}) {
        Scene scene = load(sphere_below(chain)).scene;
        scene.materials[0] = matte(ORACLE_COLOR);  // glTF's default is a metal
        for (const V3d& eye : {V3d(2, 2, 1.5), V3d(-2, -2, 1), V3d(2, 0.02, 2)}) {
            SceneBuilder view;
            view.camera(eye, V3d(0));
            scene.cameras = view.finish().cameras;
            RenderSettings settings = picture(48, 48, 4, 64);
            settings.falloff = SQRT;
            settings.ambient_light = Rgb(1);
            const Image image = render(scene, settings, {"ao", "Ns"}).image;
            const std::vector<double> open = channel(image, "ao", 0), covered = channel(image, "", 3);
            EXPECT_GT(*std::ranges::max_element(covered), 0) << nlohmann::json(chain);
            for (size_t i = 0; i < open.size(); ++i)
                ASSERT_NEAR(open[i], covered[i], tolerance) << nlohmann::json(chain) << ", pixel " << i;
            for (const Layer& layer : image.layers)
                for (const float value : layer.pixels)
                    ASSERT_TRUE(std::isfinite(value)) << layer.name;
        }
    }
}

// d_max beyond all usual sizes: nothing in reach, or everything.
TEST_F(HardScenes, FurnaceHoldsForEveryReachAndReflectivity) {
    for (const float r : {0.9f, 0.99f, 0.9999f}) {
        const Scene scene = furnace_sphere(Rgb(r), Rgb(1), 1, 3);
        const double bounced = static_cast<double>(r) * static_cast<double>(r) / (1 - static_cast<double>(r));
        for (const double d_max : {1e-30, 1e30, std::numeric_limits<double>::infinity()}) {
            for (const Falloff& falloff : {STEP, SQRT, EXP}) {
                RenderSettings settings = picture(8, 8, 4, 16);
                settings.falloff = falloff;
                settings.d_max = {
                    d_max, std::isinf(d_max) ? MaxDistance::Unit::infinite : MaxDistance::Unit::metres};
                const RenderResult found = render(scene, settings, {"ao", "ambient"});
                const double w = d_max < 1 ? 1 : 0;
                for (const double value : channel(found.image, "ambient", 0))
                    ASSERT_NEAR(value / bounced, w, 1e-5)
                        << r << ", " << d_max << ", " << falloff_text(falloff);
            }
        }
    }
}

// A white metal plate below a white sky, and above it a lamp that it reflects. Rougher plates lose what bounces twice;
// nothing ever brings back more than the sky sends.
Image plate(float alpha, bool with_lamp) {
    SceneBuilder builder;
    builder.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, builder.material(metal(Rgb(1), std::sqrt(alpha))));
    if (with_lamp)
        builder.quad({-0.5f, 1, -1}, {1, 0, 0}, {0, 1, 0}, builder.material(matte(Rgb(0), Rgb(5))));
    builder.camera(V3d(0, 0.6, 1.5), V3d(0, 0, 0), 0.6);
    RenderSettings settings = picture(48, 36, 16);
    settings.background = Rgb(1);
    settings.obscurance = false;
    settings.roulette = false;
    return render(builder.finish(), settings).image;
}

TEST_F(HardScenes, RoughnessGoesToTheMirrorWithoutFireflies) {
    double least = 0;
    for (const float alpha : {1.0f, 0.1f, 1e-2f, 1e-3f, 1e-4f, 1e-5f, 1e-6f, 1e-7f, 1e-8f, 0.0f}) {
        const std::vector<double> furnace = channel(plate(alpha, false), "", 0);
        for (const double value : furnace) {
            EXPECT_LE(value, 1 + 1e-6) << alpha;
            EXPECT_GT(value, 0) << alpha;
        }
        const double mean = estimate(furnace).mean;
        EXPECT_GE(mean, least - 1e-6) << alpha;
        least = mean;
        if (alpha <= 1e-3f) {
            EXPECT_NEAR(mean, 1, 1e-5) << alpha;
        }
    }
    const std::vector<double> mirror = channel(plate(0, true), "", 0);
    double before = std::numeric_limits<double>::infinity();
    for (const float alpha : {1e-2f, 1e-4f, 1e-6f, 1e-8f}) {
        const std::vector<double> glossy = channel(plate(alpha, true), "", 0);
        double difference = 0;
        for (size_t i = 0; i < mirror.size(); ++i) {
            // By the power heuristic a light sample brings at most half of the lamp, a lobe sample all of it.
            EXPECT_LE(glossy[i], 1.5 * 5 + 1e-5) << alpha << ", pixel " << i;
            difference += std::abs(glossy[i] - mirror[i]) / static_cast<double>(mirror.size());
        }
        EXPECT_LE(difference, before) << alpha;
        before = difference;
    }
    EXPECT_LT(before, 1e-3);
}

}  // namespace
}  // namespace obscura::test
