// SPDX-License-Identifier: Apache-2.0
// Closed forms of the colourless obscurance W for simple geometry, for every falloff, in double. All lengths are in
// units of d_max. Exact to 1e-13, but for exp:lambda, whose terms cancel for small lambda: 1e-15 / lambda.
#pragma once

#include <limits>
#include <vector>

#include "base/math.h"
#include "scene/settings.h"

namespace obscura {

// W of a surface below an infinite parallel plane at this height; also on the axis of an infinitely deep cylindrical
// well of this radius.
double plane_obscurance(const Falloff& falloff, double height);

// A vertical wall, infinitely long and high: its distance > 0 from a floor point, and the azimuth of its nearest line.
struct Wall {
    double azimuth;
    double distance;
};

// The walls about the centre of a square well.
std::vector<Wall> square_well(double half_side);

// W of a floor point among walls, open above or below an infinite ceiling. The floor's centre in a closed cube of edge
// e: floor_obscurance(falloff, square_well(e / 2), e).
double floor_obscurance(const Falloff& falloff, const std::vector<Wall>& walls,
                        double ceiling = std::numeric_limits<double>::infinity());

// W on the inner surface of a sphere.
double sphere_obscurance(const Falloff& falloff, double diameter);

// W at the centre of a sphere, or of the floor of a dome: every ray brings back the same.
double dome_obscurance(const Falloff& falloff, double radius);

// W with colour bleeding where all occluders have one reflectivity: R_Q (W - W_step) + R_ave W_step, because W_step is
// the share of open directions.
RgbD bleeding_obscurance(double w, double w_step, const RgbD& reflectivity, const RgbD& average_reflectivity);

}  // namespace obscura
