// SPDX-License-Identifier: Apache-2.0
// The header tells where the picture's points are and how many samples they had.
#include "film/attributes.h"
#include "support/render.h"
#include "support/scene_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace obscura::test {
namespace {

using Header = DeviceTest;

Scene slanted_wall(bool orthographic) {
    SceneBuilder builder;
    builder.quad({-3, -3, -2}, {6, 0, 1}, {0, 6, 0.5f}, builder.material(matte(Rgb(0.5f))));
    builder.camera(V3d(1, 0.5, 3), V3d(0, 0, -1), 0.7);
    Scene scene = builder.finish();
    scene.cameras[0].orthographic = orthographic;
    scene.cameras[0].half_height = 0.75;
    return scene;
}

// What every pixel sees lies, by worldToNDC, in that pixel of the whole picture: (0, 0) is its upper left corner.
TEST_F(Header, WorldToNdcTakesPointsToTheirPixels) {
    for (const bool orthographic : {false, true}) {
        RenderSettings settings = picture(12, 8);
        settings.crop = {0.25, 1, 0.5, 1};
        const Image image = render(slanted_wall(orthographic), settings, {"P"}).image;
        const auto matrix = std::get<M44d>(image.attributes.at(attribute::WORLD_TO_NDC));
        const std::vector<double> x = channel(image, "P", 0), y = channel(image, "P", 1),
                                  z = channel(image, "P", 2);
        ASSERT_EQ(x.size(), 9u * 4u);
        for (size_t i = 0; i < x.size(); ++i) {
            V3d ndc;
            matrix.multVecMatrix(V3d(x[i], y[i], z[i]), ndc);
            const double column = ndc.x * 12 - image.x0, row = ndc.y * 8 - image.y0;
            EXPECT_GE(column, static_cast<double>(i % 9) - 1e-4);
            EXPECT_LE(column, static_cast<double>(i % 9 + 1) + 1e-4);
            EXPECT_GE(row, static_cast<double>(i / 9) - 1e-4);
            EXPECT_LE(row, static_cast<double>(i / 9 + 1) + 1e-4);
        }
    }
}

TEST_F(Header, StoppedPictureTellsTheSamplesTaken) {
    const Scene scene = slanted_wall(false);
    const RenderSettings settings = picture(16, 8, 8);
    // Waves of up to 320 samples on 128 pixels: the first gives every pixel two samples, the next two some pixels six more.
    const RenderJob job{scene, settings, {}, DEFAULT_QUEUE_BYTES, 320};
    const RenderResult result = render_scene(shared_device(), shared_library(64), job,
                                             [](double, const RayCounts& rays) { return rays.camera < 640; });
    const auto& attributes = result.image.attributes;
    EXPECT_EQ(attributes.at(attribute::SPP), Attribute(int64_t{2}));
    EXPECT_EQ(attributes.at(attribute::PLANNED_SPP), Attribute(int64_t{8}));
    EXPECT_EQ(attributes.at(attribute::COMPLETE), Attribute(std::string("no")));
    EXPECT_EQ(render(scene, settings).image.attributes.at(attribute::SPP), Attribute(int64_t{8}));
}

TEST_F(Header, LargestSeedIsKept) {
    RenderSettings settings = picture(2, 2);
    settings.seed = std::numeric_limits<uint64_t>::max();
    const auto& attributes = render(slanted_wall(false), settings).image.attributes;
    EXPECT_EQ(attributes.at(attribute::SEED), Attribute(std::string("18446744073709551615")));
}

// The ledger of the device goes on from render to render, the figures of a render don't.
TEST_F(Header, BytesAreThoseOfTheRender) {
    const Scene scene = slanted_wall(false);
    const uint64_t small = render(scene, picture(8, 8)).bytes.at("film");
    render(scene, picture(64, 64));
    EXPECT_EQ(render(scene, picture(8, 8)).bytes.at("film"), small);
}

}  // namespace
}  // namespace obscura::test
