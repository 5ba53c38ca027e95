// SPDX-License-Identifier: Apache-2.0
// Layers: six of them partition beauty, switches take whole layers away and leave the others' very bits, and a
// render that is stopped early is a whole picture.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "film/develop.h"
#include "support/busy_room.h"
#include "support/render.h"
#include "support/statistics.h"

namespace obscura::test {
namespace {

using Layers = DeviceTest;

const std::vector<std::string> BEAUTY_PARTS{"emission",          "direct",          "ambient",
                                            "specular.emission", "specular.direct", "specular.ambient"};

// They change with whatever changes beauty.
const std::vector<std::string> VARIANCES{"Variance", "RelativeVariance"};

std::vector<std::string> every_layer() {
    std::vector<std::string> names;
    for (const LayerInfo& info : layer_table())
        names.emplace_back(info.name);
    return names;
}

RenderSettings room_settings() {
    RenderSettings settings = picture(64, 48, 4, 4);
    settings.background = Rgb(0.2f, 0.3f, 0.4f);
    return settings;
}

Image render_room(const RenderSettings& settings) {
    static const Scene room = busy_room();
    return render(room, settings, every_layer()).image;
}

// |beauty - sum of the parts| within the rounding of five float additions, in every pixel.
void expect_beauty_is_sum_of(const Image& beauty, const Image& parts, const std::vector<std::string>& names) {
    for (size_t c = 0; c < 3; ++c) {
        const std::vector<double> whole = channel(beauty, "", c);
        std::vector<double> sum(whole.size(), 0.0);
        for (const std::string& name : names) {
            const std::vector<double> part = channel(parts, name, c);
            for (size_t i = 0; i < sum.size(); ++i)
                sum[i] += part[i];
        }
        for (size_t i = 0; i < sum.size(); ++i)
            EXPECT_NEAR(whole[i], sum[i], 5 * std::ldexp(sum[i], -24)) << "pixel " << i;
    }
}

void expect_same_layers(const Image& image, const Image& expected, const std::vector<std::string>& names) {
    for (const std::string& name : names)
        EXPECT_EQ(image.find_layer(name)->pixels, expected.find_layer(name)->pixels) << name;
}

void expect_black(const Image& image, const std::vector<std::string>& names) {
    for (const std::string& name : names) {
        const std::vector<float>& pixels = image.find_layer(name)->pixels;
        EXPECT_EQ(pixels, std::vector<float>(pixels.size(), 0.0f)) << name;
    }
}

std::vector<std::string> without(std::vector<std::string> names, const std::vector<std::string>& removed) {
    std::erase_if(names,
                  [&](const std::string& name) { return std::ranges::find(removed, name) != removed.end(); });
    return names;
}

// The switch blackens its layers, leaves every other layer as it is except those in `changed`, and beauty is what
// remains.
void expect_takes_away(const RenderSettings& settings, const std::vector<std::string>& removed,
                       const std::vector<std::string>& changed = {}) {
    const Image all = render_room(room_settings());
    const Image image = render_room(settings);
    expect_black(image, removed);
    expect_same_layers(image, all, without(without(without(every_layer(), removed), changed), VARIANCES));
    expect_beauty_is_sum_of(image, all, without(BEAUTY_PARTS, removed));
    for (const std::string& name : removed)
        EXPECT_GT(estimate(channel(all, name, 0)).mean, 1e-3) << name;
}

TEST_F(Layers, SixOfThemAddUpToBeauty) {
    const Image image = render_room(room_settings());
    expect_beauty_is_sum_of(image, image, BEAUTY_PARTS);
}

TEST_F(Layers, NoDirectTakesDirectAway) {
    RenderSettings settings = room_settings();
    settings.direct = false;
    expect_takes_away(settings, {"direct", "specular.direct"});
}

TEST_F(Layers, NoSpecularTakesReflectionsAway) {
    RenderSettings settings = room_settings();
    settings.specular = false;
    // Mirrors show the W of what they reflect, until they reflect nothing.
    expect_takes_away(settings, {"specular.emission", "specular.direct", "specular.ambient"},
                      {"obscurance", "ao"});
}

TEST_F(Layers, NoObscuranceTakesAmbientAway) {
    RenderSettings settings = room_settings();
    settings.obscurance = false;
    expect_takes_away(settings, {"ambient", "specular.ambient", "obscurance", "ao"});
    settings.obscurance = true;
    settings.ambient = Ambient::none;
    expect_takes_away(settings, {"ambient", "specular.ambient", "obscurance", "ao"});
}

TEST_F(Layers, SwitchesAreIndependent) {
    RenderSettings settings = room_settings();
    settings.direct = false;
    settings.obscurance = false;
    expect_takes_away(settings,
                      {"direct", "specular.direct", "ambient", "specular.ambient", "obscurance", "ao"});
}

// Matte surfaces, an emitter above.
Scene matte_scene() {
    SceneBuilder builder;
    builder.box({-1, 0, -1}, {0, 1, 0}, builder.material(matte(Rgb(0.8f, 0.2f, 0.4f))));
    builder.quad({-9, 0, 9}, {18, 0, 0}, {0, 0, -18}, builder.material(matte(Rgb(0.5f, 0.6f, 0.7f))));
    builder.quad({-1, 4, -1}, {2, 0, 0}, {0, 0, 2}, builder.material(matte(Rgb(0), Rgb(20))));
    builder.camera({1, 2, 5}, {0, 0.5, 0});
    return builder.finish();
}

TEST_F(Layers, ConstantAmbientIsAlbedoTimesFormulaThree) {
    for (const bool bleeding : {true, false}) {
        RenderSettings settings = picture(48, 36, 2, 4);
        settings.ambient = Ambient::constant;
        settings.bleeding = bleeding;
        const RenderResult result = render(matte_scene(), settings, {"ambient", "Albedo"});
        for (size_t c = 0; c < 3; ++c) {
            const double intensity = result.radiometry.ambient_colourless[static_cast<int>(c)];
            const std::vector<double> ambient = channel(result.image, "ambient", c);
            const std::vector<double> albedo = channel(result.image, "Albedo", c);
            for (size_t i = 0; i < ambient.size(); ++i)
                EXPECT_NEAR(ambient[i], albedo[i] * intensity, 1e-6 * intensity);
        }
    }
}

TEST_F(Layers, AmbientIsAlbedoTimesObscuranceTimesIntensity) {
    for (const bool bleeding : {true, false}) {
        RenderSettings settings = picture(48, 36, 1, 16);
        settings.bleeding = bleeding;
        const RenderResult result = render(matte_scene(), settings, {"ambient", "Albedo", "obscurance"});
        const RgbD intensity = resolve_ambient(result.radiometry, settings);
        for (size_t c = 0; c < 3; ++c) {
            const std::vector<double> ambient = channel(result.image, "ambient", c);
            const std::vector<double> albedo = channel(result.image, "Albedo", c);
            const std::vector<double> obscurance = channel(result.image, "obscurance", c);
            for (size_t i = 0; i < ambient.size(); ++i) {
                const double expected = albedo[i] * obscurance[i] * intensity[static_cast<int>(c)];
                EXPECT_NEAR(ambient[i], expected, 1e-6 * expected);
            }
        }
    }
}

TEST_F(Layers, BleedingChangesColoursOnly) {
    RenderSettings settings = room_settings();
    const Image with = render_room(settings);
    settings.bleeding = false;
    const Image off = render_room(settings);
    const std::vector<std::string> coloured{"ambient", "specular.ambient", "obscurance"};
    expect_same_layers(off, with, without(without(every_layer(), coloured), VARIANCES));
    EXPECT_NE(off.find_layer("ambient")->pixels, with.find_layer("ambient")->pixels);
}

TEST_F(Layers, ObscuranceWithoutBleedingIsColourless) {
    RenderSettings settings = picture(48, 36, 2, 4);
    settings.bleeding = false;
    const Image image = render(matte_scene(), settings, {"obscurance", "ao"}).image;
    for (size_t c = 0; c < 3; ++c)
        EXPECT_EQ(channel(image, "obscurance", c), channel(image, "ao", 0));
}

RenderResult render_until(const Scene& scene, const RenderSettings& settings, uint64_t wave_size,
                          double fraction) {
    const RenderJob job{scene, settings, every_layer(), DEFAULT_QUEUE_BYTES, wave_size};
    return render_scene(shared_device(), shared_library(64), job,
                        [&](double done, const RayCounts&) { return done < fraction; });
}

TEST_F(Layers, StoppedRenderIsAWholePicture) {
    const RenderSettings settings = room_settings();
    const Scene room = busy_room();
    // Stops in the middle of the second of four passes: half of the pixels have two samples, the others one.
    const RenderResult stopped = render_until(room, settings, 64 * 48 / 2, 0.3);
    EXPECT_FALSE(stopped.complete);
    EXPECT_EQ(stopped.samples_per_pixel, 1u);
    EXPECT_EQ(stopped.rays.camera, uint64_t{64 * 48 * 3 / 2});
    EXPECT_EQ(attribute_text(stopped.image.attributes.at("complete")), "no");
    const Image whole = render_room(settings);
    for (const Layer& layer : stopped.image.layers) {
        ASSERT_EQ(layer.pixels.size(), whole.find_layer(layer.name)->pixels.size());
        EXPECT_TRUE(std::ranges::all_of(layer.pixels, [](float v) { return std::isfinite(v); }))
            << layer.title();
        // A pixel with one sample shows no variance.
        if (std::ranges::find(VARIANCES, layer.name) != VARIANCES.end()) continue;
        for (size_t c = 0; c < layer.channel_count(); ++c) {
            // Means, not sums: each half of the picture agrees with that of the whole render.
            const std::vector<double> found = channel(stopped.image, layer.name, c);
            const std::vector<double> expected = channel(whole, layer.name, c);
            const auto half = static_cast<std::ptrdiff_t>(found.size() / 2);
            for (const std::ptrdiff_t from : {std::ptrdiff_t{0}, half}) {
                const Estimate a = estimate({found.begin() + from, found.begin() + from + half});
                const Estimate b = estimate({expected.begin() + from, expected.begin() + from + half});
                EXPECT_NEAR(a.mean, b.mean, 4 * (a.standard_error + b.standard_error))
                    << layer.channel_path(c);
            }
        }
    }
}

TEST_F(Layers, StoppedRenderKeepsExactMeans) {
    // All pixels see the same constant: whatever number of samples each has, the mean is the constant.
    const Scene scene = furnace_sphere(Rgb(0.5f), Rgb(1, 2, 4));
    const RenderResult stopped = render_until(scene, picture(16, 12, 8, 1), 100, 0.3);
    EXPECT_FALSE(stopped.complete);
    EXPECT_EQ(stopped.samples_per_pixel, 1u);
    EXPECT_EQ(channel(stopped.image, "", 3), std::vector<double>(16 * 12, 1.0));
    EXPECT_EQ(channel(stopped.image, "emission", 2), std::vector<double>(16 * 12, 4.0));
    EXPECT_EQ(stopped.rays.camera, uint64_t{16 * 12 + 3 * 14 * 7}) << "seven more of three waves of pixels";
}

TEST_F(Layers, FinishedRenderIsComplete) {
    const RenderResult result = render(matte_scene(), picture(8, 6, 2, 1));
    EXPECT_TRUE(result.complete);
    EXPECT_EQ(attribute_text(result.image.attributes.at("complete")), "yes");
    EXPECT_EQ(result.rays.camera, uint64_t{8 * 6 * 2});
}

}  // namespace
}  // namespace obscura::test
