// SPDX-License-Identifier: Apache-2.0
#include "wavefront/device_rates.h"

#include "bvh/bvh.h"
#include "device/error.h"
#include "device/launch.h"
#include "shared/types.h"
#include "wavefront/features.h"
#include "wavefront/profiler.h"

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

namespace obscura {
namespace {

constexpr const char* STAGE = "copy";
constexpr uint64_t COPY_BYTES = uint64_t{64}
                                << 20;  // of each buffer: together about what a render's queues take
constexpr uint64_t IDLE_ITEMS = uint64_t{1} << 22;
constexpr uint32_t TRIANGLES = 1 << 14;  // a tree of about 2 MB
constexpr uint32_t RAYS = 1 << 16;
constexpr int REPEATS = 5;

// The best of some launches, as whatever disturbs makes them slower.
template <typename Launch>
double best_ms(const Device& device, const Launch& launch_once) {
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i < REPEATS; ++i) {
        Profiler profiler(device.name());
        profiler.record(STAGE, 1, 1, launch_once());
        device.finish(STAGE);
        profiler.collect();
        best = std::min(best, profiler.rows().at(STAGE).ms);
    }
    return best;
}

void measure_copy(Device& device, ProgramLibrary& library, DeviceRates& rates) {
    const uint64_t items = std::min(COPY_BYTES, device.info().max_allocation_bytes) / sizeof(f32x4);
    Buffer from(device, "copy from", "status", items * sizeof(f32x4));
    Buffer to(device, "copy to", "status", items * sizeof(f32x4));
    from.clear();  // its pages come into being
    const cl::Kernel kernel = library.kernel(STAGE);
    const auto ms = [&](uint64_t work_items, bool work) {
        const uint32_t count = work ? static_cast<uint32_t>(work_items) : 0;
        return best_ms(device, [&] {
            return launch(device, kernel, STAGE, work_items, library.local_size(), from, to, count);
        });
    };
    rates.copy_gb_per_s = static_cast<double>(2 * items * sizeof(f32x4)) * 1e-6 / ms(items, true);

    // A straight line through a small grid and a large one.
    const uint64_t few = grid_size(device, 1, library.local_size());
    const double few_ms = ms(few, false);
    const double item_ms =
        std::max(0.0, ms(IDLE_ITEMS, false) - few_ms) / static_cast<double>(IDLE_ITEMS - few);
    rates.idle_item_ns = item_ms * 1e6;
    rates.launch_ms = std::max(0.0, few_ms - item_ms * static_cast<double>(few));
}

// Points in the unit cube, the same in every run.
class Points {
  public:
    V3f next() {
        const float x = uniform_(random_), y = uniform_(random_), z = uniform_(random_);
        return {x, y, z};
    }

  private:
    std::mt19937 random_;
    std::uniform_real_distribution<float> uniform_;
};

Scene scattered_triangles(Points& points) {
    constexpr float SIZE = 0.04f;  // about as far as they are apart
    Scene scene;
    scene.materials.emplace_back();
    for (uint32_t i = 0; i < TRIANGLES; ++i) {
        const V3f corner = points.next();
        for (int k = 0; k < 3; ++k)
            scene.vertices.push_back({corner + SIZE * points.next()});
        scene.triangles.push_back({{3 * i, 3 * i + 1, 3 * i + 2}, 0, 0});
    }
    return scene;
}

// Of rays from anywhere to anywhere.
double measure_visit_ns(Device& device, ProgramLibrary& library, bool portable) {
    Points points;
    const Bvh bvh = build_bvh(scattered_triangles(points));
    std::vector<f32x4> packed;
    for (uint32_t i = 0; i < RAYS; ++i) {
        const V3f origin = points.next();
        const V3f direction = points.next() - origin;
        packed.push_back({origin.x, origin.y, origin.z, std::numeric_limits<float>::infinity()});
        packed.push_back({direction.x, direction.y, direction.z, 0});
    }
    const Buffer nodes = Buffer::holding(device, "nodes", "status", bvh.nodes);
    const Buffer blocks = Buffer::holding(device, "blocks", "status", bvh.blocks);
    const Buffer rays = Buffer::holding(device, "rays", "status", packed);
    const Buffer results(device, "results", "status", RAYS * sizeof(f32x4));

    const std::string options = stage_options(Stage::trace, {}, false, portable);
    const auto run = [&](const cl::Kernel& kernel, const char* name) {
        const uint32_t query = RAY_QUERY_NEAREST;
        return launch(device, kernel, name, RAYS, library.local_size(), nodes, blocks, rays, results, RAYS,
                      query);
    };
    const cl::Kernel trace = library.kernel({"trace_rays", options, "check.cl"});
    const double ms = best_ms(device, [&] { return run(trace, "trace_rays"); });
    run(library.kernel("visits", options), "visits");  // nodes, blocks ...
    double visits = 0;
    for (const u32x4& ray : results.contents<u32x4>())
        visits += ray.x + ray.y;
    return ms * 1e6 * device.info().compute_units / visits;
}

}  // namespace

DeviceRates measure_rates(Device& device, ProgramLibrary& library, bool portable) {
    DeviceRates rates;
    rates.cores = device.info().compute_units;
    measure_copy(device, library, rates);
    rates.visit_ns = measure_visit_ns(device, library, portable);
    cl_ulong cache_bytes = 0;
    check(device.handle().getInfo(CL_DEVICE_GLOBAL_MEM_CACHE_SIZE, &cache_bytes), "clGetDeviceInfo", STAGE,
          device.name());
    rates.cache_bytes = cache_bytes;
    return rates;
}

}  // namespace obscura
