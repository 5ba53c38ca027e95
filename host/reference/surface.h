// SPDX-License-Identifier: Apache-2.0
// What a hit means: place, normals on the viewer's side, colours and lobes of the reflection model (scene/material.h).
#pragma once

#include "reference/directions.h"
#include "reference/precise_tracer.h"
#include "scene/material.h"
#include "scene/scene.h"
#include "scene/texture.h"

#include <array>
#include <memory>
#include <vector>

namespace obscura::reference {

struct TriangleData {
    std::array<V3d, 3> corner;
    std::array<V3d, 3> normal;  // of the vertices, where smooth
    V3d n_geo;                  // unit, on the front side
    double area;                // m^2
    double lift;  // m: distance along n_geo that clears the triangle for good in double arithmetic
    bool smooth;
    uint32_t material;

    V3d point(const V3d& weights) const {
        return weights.x * corner[0] + weights.y * corner[1] + weights.z * corner[2];
    }
};

struct MaterialData {
    SurfaceModel model;
    RgbD emission;
    double metallic;
    double transmission;
    bool pane, unlit, double_sided;
    bool mirror, glossy;  // which specular lobe there is, if any
};

struct Surface {
    uint32_t primitive;
    const MaterialData* material;
    V3d position;
    V3d n_geo;    // unit, on the side that the ray came from
    V3d n_shade;  // unit, on the same side
    V3d lift;     // position + lift is clear of the surface on that side, position - lift on the other
    bool front;
    RgbD base;  // base colour

    RgbD emitted() const { return front || material->double_sided ? material->emission : RgbD(0); }
    RgbD mean_reflectivity() const { return base * RgbD(material->model.mean_scale); }
};

// The scene as the reference renderer shades it. Keeps a reference to the scene.
class SurfaceScene {
  public:
    explicit SurfaceScene(const Scene& scene);

    // direction: of the ray that hit, unit.
    Surface surface_at(const Hit& hit, const V3d& direction) const;

    const TriangleData& triangle(uint32_t index) const { return triangles_[index]; }
    const MaterialData& material_of(uint32_t triangle) const {
        return materials_[triangles_[triangle].material];
    }
    uint32_t triangle_count() const { return static_cast<uint32_t>(triangles_.size()); }

  private:
    RgbD base_color(uint32_t primitive, const V3d& weights) const;

    const Scene& scene_;
    std::vector<TriangleData> triangles_;
    std::vector<MaterialData> materials_;
    std::vector<TextureIntegral> textures_;
};

}  // namespace obscura::reference
