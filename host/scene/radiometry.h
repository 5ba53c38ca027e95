// SPDX-License-Identifier: Apache-2.0
// Scene averages of the obscurance model: areas, R_ave (4) and I_A (3), (5) of Mendez, Sbert, Neumann 2003,
// per channel, in double:
//
//   A_T      sum of the areas; double-sided surfaces count both sides, panes weigh their opacity
//   R_ave    (4): sum A_i R_i / A_T, R_i the mean diffuse albedo (scene/material.h) over the triangle's own
//            part of the texture. R_i already lacks what a pane lets through, so its A_i is the full area.
//   I_A      (3): R_ave / (1 - R_ave) * emitted / A_T,   (5): 1 / (1 - R_ave) * emitted / A_T
//   emitted  sum A_i E_i + Phi / pi of the punctual lights: 4 I for a point light, 1/pi int I dw for a spot
//            light with glTF's soft edge, E A_proj / pi for a directional one. A range does not reduce Phi.
#pragma once

#include "scene/scene.h"
#include "scene/settings.h"

namespace obscura {

struct Radiometry {
    double area = 0;                     // A_T, m^2
    RgbD emitted{0, 0, 0};               // W/sr per channel
    RgbD average_reflectivity{0, 0, 0};  // R_ave (4)
    // Infinite where R_ave reaches 1 in a channel: light would be reflected for ever.
    RgbD ambient_colourless{0, 0, 0};  // I_A (3): with the colourless W, a miss counts 1
    RgbD ambient_bleeding{0, 0, 0};    // I_A (5): with W of (6), a miss counts R_ave
};

Radiometry compute_radiometry(const Scene& scene);

// Throws InputError if the settings ask for an I_A that is infinite.
void check_ambient(const Scene& scene, const Radiometry& radiometry, const RenderSettings& settings);

// The I_A that the settings ask for: bleeding picks (5) over (3); a constant ambient term has W = 1, so it
// takes (3) in any case. --ambient-light replaces I_A: it is the radiance at an open point, so divided by
// R_ave with bleeding; where R_ave is 0 nothing reflects and the value is 0. --ambient-scale multiplies.
RgbD resolve_ambient(const Radiometry& radiometry, const RenderSettings& settings);

// Mean base colour of each triangle over its own UV footprint, times the factor; 1 entry per triangle.
std::vector<RgbD> triangle_base_colors(const Scene& scene);

// Whether anything in the scene emits light: a triangle (unlit ones don't) or a punctual light.
bool has_light(const Scene& scene);

// A scene without light gets a uniform white sky of radiance 1, as background and as ambient light, and a
// warning that says so, unless the settings hold either.
RenderSettings with_default_sky(const Scene& scene, RenderSettings settings);

// Projected area, m^2, of what parallel light of this direction reaches first: the area of the scene's
// silhouette seen along it, by counting the covered pixels of a 1024 x 1024 raster over its bounding
// rectangle.
double lit_area(const Scene& scene, const V3f& direction);

}  // namespace obscura
