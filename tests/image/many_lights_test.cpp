// SPDX-License-Identifier: Apache-2.0
// Direct light of a hundred thousand lamps against the sum over all of them. One more has ten times the power of the
// others together, so that any lack of care in choosing lamps shows where that one can't shine.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "support/analytic_light.h"
#include "support/busy_room.h"
#include "support/lit_point.h"
#include "support/reference_picture.h"
#include "support/statistics.h"

namespace obscura::test {
namespace {

using ManyLights = DeviceTest;

constexpr double ALBEDO = 0.5;
constexpr double ROUNDING = 1e-5;  // relative
constexpr int LAMPS = 100'000;
const RenderCut QUICKLY_BUILT{.bvh_quality = BvhQuality::low};

// Where the bright lamp stands among the others, and whether it shines on the floor's point.
struct Bright {
    bool first, visible;
    std::string name() const {
        return fmt::format("bright one {} and {}", first ? "first" : "last",
                           visible ? "visible" : "turned away");
    }
};
constexpr std::array BRIGHT{Bright{true, true}, Bright{true, false}, Bright{false, true},
                            Bright{false, false}};

struct LitScene {
    Scene scene;
    double direct;  // radiance of the floor's point
};

RenderSettings settings_of(SamplerKind sampler) {
    RenderSettings settings = point_settings(256, 32);
    settings.sampler = sampler;
    return settings;
}

std::vector<double> direct(const Image& image) {
    return channel(image, "direct", 0);
}

// A ceiling of LAMPS triangles, each of its 250 strips of another radiance.
LitScene ceiling(const Bright& bright) {
    constexpr int STRIPS = 250, QUADS = LAMPS / 2 / STRIPS;
    constexpr double A = 1.25, B = 1, HEIGHT = 1, WIDTH = 2 * A / STRIPS, LENGTH = 2 * B / QUADS;
    const auto radiance = [](int strip) { return 1.0 + strip % 7; };
    SceneBuilder builder = floor_scene(matte(Rgb(static_cast<float>(ALBEDO))));
    std::array<uint32_t, 7> lamps{};
    for (int i = 0; i < 7; ++i)
        lamps[static_cast<size_t>(i)] = builder.material(matte(Rgb(0), Rgb(static_cast<float>(radiance(i)))));

    // Beside the ceiling, so that it hides nothing of it.
    constexpr double SIDE = 0.01;
    constexpr double BRIGHT_RADIANCE =
        10 * 4 * 4 * A * B / (SIDE * SIDE);  // 4: mean of the strips' radiances
    const auto add_bright = [&] {
        const uint32_t material = builder.material(matte(Rgb(0), Rgb(static_cast<float>(BRIGHT_RADIANCE))));
        const V3f corner(static_cast<float>(A), static_cast<float>(HEIGHT), 0);
        const V3f x(static_cast<float>(SIDE), 0, 0), z(0, 0, static_cast<float>(SIDE));
        bright.visible ? builder.quad(corner, x, z, material) : builder.quad(corner, z, x, material);
    };
    if (bright.first) add_bright();
    for (int i = 0; i < STRIPS; ++i) {
        for (int j = 0; j < QUADS; ++j)
            builder.quad(V3f(V3d(-A + i * WIDTH, HEIGHT, -B + j * LENGTH)),
                         V3f(static_cast<float>(WIDTH), 0, 0), V3f(0, 0, static_cast<float>(LENGTH)),
                         lamps[static_cast<size_t>(i % 7)]);
    }
    if (!bright.first) add_bright();

    const auto factor = [&](double x0, double x1, double b) {
        return parallel_corner_factor(x1, b, HEIGHT) - parallel_corner_factor(x0, b, HEIGHT);
    };
    double sum = bright.visible ? BRIGHT_RADIANCE * factor(A, A + SIDE, SIDE) : 0;
    for (int i = 0; i < STRIPS; ++i)
        sum += radiance(i) * 2 * factor(-A + i * WIDTH, -A + (i + 1) * WIDTH, B);
    return {builder.finish(), ALBEDO * sum};
}

// Irradiance that a lamp sends to the floor's point, at the origin.
double irradiance(const PunctualLight& light) {
    const V3d position(light.position);
    const double distance = position.length();
    double fade = 1;
    if (light.range > 0) fade = std::max(0.0, 1 - std::pow(distance / static_cast<double>(light.range), 4));
    if (light.type == LightType::spot) {
        const double outer = static_cast<double>(light.cos_outer);
        const double cosine = -position.dot(V3d(light.direction)) / distance;
        const double cone =
            std::clamp((cosine - outer) / (static_cast<double>(light.cos_inner) - outer), 0.0, 1.0);
        fade *= cone * cone;
    }
    const double cosine = std::max(0.0, position.y / distance);
    return static_cast<double>(light.intensity.x) * fade * cosine / (distance * distance);
}

// LAMPS lamps in a slab above the floor: points with and without range, and spots. Each tenth is dark, the first and the
// last too.
LitScene cloud_of_lamps(const Bright& bright) {
    std::vector<PunctualLight> lights;
    double intensity = 0;
    for (int i = 0; i < LAMPS; ++i) {
        // Spread by the golden ratio and its powers (Roberts 2018).
        const auto fraction = [i](double step) { return std::fmod(i * step, 1.0); };
        const V3f position(
            V3d(fraction(0.8191725134) - 0.5, 1.5 + fraction(0.6710436067), fraction(0.5497004779) - 0.5));
        const bool dark = i % 10 == 0 || i == LAMPS - 1;
        const Rgb color(dark ? 0.0f : static_cast<float>(1 + i % 7));
        PunctualLight light =
            i % 3 == 2 ? spot_light(position, -position, color, 0.1f, 0.4f) : point_light(position, color);
        if (i % 3 == 1) light.range = 4;
        intensity += static_cast<double>(color.x);
        lights.push_back(light);
    }
    PunctualLight lamp =
        point_light({0.5f, bright.visible ? 2.0f : -2.0f, 0}, Rgb(static_cast<float>(10 * intensity)));
    lights.insert(bright.first ? lights.begin() + 1 : lights.end() - 1, lamp);

    SceneBuilder builder = floor_scene(matte(Rgb(static_cast<float>(ALBEDO))));
    double sum = 0;
    for (const PunctualLight& light : lights) {
        builder.light(light);
        sum += irradiance(light);
    }
    return {builder.finish(), ALBEDO / std::numbers::pi * sum};
}

template <typename MakeScene>
void expect_sum_of_lamps(const MakeScene& make_scene) {
    ZTable table;
    for (const Bright& bright : BRIGHT) {
        const LitScene lit = make_scene(bright);
        for (const SamplerKind sampler : {SamplerKind::random, SamplerKind::lattice}) {
            const std::vector<double> values =
                direct(render(lit.scene, settings_of(sampler), {"direct"}, QUICKLY_BUILT).image);
            table.add(fmt::format("{}, sampler {}", bright.name(), static_cast<int>(sampler)), values,
                      lit.direct, lit.direct, ROUNDING * lit.direct);
        }
    }
    table.expect_no_failure();
    table.expect_one_percent_matters();
}

TEST_F(ManyLights, TrianglesAddUp) {
    expect_sum_of_lamps(ceiling);
}

TEST_F(ManyLights, PointsAndSpotsAddUp) {
    expect_sum_of_lamps(cloud_of_lamps);
}

// The reference draws the same lamps of the same random numbers.
TEST_F(ManyLights, ReferenceChoosesTheSameLamps) {
    for (const auto& make_scene : {ceiling, cloud_of_lamps}) {
        const LitScene lit = make_scene({true, false});
        RenderSettings settings = point_settings(4, 4);
        const std::vector<double> found = direct(render(lit.scene, settings, {"direct"}).image);
        const std::vector<double> expected = direct(obscurance_picture(lit.scene, settings));
        size_t differing = 0;
        for (size_t i = 0; i < found.size(); ++i)
            differing += std::abs(found[i] - expected[i]) > 1e-4 * expected[i] ? 1 : 0;
        EXPECT_EQ(differing, 0u);
    }
}

}  // namespace
}  // namespace obscura::test
