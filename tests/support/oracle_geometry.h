// SPDX-License-Identifier: Apache-2.0
// Scenes with a point whose obscurance W has a closed form, seen by a camera that sees nothing else.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "reference/oracles.h"
#include "support/scene_builder.h"
#include "support/sphere_facet.h"

namespace obscura::test {

struct OracleGeometry {
    std::string name;  // lengths in metres
    Scene scene;
    std::function<Bracket(const Falloff&, double)> obscurance;  // of falloff and d_max in metres; colourless
};

// Values of d_max, metres, for which the closed forms hold; the middle one is the unit of the published values. The last
// is no float.
inline const std::vector<double> ORACLE_REACHES{0.5, 1, 1.7};
// What is at least this long is infinite for all of them.
constexpr float BEYOND_REACH = 2;

const Rgb ORACLE_COLOR(0.8f, 0.5f, 0.2f);  // of every surface near the point
// So narrow that all camera rays meet the same point.
constexpr double ONE_POINT_FOV = 1e-9;

// A black surface out of reach, so that R_ave differs from the colour that the rays meet.
inline void add_far_black(SceneBuilder& builder) {
    builder.quad({60, 0, 60}, {3, 0, 0}, {0, 0, 3}, builder.material(matte(Rgb(0))));
}

// The floor is small: rays start above it by a distance in proportion to its size, and W would show that.
inline void add_small_floor(SceneBuilder& builder, uint32_t material) {
    builder.quad({-0.05f, 0, 0.05f}, {0.1f, 0, 0}, {0, 0, -0.1f}, material);
}

// A floor point at the origin among walls, +y up; half_width: of each wall.
inline OracleGeometry enclosure(const std::string& name, const std::vector<Wall>& walls,
                                double ceiling = std::numeric_limits<double>::infinity(),
                                double half_width = static_cast<double>(BEYOND_REACH)) {
    SceneBuilder builder;
    const uint32_t material = builder.material(matte(ORACLE_COLOR));
    add_small_floor(builder, material);
    // What the scene holds are floats, and so are the distances in the closed form.
    std::vector<Wall> built;
    for (const auto& [azimuth, distance] : walls) {
        const V3d normal(std::cos(azimuth), 0, std::sin(azimuth));
        const V3d along(-normal.z, 0, normal.x);
        built.push_back({azimuth, static_cast<double>(static_cast<float>(distance))});
        builder.quad(V3f(distance * normal - half_width * along - V3d(0, 0.2, 0)),
                     V3f(2 * half_width * along), {0, BEYOND_REACH + 0.2f, 0}, material);
    }
    const double height = static_cast<double>(static_cast<float>(ceiling));
    if (std::isfinite(ceiling)) {
        builder.quad({-BEYOND_REACH, static_cast<float>(ceiling), -BEYOND_REACH}, {2 * BEYOND_REACH, 0, 0},
                     {0, 0, 2 * BEYOND_REACH}, material);
    }
    add_far_black(builder);
    builder.camera(V3d(0, std::min(1.0, height / 2), 0), V3d(0, 0, 0), ONE_POINT_FOV);
    return {name, builder.finish(), [built, height](const Falloff& falloff, double d_max) {
                std::vector<Wall> scaled = built;
                for (Wall& wall : scaled)
                    wall.distance /= d_max;
                const double w = floor_obscurance(falloff, scaled, height / d_max);
                return Bracket{w, w};
            }};
}

// A well of so many walls that it stands for a cylinder. They overlap a little at the edges.
inline OracleGeometry round_well(double radius) {
    constexpr int SIDES = 64;
    std::vector<Wall> walls;
    for (int i = 0; i < SIDES; ++i)
        walls.push_back({2 * std::numbers::pi * i / SIDES, radius});
    return enclosure("cylindrical well, radius 0.25", walls, std::numeric_limits<double>::infinity(),
                     1.001 * radius * std::tan(std::numbers::pi / SIDES));
}

// The inside of a sphere of diameter 1 m.
inline OracleGeometry sphere_surface() {
    SceneBuilder builder;
    builder.sphere({0, 0, 0}, 0.5f, 5, builder.material(matte(ORACLE_COLOR)), true);
    add_far_black(builder);
    const SphereFacet facet = find_facet(SceneBuilder(builder).finish(), V3d(0.3, -0.5, -0.8));
    builder.camera(V3d(0, 0, 0), facet.foot, ONE_POINT_FOV);
    return {"sphere, diameter 1", builder.finish(), [facet](const Falloff& falloff, double d_max) {
                return facet_obscurance(facet, falloff, d_max);
            }};
}

// The centre of a sphere of radius 0.4 m, on a floor that cuts it in half.
inline OracleGeometry dome_centre() {
    SceneBuilder builder;
    const uint32_t material = builder.material(matte(ORACLE_COLOR));
    builder.sphere({0, 0, 0}, 0.4f, 5, material, true);
    const SphereFacet dome = find_facet(SceneBuilder(builder).finish(), V3d(0, 0, 1));
    builder.quad({-0.001f, 0, 0.001f}, {0.002f, 0, 0}, {0, 0, -0.002f}, material);
    add_far_black(builder);
    builder.camera(V3d(0, 0.2, 0), V3d(0, 0, 0), ONE_POINT_FOV);
    return {"dome centre, radius 0.4", builder.finish(), [dome](const Falloff& falloff, double d_max) {
                return Bracket{dome_obscurance(falloff, dome.inner / d_max),
                               dome_obscurance(falloff, dome.outer / d_max)};
            }};
}

inline const std::vector<OracleGeometry>& oracle_geometries() {
    constexpr double QUARTER_TURN = std::numbers::pi / 2;
    static const std::vector<OracleGeometry> list{
        enclosure("empty space", {}),
        enclosure("plane, height 0.1", {}, 0.1),
        enclosure("plane, height 0.25", {}, 0.25),
        round_well(0.25),
        enclosure("wall, distance 0.25", {{0, 0.25}}),
        enclosure("2 walls, distances 0.1 and 0.5", {{0, 0.1}, {QUARTER_TURN, 0.5}}),
        enclosure("3 walls, distance 0.25", {{0, 0.25}, {QUARTER_TURN, 0.25}, {2 * QUARTER_TURN, 0.25}}),
        enclosure("square well, side 0.5", square_well(0.25)),
        enclosure("closed cube, edge 1", square_well(0.5), 1),
        sphere_surface(),
        dome_centre(),
    };
    return list;
}

}  // namespace obscura::test
