// SPDX-License-Identifier: Apache-2.0
// The path tracer in an empty, closed Cornell box against the method that the box was built for: radiosity (Goral,
// Torrance, Greenberg, Battaile 1984), with form factors in closed form.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "support/reference_picture.h"
#include "support/render.h"
#include "support/scene_builder.h"
#include "support/statistics.h"

namespace obscura::test {
namespace {

// The box is [-1, 1]^3; the lamp the middle quarter of its ceiling, as white as that.
constexpr size_t WALLS = 6, CEILING = 3;
constexpr double WALL_AREA = 4, LAMP_AREA = 1, LAMP_RADIANCE = 10;
const Rgb WHITE(0.73f), RED(0.63f, 0.065f, 0.05f), GREEN(0.14f, 0.45f, 0.091f);
const std::array<Rgb, WALLS> PAINT{RED, GREEN, WHITE, WHITE, WHITE, WHITE};  // -x, +x, -y, +y, -z, +z

// Looks from the middle straight at a wall and sees all of it.
Camera camera_at(size_t wall) {
    V3d target(0);
    target[static_cast<int>(wall / 2)] = wall % 2 == 0 ? -1 : 1;
    SceneBuilder builder;
    builder.camera(V3d(0), target);
    Camera camera = builder.finish().cameras.front();
    camera.orthographic = true;
    camera.half_height = 1;
    return camera;
}

V3f axis_vector(int axis, float length) {
    V3f v(0);
    v[axis] = length;
    return v;
}

// A wall's 4 x 4 squares, fronts inwards.
Scene cornell_box() {
    SceneBuilder builder;
    const uint32_t lamp = builder.material(matte(WHITE, Rgb(static_cast<float>(LAMP_RADIANCE))));
    for (size_t wall = 0; wall < WALLS; ++wall) {
        const uint32_t paint = builder.material(matte(PAINT[wall]));
        const int axis = static_cast<int>(wall / 2);
        const V3f u = axis_vector((axis + 1) % 3, 0.5f), v = axis_vector((axis + 2) % 3, 0.5f);
        const V3f corner = axis_vector(axis, wall % 2 == 0 ? -1.0f : 1.0f) - 2.0f * (u + v);
        for (int i = 0; i < 4; ++i) {
            for (int j = 0; j < 4; ++j) {
                const bool lit = wall == CEILING && (i == 1 || i == 2) && (j == 1 || j == 2);
                const V3f at = corner + static_cast<float>(i) * u + static_cast<float>(j) * v;
                wall % 2 == 0 ? builder.quad(at, u, v, lit ? lamp : paint)
                              : builder.quad(at, v, u, lit ? lamp : paint);
            }
        }
    }
    return builder.finish();
}

struct Patch {
    size_t wall;
    V3d middle, u, v;  // half of its sides
    bool lit;
};

std::vector<Patch> make_patches(int per_side) {
    std::vector<Patch> patches;
    for (size_t wall = 0; wall < WALLS; ++wall) {
        const int axis = static_cast<int>(wall / 2);
        V3d middle(0), u(0), v(0);
        middle[axis] = wall % 2 == 0 ? -1 : 1;
        u[(axis + 1) % 3] = v[(axis + 2) % 3] = 1.0 / per_side;
        for (int i = 0; i < per_side; ++i) {
            for (int j = 0; j < per_side; ++j) {
                const double a = 2 * i + 1 - per_side, b = 2 * j + 1 - per_side;
                const bool lit = wall == CEILING && std::max(std::abs(a), std::abs(b)) < 0.5 * per_side;
                patches.push_back({wall, middle + a * u + b * v, u, v, lit});
            }
        }
    }
    return patches;
}

// Share of the cosine-weighted directions from a patch's middle that meet another one (Lambert 1760).
double form_factor(const Patch& from, const Patch& to) {
    if (from.wall == to.wall) return 0;
    const int normal = static_cast<int>(from.wall / 2);
    const V3d offset = to.middle - from.middle;
    const std::array corners{offset - to.u - to.v, offset + to.u - to.v, offset + to.u + to.v,
                             offset - to.u + to.v};
    double sum = 0;
    for (size_t i = 0; i < 4; ++i) {
        const V3d a = corners[i].normalized(), b = corners[(i + 1) % 4].normalized();
        const V3d edge = a.cross(b);
        if (edge.length() > 0) sum += std::atan2(edge.length(), a.dot(b)) * edge[normal] / edge.length();
    }
    return std::abs(sum) / (2 * std::numbers::pi);
}

using WallMeans = std::array<RgbD, WALLS>;  // radiance, the lamp's own included

// The radiosity of patches each of one radiance.
WallMeans solve_radiosity(int per_side) {
    const std::vector<Patch> patches = make_patches(per_side);
    const size_t count = patches.size();
    std::vector<double> factors;
    for (const Patch& from : patches)
        for (const Patch& to : patches)
            factors.push_back(form_factor(from, to));
    std::vector<RgbD> radiance(count, RgbD(0));
    for (int bounce = 0; bounce < 60; ++bounce) {  // 0.73^60 is 10^-8
        std::vector<RgbD> next(count);
        for (size_t i = 0; i < count; ++i) {
            RgbD arriving(0);
            for (size_t j = 0; j < count; ++j)
                arriving += factors[i * count + j] * radiance[j];
            next[i] = RgbD(patches[i].lit ? LAMP_RADIANCE : 0) + RgbD(PAINT[patches[i].wall]) * arriving;
        }
        radiance = std::move(next);
    }
    WallMeans means;
    means.fill(RgbD(0));
    for (size_t i = 0; i < count; ++i)
        means[patches[i].wall] += radiance[i] * (static_cast<double>(WALLS) / static_cast<double>(count));
    return means;
}

// Of 16 seeds, what the path tracer finds.
const std::vector<WallMeans>& traced() {
    static const std::vector<WallMeans> all = [] {
        std::vector<WallMeans> seeds(16);
        Scene scene = cornell_box();
        RenderSettings settings = picture(16, 16, 64);
        for (settings.seed = 0; settings.seed < seeds.size(); ++settings.seed) {
            for (size_t wall = 0; wall < WALLS; ++wall) {
                scene.cameras = {camera_at(wall)};
                const Image image = path_picture(scene, settings);
                for (int c = 0; c < 3; ++c)
                    seeds[settings.seed][wall][c] = estimate(channel(image, "", static_cast<size_t>(c))).mean;
            }
        }
        return seeds;
    }();
    return all;
}

TEST(CornellBox, WallsHaveTheirRadiosity) {
    // The error falls with the square of the patches' size, which the last two halvings bear out.
    const WallMeans coarse = solve_radiosity(4), medium = solve_radiosity(8), fine = solve_radiosity(16);
    const auto limit = [](double half_as_fine, double value) { return value + (value - half_as_fine) / 3; };
    ZTable table;
    for (size_t wall = 0; wall < WALLS; ++wall) {
        for (int c = 0; c < 3; ++c) {
            std::vector<double> values;
            for (const WallMeans& means : traced())
                values.push_back(means[wall][c]);
            const double expected = limit(medium[wall][c], fine[wall][c]);
            const double uncertain = std::abs(expected - limit(coarse[wall][c], medium[wall][c]));
            table.add(fmt::format("wall {}, channel {}", wall, c), values, expected - uncertain,
                      expected + uncertain, 0);
        }
    }
    table.expect_no_failure();
    table.expect_one_percent_matters();
}

// Walls absorb 1 - R of what arrives, which is what they reflect over R; in all, what the lamp sends out.
TEST(CornellBox, WallsAbsorbWhatTheLampEmits) {
    ZTable table;
    for (int c = 0; c < 3; ++c) {
        std::vector<double> absorbed;
        for (const WallMeans& means : traced()) {
            double sum = -LAMP_AREA * LAMP_RADIANCE / static_cast<double>(WHITE[c]) *
                         (1 - static_cast<double>(WHITE[c]));
            for (size_t wall = 0; wall < WALLS; ++wall) {
                const auto r = static_cast<double>(PAINT[wall][c]);
                sum += WALL_AREA * means[wall][c] * (1 - r) / r;
            }
            absorbed.push_back(sum);
        }
        const double emitted = LAMP_AREA * LAMP_RADIANCE;
        table.add(fmt::format("channel {}", c), absorbed, emitted, emitted, 1e-6 * emitted);
    }
    table.expect_no_failure();
    table.expect_one_percent_matters();
}

}  // namespace
}  // namespace obscura::test
