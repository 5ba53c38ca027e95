// SPDX-License-Identifier: Apache-2.0
// Scenes built in code: materials, quads, boxes, spheres, a camera. Front sides as stated at each shape.
#pragma once

#include "reference/meshes.h"
#include "scene/scene.h"

#include <cmath>
#include <string>
#include <tuple>
#include <utility>

namespace obscura {

// A material without any specular lobe; emission is radiance, one-sided.
inline Material matte(const Rgb& reflectivity, const Rgb& emission = Rgb(0, 0, 0)) {
    Material material;
    material.name = "matte";
    material.base_color = reflectivity;
    material.metallic = 0;
    material.specular = 0;
    material.emission = emission;
    return material;
}

// 0 = a mirror: reflects all light at every angle.
inline Material metal(const Rgb& color, float roughness) {
    Material material;
    material.name = "metal";
    material.base_color = color;
    material.metallic = 1;
    material.roughness = roughness;
    return material;
}

class SceneBuilder {
  public:
    // Returns the index that the shapes take.
    uint32_t material(const Material& material) {
        scene_.materials.push_back(material);
        return static_cast<uint32_t>(scene_.materials.size()) - 1;
    }

    int32_t texture(const Texture& texture) {
        scene_.textures.push_back(texture);
        return static_cast<int32_t>(scene_.textures.size()) - 1;
    }

    void light(const PunctualLight& light) { scene_.lights.push_back(light); }

    void triangle(const V3f& a, const V3f& b, const V3f& c, uint32_t material) {
        begin_object("triangle");
        add(vertex(a, {0, 0}), vertex(b, {1, 0}), vertex(c, {0, 1}), material);
    }

    // Two triangles; the front side looks along u x v; uv (0,0) at the corner, (1,1) opposite.
    void quad(const V3f& corner, const V3f& u, const V3f& v, uint32_t material) {
        begin_object("quad");
        add_quad(corner, u, v, material);
    }

    // Twelve triangles; front sides outwards, or inwards: a room.
    void box(const V3f& low, const V3f& high, uint32_t material, bool inwards = false) {
        begin_object("box");
        const V3f x(high.x - low.x, 0, 0), y(0, high.y - low.y, 0), z(0, 0, high.z - low.z);
        for (const auto& [corner, u, v] : {std::tuple{low, y, x},
                                           {low + z, x, y},
                                           {low, x, z},
                                           {low + y, z, x},
                                           {low, z, y},
                                           {low + x, y, z}})
            inwards ? add_quad(corner, v, u, material) : add_quad(corner, u, v, material);
    }

    // 20 * 4^levels triangles, front sides outwards, or inwards. smooth: vertex normals of the true sphere.
    void sphere(const V3f& center, float radius, int levels, uint32_t material, bool inwards = false,
                bool smooth = false) {
        begin_object("sphere");
        const Scene mesh = icosphere(levels, 1);
        const auto first = static_cast<uint32_t>(scene_.vertices.size());
        for (const Vertex& source : mesh.vertices) {
            const V3f normal = source.position.normalized() * (inwards ? -1.0f : 1.0f);
            scene_.vertices.push_back(
                {center + radius * source.position, smooth ? normal : V3f(0, 0, 0), {0, 0}});
        }
        for (const Triangle& source : mesh.triangles) {
            const auto [a, b, c] = source.vertex;
            add(first + a, first + (inwards ? c : b), first + (inwards ? b : c), material);
        }
    }

    // Perspective camera at eye, looking at target, +y up (+z if it looks along y).
    void camera(const V3d& eye, const V3d& target, double vertical_fov = 0.8) {
        const V3d backward = (eye - target).normalized();
        const V3d helper = std::abs(backward.y) < 0.999 ? V3d(0, 1, 0) : V3d(0, 0, 1);
        const V3d right = helper.cross(backward).normalized();
        const V3d up = backward.cross(right);
        Camera camera;
        camera.name = "camera";
        camera.vertical_fov = vertical_fov;
        camera.camera_to_world = M44d(right.x, right.y, right.z, 0, up.x, up.y, up.z, 0, backward.x,
                                      backward.y, backward.z, 0, eye.x, eye.y, eye.z, 1);
        scene_.cameras.push_back(camera);
    }

    // Completes objects and bounds; a scene without a camera gets one at the origin, looking down -z.
    Scene finish() {
        scene_.name = "test";
        for (Object& object : scene_.objects)
            object.triangle_count = 0;
        for (const Triangle& triangle : scene_.triangles) {
            ++scene_.objects[triangle.object].triangle_count;
            for (const uint32_t corner : triangle.vertex)
                scene_.bounds.extendBy(scene_.vertices[corner].position);
        }
        if (scene_.cameras.empty()) scene_.cameras.emplace_back();
        return std::move(scene_);
    }

  private:
    void begin_object(const std::string& name) {
        scene_.objects.push_back({name, static_cast<uint32_t>(scene_.triangles.size()), 0});
    }

    uint32_t vertex(const V3f& position, const V2f& uv) {
        scene_.vertices.push_back({position, V3f(0, 0, 0), uv});
        return static_cast<uint32_t>(scene_.vertices.size()) - 1;
    }

    void add(uint32_t a, uint32_t b, uint32_t c, uint32_t material) {
        scene_.triangles.push_back({{a, b, c}, material, static_cast<uint32_t>(scene_.objects.size()) - 1});
    }

    void add_quad(const V3f& corner, const V3f& u, const V3f& v, uint32_t material) {
        const uint32_t a = vertex(corner, {0, 0});
        const uint32_t b = vertex(corner + u, {1, 0});
        const uint32_t c = vertex(corner + u + v, {1, 1});
        const uint32_t d = vertex(corner + v, {0, 1});
        add(a, b, c, material);
        add(a, c, d, material);
    }

    Scene scene_;
};

// The furnace: a closed sphere seen from inside, everywhere of the same reflectivity and emission.
inline Scene furnace_sphere(const Rgb& reflectivity, const Rgb& emission, float radius = 1, int levels = 3) {
    SceneBuilder builder;
    builder.sphere(V3f(0, 0, 0), radius, levels, builder.material(matte(reflectivity, emission)), true);
    builder.camera(V3d(0, 0, 0), V3d(0, 0, -1), 1.2);
    return builder.finish();
}

}  // namespace obscura
