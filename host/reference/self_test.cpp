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

class SelfTest {
  public:
    SelfTest(Device& device, ProgramLibrary& library, bool portable, const std::string& only)
        : device_(device),
          library_(library),
          portable_(portable),
          only_(only),
          options_(stage_options(Stage::trace, {}, false, portable)) {}

    std::vector<QueueCheck> run() {
        for (const float offset : WORLD_OFFSETS) {
            const std::string place = offset == 0 ? "" : fmt::format(", {:g} m off", offset);
            // Where floats are coarse, random coordinates coincide.
            const bool coarse = offset > 0;
            const Scene sphere = moved(icosphere(3), offset);
            const Scene soup = moved(triangle_soup(2000, 0.1f, 1, 1), offset);
            const Scene grid = moved(flat_grid(16), offset);
            trace("sphere" + place, sphere, random_rays(sphere, 3000, 1), coarse);
            trace("triangle soup" + place, soup, random_rays(soup, 3000, 1), coarse);
            trace("flat grid" + place, grid, random_rays(grid, 3000, 1), coarse);
            trace("sphere from inside, edges" + place, sphere,
                  from_inside(sphere, edge_rays(sphere, 50000, 5)), true, 1000);
            trace("sphere from inside, vertices" + place, sphere,
                  from_inside(sphere, vertex_rays(sphere, 50000, 6)), true, 1000);
            trace("soup, edges" + place, soup, edge_rays(soup, 3000, 2), true);
            trace("soup, vertices" + place, soup, vertex_rays(soup, 3000, 3), true);
            trace("grid along the axes" + place, grid, axis_rays(grid, 10000, 4), true);
            trace("soup along the axes" + place, soup, axis_rays(soup, 3000, 4), true);
        }
        for (const float thinness : {1e-2f, 1e-4f, 1e-6f}) {
            const Scene slivers = triangle_soup(1000, 1, thinness, 9);
            trace(fmt::format("slivers, {:g}", thinness), slivers, edge_rays(slivers, 3000, 10), true);
        }
        const Scene nested = nested_scales(40);
        trace("nested scales", nested, random_rays(nested, 5000, 12), false);
        const Scene clusters = nested_clusters(8);
        trace("nested clusters", clusters, edge_rays(clusters, 3000, 13), true);
        const Scene heap = identical_triangles(20000);
        trace("identical triangles", heap, random_rays(heap, 300, 8), false);
        const Scene one = identical_triangles(1);
        trace("one triangle", one, random_rays(one, 5000, 7), false);
        const Scene none = MeshBuilder().finish();
        trace("no triangle", none, random_rays(none, 1000, 1), false);
        render();
        return std::move(rows_);
    }

  private:
    static Rays from_inside(const Scene& scene, Rays rays) {
        const V3f center = scene.bounds.center();
        for (TraceRay& ray : rays) {
            const V3f target = ray.origin + ray.direction;
            ray.origin = center + 0.1f * (ray.origin - center);
            ray.direction = target - ray.origin;
        }
        return rays;
    }

    bool is_wanted(const std::string& name) const { return name.find(only_) != std::string::npos; }

    // every: one ray in so many is judged by the oracle even if device and Embree agree.
    void trace(const std::string& name, const Scene& scene, const Rays& rays, bool aimed, size_t every = 1) {
        if (!is_wanted(name)) return;
        const HitComparison comparison(scene);
        const DeviceTracer tracer(device_, library_, build_bvh(scene), options_);
        const std::vector<TraceHit> hits = tracer.closest(rays);
        std::vector<TraceHit> embree(rays.size());
        comparison.embree().closest(rays, embree);
        HitTally tally = comparison.compare(rays, hits, embree, every);
        const std::vector<uint8_t> blocked = tracer.occluded(rays);
        for (size_t i = 0; i < rays.size(); ++i) {
            if ((blocked[i] != 0) == (hits[i].primitive != NO_PRIMITIVE)) continue;
            tally.count(Outcome::device_wrong, rays[i], [&] {
                return std::pair(std::string(blocked[i] != 0 ? "blocked" : "free"), hit_text(scene, hits[i]));
            });
        }
        rows_.push_back({name, std::move(tally), {}, aimed});
    }

    void render();

    Device& device_;
    ProgramLibrary& library_;
    bool portable_;
    const std::string& only_;
    std::string options_;
    std::vector<QueueCheck> rows_;
};

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

void SelfTest::render() {
    const auto name = [](const QueueCheck& queue) { return "room, " + queue.name + " rays"; };
    SceneCheck check;
    if (std::ranges::none_of(check.queues, [&](const QueueCheck& queue) { return is_wanted(name(queue)); }))
        return;
    const Scene scene = room();
    RenderSettings settings;
    settings.width = 80;
    settings.height = 60;
    RenderJob job{scene, settings, {}};
    job.portable = portable_;
    check = check_scene(device_, library_, job, [](double, const RayCounts&) { return true; });
    for (QueueCheck& queue : check.queues) {
        queue.name = name(queue);
        if (is_wanted(queue.name)) rows_.push_back(std::move(queue));
    }
}

}  // namespace

std::vector<QueueCheck> self_test(Device& device, ProgramLibrary& library, bool portable,
                                  const std::string& only) {
    return SelfTest(device, library, portable, only).run();
}

}  // namespace obscura
