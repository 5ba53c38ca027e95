// SPDX-License-Identifier: Apache-2.0
// What changes only speed or memory changes no bit of a picture, in any layer: wave size, local size, memory, pruning
// by needs, instructions of one processor, the tree over the triangles, crops merged into one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "scene/material.h"
#include "support/busy_room.h"
#include "support/render.h"
#include "support/same_bits.h"

namespace obscura::test {
namespace {

using Identity = DeviceTest;

constexpr uint32_t WIDTH = 96, HEIGHT = 72;

RenderSettings room_settings() {
    RenderSettings settings = picture(WIDTH, HEIGHT, 4, 3);
    settings.light_samples = 2;
    settings.background = Rgb(0.2f, 0.3f, 0.4f);
    settings.filter = PixelFilter::gauss;
    return settings;
}

Image render_room(const RenderSettings& settings, const RenderCut& cut = {}) {
    static const Scene room = busy_room();
    return render(room, settings, every_layer(), cut).image;
}

const Image& reference() {
    static const Image image = render_room(room_settings());
    return image;
}

TEST_F(Identity, PictureShowsEveryLayer) {
    for (const Layer& layer : reference().layers) {
        for (size_t c = 0; c < layer.channel_count(); ++c) {
            const std::vector<double> values = channel(reference(), layer.name, c);
            EXPECT_TRUE(std::ranges::all_of(values, [](double v) { return std::isfinite(v); }));
            EXPECT_NE(std::ranges::min(values), std::ranges::max(values)) << layer.channel_path(c);
        }
    }
}

TEST_F(Identity, AnotherSeedChangesThePicture) {
    RenderSettings settings = room_settings();
    settings.seed = 1;
    EXPECT_NE(render_room(settings).layers[0].pixels, reference().layers[0].pixels);
}

TEST_F(Identity, SamePictureAgain) {
    expect_same_bits(render_room(room_settings()), reference());
}

TEST_F(Identity, SamePictureForEveryWaveSize) {
    // Much less than a row, no multiple of anything, and more than a pass over the picture.
    for (const uint64_t wave_size : {uint64_t{64}, uint64_t{1001}, uint64_t{WIDTH * HEIGHT + 17}})
        expect_same_bits(render_room(room_settings(), {.wave_size = wave_size}), reference());
}

TEST_F(Identity, SamePictureForEveryLocalSize) {
    for (const uint32_t local_size : {16u, 32u, 128u})
        expect_same_bits(render_room(room_settings(), {.local_size = local_size}), reference());
}

TEST_F(Identity, SamePictureForEveryMemoryLimit) {
    const Scene room = busy_room();
    for (const uint64_t bytes : {uint64_t{256} << 10, uint64_t{3} << 20}) {
        const RenderResult result = render(room, room_settings(), every_layer(), {.queue_bytes = bytes});
        EXPECT_LT(result.wave_capacity, WIDTH * HEIGHT);
        expect_same_bits(result.image, reference());
    }
}

TEST_F(Identity, SamePictureWithPortableKernels) {
    expect_same_bits(render_room(room_settings(), {.portable = true}), reference());
}

TEST_F(Identity, SamePictureForEveryQualityOfTheTree) {
    for (const BvhQuality quality : {BvhQuality::low, BvhQuality::medium})
        expect_same_bits(render_room(room_settings(), {.bvh_quality = quality}), reference());
}

// Sheets of many colours in one plane: every hit is a tie.
TEST_F(Identity, SameSheetOfSeveralInOnePlaneForEveryQualityOfTheTree) {
    SceneBuilder builder;
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int i = 0; i < 100; ++i) {
        const Rgb color(unit(random), unit(random), unit(random));
        builder.quad({2 * unit(random) - 2, 0, 2 - 2 * unit(random)}, {1 + unit(random), 0, 0},
                     {0, 0, -1 - unit(random)}, builder.material(matte(color)));
    }
    builder.camera({0, 2, 0}, {0, 0, 0}, 1.2);
    const Scene sheets = builder.finish();
    RenderSettings settings = picture(WIDTH, HEIGHT, 4, 3);
    settings.ambient_light = Rgb(1);
    const Image expected = render(sheets, settings, every_layer()).image;
    for (const BvhQuality quality : {BvhQuality::low, BvhQuality::medium})
        expect_same_bits(render(sheets, settings, every_layer(), {.bvh_quality = quality}).image, expected);
}

// Lights keep their order, which the choice among them depends on.
Scene shuffled(const Scene& scene, uint32_t seed) {
    std::vector<size_t> places;
    for (size_t i = 0; i < scene.triangles.size(); ++i)
        if (!is_emissive(scene.materials[scene.triangles[i].material])) places.push_back(i);
    std::vector<size_t> order = places;
    std::shuffle(order.begin(), order.end(), std::mt19937(seed));
    Scene result = scene;
    for (size_t i = 0; i < places.size(); ++i)
        result.triangles[places[i]] = scene.triangles[order[i]];
    return result;
}

TEST_F(Identity, SamePictureForEveryOrderOfTriangles) {
    for (const uint32_t seed : {1u, 2u, 3u})
        expect_same_bits(render(shuffled(busy_room(), seed), room_settings(), every_layer()).image,
                         reference());
}

TEST_F(Identity, SamePictureMergedFromCrops) {
    std::vector<Image> parts;
    // A corner that is no multiple of a pixel, and the rest in two pieces.
    for (const CropWindow& crop :
         {CropWindow{0, 0.37, 0, 0.61}, CropWindow{0.37, 1, 0, 0.61}, CropWindow{0, 1, 0.61, 1}}) {
        RenderSettings settings = room_settings();
        settings.crop = crop;
        parts.push_back(render_room(settings));
    }
    expect_same_bits(merge_images(parts, {"left", "right", "bottom"}), reference());
}

TEST_F(Identity, SamePictureWithAllNeeds) {
    RenderSettings settings = room_settings();
    settings.needs = NeedsMode::all;
    expect_same_bits(render_room(settings), reference());
}

// Kernels with all falloffs find out only then that any occluder will do, behind panes too.
TEST_F(Identity, SameAmbientOcclusionWithAllNeeds) {
    RenderSettings settings = room_settings();
    settings.falloff.kind = FalloffKind::step;
    const Image pruned = render_room(settings);
    settings.needs = NeedsMode::all;
    expect_same_bits(render_room(settings), pruned);
}

// The room needs nearly everything; these settings and scenes need little.
TEST_F(Identity, SamePictureWithAllNeedsWherePruningCutsMost) {
    const Scene furnace = furnace_sphere(Rgb(0.5f, 0.3f, 0.2f), Rgb(1, 2, 3));
    SceneBuilder builder;
    builder.box({-1, -1, -1}, {1, 1, 1}, builder.material(matte(Rgb(0.5f))));
    builder.light(point_light({2, 3, 4}, Rgb(9)));
    builder.camera({2, 3, 4}, {0, 0, 0});
    const Scene box = builder.finish();
    // An unlit poster and an unlit sheet with a transmission that doesn't count, between a floor and its lamp.
    SceneBuilder posters;
    Material poster = matte(Rgb(0.9f, 0.5f, 0.1f));
    poster.specular = 1;
    poster.unlit = true;
    Material sheet = poster;
    sheet.transmission = 0.8f;
    sheet.roughness = 0.3f;
    posters.quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, posters.material(matte(Rgb(0.5f))));
    posters.quad({-2, 0, -1}, {2, 0, 0}, {0, 1, 0}, posters.material(poster));
    posters.quad({-1, 0.5f, 1}, {2, 0, 0}, {0, 0, -2}, posters.material(sheet));
    posters.light(point_light({0.5f, 3, 0}, Rgb(9)));
    posters.camera({2, 3, 4}, {0, 0, 0});
    const Scene gallery = posters.finish();
    std::vector<RenderSettings> list(5, picture(24, 18, 2, 3));
    list[1].bleeding = false;
    list[1].falloff.kind = FalloffKind::step;
    list[2].obscurance = false;
    list[3].direct = list[3].specular = false;
    list[4].ambient = Ambient::constant;
    for (const Scene* scene : {&furnace, &box, &gallery}) {
        for (RenderSettings settings : list) {
            const Image pruned = render(*scene, settings, every_layer()).image;
            settings.needs = NeedsMode::all;
            expect_same_bits(render(*scene, settings, every_layer()).image, pruned);
        }
    }
}

}  // namespace
}  // namespace obscura::test
