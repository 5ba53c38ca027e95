// SPDX-License-Identifier: Apache-2.0
// Sampling of lights in two groups: the emissive triangles, and the punctual lights. The choices are those of
// kernels/lib/lights.clh, so that a random number picks the same light.
#pragma once

#include "reference/surface.h"
#include "sampling/alias_table.h"

#include <limits>

namespace obscura::reference {

// A point on a light, seen from a surface.
struct LightSample {
    V3d direction{0, 0, 0};  // unit, from the surface's position
    V3d target{0, 0, 0};  // of the shadow ray: the point, clear of its own surface; unused for parallel light
    RgbD radiance{0, 0, 0};  // times geometry, over the density: what multiplies BRDF times cosine
    double pdf_sr = 0;       // 0 for punctual lights, which no ray finds by itself
    bool parallel = false;   // comes from infinitely far away
};

class Lights {
  public:
    // Both must outlive this.
    Lights(const Scene& scene, const SurfaceScene& surfaces);

    bool has_area_lights() const { return !area_lights_.empty(); }
    bool has_punctual_lights() const { return !punctual_lights_.empty(); }

    // u: point on the light; select_u: which light, where there are many. Radiance 0 where there is none to pick.
    LightSample sample_area(const V3d& position, const V2d& u, double select_u) const;
    LightSample sample_punctual(const V3d& position, double select_u) const;

    // Density, at `from`, with which sample_area draws the point of a triangle that lies `distance` away; 0 if the triangle
    // is no light.
    double area_pdf_sr(uint32_t triangle, const V3d& from, const V3d& direction, double distance) const;

  private:
    struct AreaLight {
        uint32_t triangle;
        V3d center;
        bool two_sided;
    };

    double weight(size_t light, const V3d& position) const;
    double probability(size_t light, const V3d& position) const;
    size_t pick(const V3d& position, V2d& u, double select_u, double& probability) const;

    const SurfaceScene& surfaces_;
    std::vector<AreaLight> area_lights_;
    std::vector<AliasEntry> area_table_;       // by power
    std::vector<uint32_t> light_of_triangle_;  // index into area_lights_, or NO_LIGHT
    std::vector<PunctualLight> punctual_lights_;
    std::vector<AliasEntry> punctual_table_;  // by irradiance
};

}  // namespace obscura::reference
