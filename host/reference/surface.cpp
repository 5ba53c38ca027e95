// SPDX-License-Identifier: Apache-2.0
#include "reference/surface.h"

#include <cmath>

namespace obscura::reference {
namespace {

// Rounding moves a point and its plane by a few units of 2^-53 of the coordinates: this is many of them, and still
// nothing beside the lengths of a scene.
constexpr double RELATIVE_LIFT = 0x1p-46;

TriangleData make_triangle(const Scene& scene, uint32_t index) {
    TriangleData triangle{};
    double largest = 0;
    for (int i = 0; i < 3; ++i) {
        const auto k = static_cast<size_t>(i);
        triangle.corner[k] = V3d(scene.corner(index, i).position);
        triangle.normal[k] = V3d(scene.corner(index, i).normal);
        for (int axis = 0; axis < 3; ++axis)
            largest = std::max(largest, std::abs(triangle.corner[k][axis]));
    }
    triangle.n_geo = geometric_normal(scene, index);
    triangle.area = triangle_area(scene, index);
    triangle.lift = RELATIVE_LIFT * largest;  // no edge is longer than a few of the largest coordinate
    triangle.smooth = is_smooth(scene, index);
    triangle.material = scene.triangles[index].material;
    return triangle;
}

MaterialData make_material(const Material& material) {
    MaterialData data{};
    data.model = surface_model(material);
    data.emission = is_emissive(material) ? RgbD(material.emission) : RgbD(0);
    data.metallic = static_cast<double>(material.metallic);
    data.transmission = static_cast<double>(material.transmission);
    data.pane = is_pane(material);
    data.unlit = material.unlit;
    data.double_sided = material.double_sided;
    data.mirror = data.model.has_specular && data.model.alpha == 0;
    data.glossy = data.model.has_specular && data.model.alpha > 0;
    return data;
}

}  // namespace

SurfaceScene::SurfaceScene(const Scene& scene) : scene_(scene) {
    for (uint32_t i = 0; i < scene.triangles.size(); ++i)
        triangles_.push_back(make_triangle(scene, i));
    for (const Material& material : scene.materials)
        materials_.push_back(make_material(material));
    for (const Texture& texture : scene.textures)
        textures_.emplace_back(texture);
}

RgbD SurfaceScene::base_color(uint32_t primitive, const V3d& weights) const {
    const Material& material = scene_.materials[triangles_[primitive].material];
    const RgbD factor(material.base_color);
    if (material.base_color_texture == NO_TEXTURE) return factor;
    const auto index = static_cast<size_t>(material.base_color_texture);
    V2d uv(0, 0);
    for (int i = 0; i < 3; ++i)
        uv += weights[i] * V2d(scene_.corner(primitive, i).uv);
    const Texture& texture = scene_.textures[index];
    return factor * textures_[index].sample(uv.x * texture.width, uv.y * texture.height);
}

Surface SurfaceScene::surface_at(const Hit& hit, const V3d& direction) const {
    const TriangleData& triangle = triangles_[hit.primitive];
    const V3d weights(1 - hit.u - hit.v, hit.u, hit.v);
    Surface surface{};
    surface.primitive = hit.primitive;
    surface.material = &materials_[triangle.material];
    surface.position = triangle.point(weights);
    surface.front = triangle.n_geo.dot(direction) < 0;
    surface.n_geo = surface.front ? triangle.n_geo : -triangle.n_geo;
    surface.lift = triangle.lift * surface.n_geo;
    surface.n_shade = surface.n_geo;
    if (triangle.smooth) {
        const V3d sum =
            weights.x * triangle.normal[0] + weights.y * triangle.normal[1] + weights.z * triangle.normal[2];
        // Opposite vertex normals can cancel: the geometric normal stands then.
        if (sum.length2() > 0) {
            const V3d n = sum.normalized();
            surface.n_shade = n.dot(surface.n_geo) < 0 ? -n : n;
        }
    }
    surface.base = base_color(hit.primitive, weights);
    return surface;
}

}  // namespace obscura::reference
