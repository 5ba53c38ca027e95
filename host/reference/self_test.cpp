// SPDX-License-Identifier: Apache-2.0
#include "reference/self_test.h"

#include "bvh/bvh.h"
#include "reference/hard_rays.h"
#include "reference/meshes.h"
#include "reference/ray_text.h"
#include "reference/scene_builder.h"
#include "wavefront/features.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

namespace obscura {
namespace {

using Rays = std::vector<TraceRay>;

// m from the world's origin, where floats are coarse.
constexpr float WORLD_OFFSETS[] = {0, 1e3f, 1e5f};

// Rays through the traversal of one scene.
struct TraversalCase {
    std::string name;
    const Scene& scene;
    Rays rays;
    bool aimed;        // at edges and vertices, where ties are
    size_t every = 1;  // one ray in so many is judged by the oracle even if device and Embree agree
};

Rays from_inside(const Scene& scene, Rays rays) {
    const V3f center = scene.bounds.center();
    for (TraceRay& ray : rays) {
        const V3f target = ray.origin + ray.direction;
        ray.origin = center + 0.1f * (ray.origin - center);
        ray.direction = target - ray.origin;
    }
    return rays;
}

template <typename Use>
void for_each_traversal_case(const Use& use) {
    for (const float offset : WORLD_OFFSETS) {
        const std::string place = offset == 0 ? "" : fmt::format(", {:g} m off", offset);
        // Where floats are coarse, random coordinates coincide.
        const bool coarse = offset > 0;
        const Scene sphere = moved(icosphere(3), offset);
        const Scene soup = moved(triangle_soup(2000, 0.1f, 1, 1), offset);
        const Scene grid = moved(flat_grid(16), offset);
        use({"sphere" + place, sphere, random_rays(sphere, 3000, 1), coarse});
        use({"triangle soup" + place, soup, random_rays(soup, 3000, 1), coarse});
        use({"flat grid" + place, grid, random_rays(grid, 3000, 1), coarse});
        use({"sphere from inside, edges" + place, sphere, from_inside(sphere, edge_rays(sphere, 50000, 5)),
             true, 1000});
        use({"sphere from inside, vertices" + place, sphere,
             from_inside(sphere, vertex_rays(sphere, 50000, 6)), true, 1000});
        use({"soup, edges" + place, soup, edge_rays(soup, 3000, 2), true});
        use({"soup, vertices" + place, soup, vertex_rays(soup, 3000, 3), true});
        use({"grid along the axes" + place, grid, axis_rays(grid, 10000, 4), true});
        use({"soup along the axes" + place, soup, axis_rays(soup, 3000, 4), true});
    }
    for (const float thinness : {1e-2f, 1e-4f, 1e-6f}) {
        const Scene slivers = triangle_soup(1000, 1, thinness, 9);
        use({fmt::format("slivers, {:g}", thinness), slivers, edge_rays(slivers, 3000, 10), true});
    }
    const Scene nested = nested_scales(40);
    use({"nested scales", nested, random_rays(nested, 5000, 12), false});
    const Scene clusters = nested_clusters(8);
    use({"nested clusters", clusters, edge_rays(clusters, 3000, 13), true});
    const Scene heap = identical_triangles(20000);
    use({"identical triangles", heap, random_rays(heap, 300, 8), false});
    const Scene one = identical_triangles(1);
    use({"one triangle", one, random_rays(one, 5000, 7), false});
    const Scene none = MeshBuilder().finish();
    use({"no triangle", none, random_rays(none, 1000, 1), false});
}

QueueCheck check_case(Device& device, ProgramLibrary& library, const std::string& options,
                      const TraversalCase& test) {
    const HitComparison comparison(test.scene);
    const DeviceTracer tracer(device, library, build_bvh(test.scene), options);
    const std::vector<TraceHit> hits = tracer.closest(test.rays);
    std::vector<TraceHit> embree(test.rays.size());
    comparison.embree().closest(test.rays, embree);
    HitTally tally = comparison.compare(test.rays, hits, embree, test.every);
    // What contradicts the hit says nothing about who is wrong by how much.
    const auto count_wrong = [&](size_t i, const std::string& told) {
        tally.count(Outcome::device_wrong, 0, [&] {
            return Disagreement{
                .ray = {test.rays[i]}, .device = told, .expected = hit_text(test.scene, hits[i])};
        });
    };
    const std::vector<uint8_t> blocked = tracer.occluded(test.rays);
    const std::vector<TraceHit> alone = tracer.closest_alone(test.rays);
    for (size_t i = 0; i < test.rays.size(); ++i) {
        if ((blocked[i] != 0) != (hits[i].primitive != NO_PRIMITIVE))
            count_wrong(i, blocked[i] != 0 ? "blocked" : "free");
        if (!same_bits(alone[i], hits[i])) count_wrong(i, "alone " + hit_text(test.scene, alone[i]));
    }
    return {test.name, std::move(tally), {}, test.aimed};
}

// A closed room with a lamp, balls of plaster and chrome and a pane of glass, far enough from the world's origin for the
// offsets of ray origins to matter.
Scene room() {
    const V3f low(10, 20, 30);
    Material glass = metal(Rgb(0.8f, 0.9f, 0.8f), 0);
    glass.metallic = 0;
    glass.transmission = 0.9f;
    SceneBuilder builder;
    const std::vector<uint8_t> squares{250, 128, 60, 255, 40,  128, 60, 255,
                                       40,  128, 60, 255, 250, 128, 60, 255};
    const Texture checks{"checks", 2, 2, Wrap::repeat, Wrap::repeat, TextureFilter::linear, squares};
    Material tiles = matte(Rgb(0.9f));
    tiles.base_color_texture = builder.texture(checks);
    const uint32_t plaster = builder.material(matte(Rgb(0.6f, 0.5f, 0.7f)));
    const uint32_t lamp = builder.material(matte(Rgb(0.2f), Rgb(8, 7, 6)));
    builder.box(low, low + V3f(4, 3, 4), plaster, true);
    builder.quad(low + V3f(0, 0.001f, 4), {4, 0, 0}, {0, 0, -4}, builder.material(tiles));
    builder.quad(low + V3f(1.5f, 2.95f, 1.5f), {1, 0, 0}, {0, 0, 1}, lamp);
    builder.quad(low + V3f(1.6f, 2.6f, 1.6f), {0.5f, 0, 0}, {0, 0, 0.5f}, plaster);
    builder.sphere(low + V3f(1, 0.4f, 1), 0.4f, 3, plaster, false, true);
    builder.sphere(low + V3f(2, 0.401f, 1.2f), 0.4f, 3, builder.material(metal(Rgb(0.9f), 0)), false, true);
    builder.quad(low + V3f(2.5f, 0.1f, 1.5f), {1, 0, 0}, {0, 1, 0.2f}, builder.material(glass));
    builder.camera(V3d(low) + V3d(2, 1.6, 3.8), V3d(low) + V3d(2, 0.7, 1));
    return builder.finish();
}

RenderSettings room_settings() {
    RenderSettings settings;
    settings.width = 80;
    settings.height = 60;
    return settings;
}

std::string room_name(const QueueCheck& queue) {
    return "room, " + queue.name + " rays";
}

}  // namespace

std::vector<QueueCheck> self_test(Device& device, ProgramLibrary& library, bool portable,
                                  const std::string& only) {
    const auto is_wanted = [&](const std::string& name) { return name.find(only) != std::string::npos; };
    const std::string options = stage_options(Stage::trace, {}, false, portable);
    std::vector<QueueCheck> rows;
    for_each_traversal_case([&](const TraversalCase& test) {
        if (is_wanted(test.name)) rows.push_back(check_case(device, library, options, test));
    });
    SceneCheck check;
    if (std::ranges::none_of(check.queues, is_wanted, room_name)) return rows;
    const Scene scene = room();
    RenderJob job{scene, room_settings(), {}};
    job.portable = portable;
    check = check_scene(device, library, job, [](double, const RayCounts&) { return true; });
    for (QueueCheck& queue : check.queues) {
        queue.name = room_name(queue);
        if (is_wanted(queue.name)) rows.push_back(std::move(queue));
    }
    return rows;
}

bool with_self_test_case(const std::string& name, const UseOfCase& use) {
    bool found = false;
    for_each_traversal_case([&](const TraversalCase& test) {
        if (test.name != name) return;
        found = true;
        use(test.scene, {});
    });
    const SceneCheck names;
    if (std::ranges::find(names.queues, name, room_name) != names.queues.end()) {
        found = true;
        use(room(), room_settings());
    }
    return found;
}

}  // namespace obscura
