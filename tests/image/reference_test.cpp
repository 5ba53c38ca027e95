// SPDX-License-Identifier: Apache-2.0
// The device against the reference renderer, which shares no tracing and no shading with it. With the same random
// numbers pictures agree to rounding, pixel for pixel, but for those where rounding decides what a ray hits; with other
// numbers they agree within their own variance. Where they don't, both pictures and a heat map are left in the build tree.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "film/metrics.h"
#include "scene/gltf.h"
#include "support/busy_room.h"
#include "support/reference_picture.h"
#include "support/render.h"
#include "support/statistics.h"

namespace obscura::test {
namespace {

using Reference = DeviceTest;

// |device - reference| beyond this share of the reference plus a hundredth is a flip. Float geometry accounts for a part in
// 10^5; one of a pixel's dozens of rays that hits something else, for more.
constexpr double TOLERANCE = 1e-4;
constexpr double FLIPPED_PIXELS = 1e-3;  // share, at most
const std::vector<std::string> LAYERS{"emission",        "direct",           "ambient",   "specular.emission",
                                      "specular.direct", "specular.ambient", "obscurance"};

// Returns the folder.
std::filesystem::path save_pictures(const std::string& name, const Image& device, const Image& reference) {
    const std::filesystem::path folder = std::filesystem::path(OBSCURA_BINARY_DIR) / "test-output" / name;
    std::filesystem::create_directories(folder);
    write_exr(device, folder / "device.exr");
    write_exr(reference, folder / "reference.exr");
    write_heat_map_png(device, reference, "", folder / "difference.png");
    return folder;
}

// "specular.direct at (3, 4): 0.5, not 0.25" for each pixel beyond the tolerance.
std::vector<std::string> flips(const Image& device, const Image& reference, const std::string& title,
                               double tolerance) {
    std::vector<std::string> lines;
    const Layer& found = *device.find_layer(title);
    const Layer& expected = *reference.find_layer(title);
    for (size_t pixel = 0; pixel < reference.pixel_count(); ++pixel) {
        for (size_t c = 0; c < 3; ++c) {
            const float value = found.pixels[pixel * found.channel_count() + c];
            const float other = expected.pixels[pixel * expected.channel_count() + c];
            if (relative_error(value, other) <= tolerance) continue;
            const auto width = static_cast<size_t>(reference.width());
            lines.push_back(fmt::format("{} at ({}, {}): {}, not {}", expected.title(), pixel % width,
                                        pixel / width, value, other));
            break;
        }
    }
    return lines;
}

struct Pair {
    Image device, reference;
};

Pair same_numbers(const Scene& scene, const RenderSettings& settings) {
    return {render(scene, settings, LAYERS).image, obscurance_picture(scene, settings)};
}

// Share of pixels where a layer differs, with a line for each of them.
struct Flips {
    double share = 0;
    std::vector<std::string> lines;
};

Flips find_flips(const Pair& pair, double tolerance = TOLERANCE) {
    Flips worst;
    for (const std::string& layer : LAYERS) {
        Flips found{0, flips(pair.device, pair.reference, layer, tolerance)};
        found.share =
            static_cast<double>(found.lines.size()) / static_cast<double>(pair.reference.pixel_count());
        if (found.lines.size() > worst.lines.size()) worst = found;
    }
    return worst;
}

void expect_few_flips(const std::string& name, const Pair& pair, double tolerance, double most) {
    const Flips found = find_flips(pair, tolerance);
    testing::Test::RecordProperty(name + "_flips", static_cast<int>(found.lines.size()));
    if (found.share <= most) return;
    for (size_t i = 0; i < std::min<size_t>(found.lines.size(), 20); ++i)
        ADD_FAILURE() << name << ": " << found.lines[i];
    ADD_FAILURE() << name << ": " << found.lines.size() << " flips of " << pair.reference.pixel_count()
                  << " pixels";
    ADD_FAILURE() << "both pictures are in " << save_pictures(name, pair.device, pair.reference);
}

void expect_same(const std::string& name, const Scene& scene, const RenderSettings& settings) {
    expect_few_flips(name, same_numbers(scene, settings), TOLERANCE, FLIPPED_PIXELS);
}

Scene shipped_scene(const std::string& name) {
    return load_gltf(find_scene_file(std::string(OBSCURA_SOURCE_DIR) + "/scenes/" + name));
}

TEST_F(Reference, SameNumbersGiveSamePixelsInTheCornellBox) {
    const Scene scene = shipped_scene("cornell");
    for (const SamplerKind sampler : {SamplerKind::lattice, SamplerKind::owen, SamplerKind::random}) {
        RenderSettings settings = picture(80, 80, 8, 5);
        settings.sampler = sampler;
        settings.seed = 7 + (uint64_t{1} << 40);
        expect_same(fmt::format("cornell_{}", static_cast<int>(sampler)), scene, settings);
    }
}

TEST_F(Reference, SameNumbersGiveSamePixelsForEveryModel) {
    const Scene scene = shipped_scene("cornell");
    RenderSettings settings = picture(60, 60, 4, 8);
    settings.light_samples = 3;
    for (const char* rho : {"step", "linear", "sqrt", "cbrt", "exp:3", "expjump", "pow:0.3"}) {
        settings.falloff = parse_falloff(rho);
        settings.bleeding = !settings.bleeding;
        expect_same(fmt::format("model_{}", rho), scene, settings);
    }
    settings.d_max = parse_max_distance("inf");
    settings.filter = PixelFilter::gauss;
    settings.crop = {0.2, 0.9, 0.1, 0.8};
    expect_same("model_inf", scene, settings);
    settings.d_max = parse_max_distance("30%");
    settings.ambient = Ambient::constant;
    settings.ambient_scale = 0.5;
    expect_same("model_constant", scene, settings);
    settings.ambient = Ambient::obscurance;
    settings.ambient_light = Rgb(1, 2, 3);
    expect_same("model_ambient_light", scene, settings);
}

TEST_F(Reference, SameNumbersGiveSamePixelsInTheSmallScenes) {
    for (const char* name : {"sphere", "planes", "wall", "furnace"}) {
        RenderSettings settings = picture(60, 45, 4, 8);
        settings.background.reset();  // the sky of a scene without light
        expect_same(name, shipped_scene(name), settings);
    }
}

TEST_F(Reference, SameNumbersGiveSamePixelsInTheBusyRoom) {
    RenderSettings settings = picture(96, 72, 4, 4);
    settings.background = Rgb(0.2f, 0.3f, 0.4f);
    for (const bool roulette : {true, false}) {
        settings.roulette = roulette;
        settings.light_samples = roulette ? 1 : 2;
        expect_same(fmt::format("busy_room_{}", roulette), busy_room(), settings);
    }
}

// They are counted as the queues hold them; rounding decides whether a few exist.
TEST_F(Reference, TracesAsManyRaysAsTheDevice) {
    const Scene scene = busy_room();
    const RenderSettings settings = picture(96, 72, 4, 4);
    const auto counted = static_cast<double>(render(scene, settings).rays.total());
    const reference::ReferenceJob job{scene, settings, IntegratorKind::obscurance};
    const auto rays = static_cast<double>(render_reference(job, [](double, uint64_t) { return true; }).rays);
    EXPECT_NEAR(rays / counted, 1, 1e-3);
}

// Chrome bends rays so much that their rounding shows: one in a thousand pixels is off by a per cent. Such a tolerance
// alone would let a per cent of everything pass.
TEST_F(Reference, SameNumbersGiveSamePixelsInTheKitchen) {
    const Pair pair = same_numbers(shipped_scene("kitchen"), picture(120, 90, 2, 4));
    expect_few_flips("kitchen", pair, 1e-2, FLIPPED_PIXELS);
    expect_few_flips("kitchen_fine", pair, 1e-3, 1e-2);
}

TEST_F(Reference, OnePercentMoreAmbientLightIsFoundPixelByPixel) {
    for (const auto& [name, tolerance] : {std::pair{"cornell", TOLERANCE}, {"kitchen", 1e-3}}) {
        const Scene scene = shipped_scene(name);
        RenderSettings settings = picture(40, 40, 4, 4);
        Pair pair = same_numbers(scene, settings);
        settings.ambient_scale = 1.01;
        pair.device = render(scene, settings, LAYERS).image;
        EXPECT_GT(find_flips(pair, tolerance).share, 0.5) << name;
    }
}

TEST_F(Reference, PicturesThatDifferAreLeftWithAHeatMap) {
    const Scene scene = shipped_scene("cornell");
    const Pair pair = same_numbers(scene, picture(10, 10, 1, 1));
    const std::filesystem::path folder = save_pictures("saved", pair.device, pair.reference);
    for (const char* file : {"device.exr", "reference.exr", "difference.png"})
        EXPECT_TRUE(std::filesystem::exists(folder / file)) << file;
    std::filesystem::remove_all(folder);
}

// A picture's means over 4 x 4 blocks of pixels, channel by channel.
std::vector<double> block_means(const Image& image) {
    constexpr size_t BLOCKS = 4;
    const auto width = static_cast<size_t>(image.width()), height = static_cast<size_t>(image.height());
    std::vector<double> means(3 * BLOCKS * BLOCKS);
    const double share = static_cast<double>(BLOCKS * BLOCKS) / static_cast<double>(width * height);
    for (size_t c = 0; c < 3; ++c) {
        const std::vector<double> values = channel(image, "", c);
        for (size_t y = 0; y < height; ++y) {
            for (size_t x = 0; x < width; ++x) {
                const size_t block = y * BLOCKS / height * BLOCKS + x * BLOCKS / width;
                means[3 * block + c] += share * values[y * width + x];
            }
        }
    }
    return means;
}

// Device and reference with 16 seeds of its own each, 16 samples per seed: of every block the ratio of each pair.
std::vector<std::vector<double>> seed_ratios(const Scene& scene, RenderSettings settings,
                                             double device_ambient_scale) {
    constexpr uint64_t SEEDS = 16;
    settings.spp = 16;
    std::vector<std::vector<double>> ratios;
    for (uint64_t i = 0; i < SEEDS; ++i) {
        settings.seed = 1000 + i;
        const std::vector<double> expected = block_means(obscurance_picture(scene, settings));
        RenderSettings device_settings = settings;
        device_settings.seed = i;
        device_settings.ambient_scale = device_ambient_scale;
        const std::vector<double> found = block_means(render(scene, device_settings).image);
        ratios.resize(found.size());
        for (size_t block = 0; block < found.size(); ++block)
            // Black is black.
            ratios[block].push_back(found[block] == expected[block] ? 1 : found[block] / expected[block]);
    }
    return ratios;
}

ZTable ratio_table(const std::vector<std::vector<double>>& ratios) {
    ZTable table;
    for (size_t block = 0; block < ratios.size(); ++block)
        table.add(fmt::format("block {}, channel {}", block / 3, block % 3), ratios[block], 1, 1, 1e-5);
    return table;
}

void expect_same_light(const std::string& name, const Scene& scene, RenderSettings settings,
                       const std::vector<std::vector<double>>& ratios) {
    const ZTable table = ratio_table(ratios);
    table.expect_no_failure();
    if (table.failures().empty()) return;
    settings.spp = 256;
    const Image device = render(scene, settings).image;
    ++settings.seed;
    ADD_FAILURE() << "both pictures are in "
                  << save_pictures(name, device, obscurance_picture(scene, settings));
}

TEST_F(Reference, OtherNumbersGiveTheSameLight) {
    const Scene scene = shipped_scene("cornell");
    const RenderSettings settings = picture(64, 64, 16, 5);
    const std::vector<std::vector<double>> ratios = seed_ratios(scene, settings, 1);
    expect_same_light("cornell_seeds", scene, settings, ratios);
    // Standard errors that were too large would hide errors. 16 blocks are independent, channels are not.
    double squares = 0;
    for (const std::vector<double>& values : ratios) {
        const Estimate found = estimate(values);
        squares += std::pow((found.mean - 1) / found.standard_error, 2) / static_cast<double>(ratios.size());
    }
    EXPECT_NEAR(squares, 15.0 / 13, 1) << "Student's variance with 15 degrees of freedom";
}

TEST_F(Reference, OtherNumbersGiveTheSameLightInTheBusyRoom) {
    RenderSettings settings = picture(64, 48, 16, 5);
    settings.light_samples = 2;
    const Scene scene = busy_room();
    expect_same_light("busy_room_seeds", scene, settings, seed_ratios(scene, settings, 1));
}

TEST_F(Reference, OtherNumbersGiveTheSameLightInTheKitchen) {
    const RenderSettings settings = picture(64, 48, 16, 5);
    const Scene scene = shipped_scene("kitchen");
    expect_same_light("kitchen_seeds", scene, settings, seed_ratios(scene, settings, 1));
}

TEST_F(Reference, OtherNumbersGiveTheSameLightInTheSmallScenes) {
    for (const char* name : {"sphere", "planes", "wall", "furnace"}) {
        RenderSettings settings = picture(32, 24, 16, 5);
        settings.background.reset();
        const Scene scene = shipped_scene(name);
        expect_same_light(fmt::format("{}_seeds", name), scene, settings, seed_ratios(scene, settings, 1));
    }
}

TEST_F(Reference, OnePercentMoreAmbientLightIsFoundWithOtherNumbers) {
    for (const auto& [name, height] : {std::pair{"cornell", 64u}, {"kitchen", 48u}}) {
        const auto ratios = seed_ratios(shipped_scene(name), picture(64, height, 16, 5), 1.01);
        EXPECT_FALSE(ratio_table(ratios).failures().empty()) << name;
    }
}

}  // namespace
}  // namespace obscura::test
