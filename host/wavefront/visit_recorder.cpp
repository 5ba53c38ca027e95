// SPDX-License-Identifier: Apache-2.0
#include "wavefront/visit_recorder.h"

#include "base/stopwatch.h"
#include "device/launch.h"
#include "wavefront/features.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace obscura {
namespace {

enum QueueIndex : size_t { CAMERA, SHADOW, GLOSSY, OBSCURANCE };  // of RAY_QUEUES

constexpr const char* KERNEL_FILE = "visits.cl";

void count(RayVisits::Histogram& histogram, uint32_t value) {
    if (histogram.size() <= value) histogram.resize(value + 1);
    ++histogram[value];
}

void add_up(RayVisits::Histogram& histogram, const RayVisits::Histogram& other) {
    histogram.resize(std::max(histogram.size(), other.size()));
    for (size_t n = 0; n < other.size(); ++n)
        histogram[n] += other[n];
}

}  // namespace

void RayVisits::add(uint32_t node_count, uint32_t block_count, uint32_t stack_entries) {
    ++rays;
    count(nodes, node_count);
    count(blocks, block_count);
    count(stack, stack_entries);
}

void RayVisits::add(const RayVisits& other) {
    rays += other.rays;
    add_up(nodes, other.nodes);
    add_up(blocks, other.blocks);
    add_up(stack, other.stack);
}

double mean(const RayVisits::Histogram& histogram) {
    double sum = 0, rays = 0;
    for (size_t n = 0; n < histogram.size(); ++n) {
        rays += static_cast<double>(histogram[n]);
        sum += static_cast<double>(n) * static_cast<double>(histogram[n]);
    }
    return rays > 0 ? sum / rays : 0;
}

void average_nodes(const PixelNodes& pixel_nodes, std::span<const uint32_t> pixel_order,
                   const SampleCounts& samples, std::span<float> nodes_per_sample) {
    for (size_t place = 0; place < pixel_order.size(); ++place) {
        const uint32_t pixel = pixel_order[place];
        const auto nodes = static_cast<double>(pixel_nodes[pixel]);
        const auto count = static_cast<double>(samples.at(place));
        if (count > 0) nodes_per_sample[pixel] = static_cast<float>(nodes / count);
    }
}

VisitRecorder::VisitRecorder(Device& device, ProgramLibrary& library, const Needs& needs, bool all,
                             bool portable, const SceneBuffers& scene)
    : device_(device), local_size_(library.local_size()), scene_(scene) {
    const auto kernel = [&](Stage stage) {
        const std::string name = fmt::format("{}_visits", stage_info(stage).name);
        return library.kernel({name, stage_options(stage, needs, all, portable), KERNEL_FILE, name});
    };
    trace_ = kernel(Stage::trace);
    if (needs.direct()) shadow_ = kernel(Stage::shadow);
    if (needs.obscurance) obscurance_ = kernel(Stage::obscurance);
}

void VisitRecorder::observe(const DepthView& view, const Frame&, const Queues& queues) {
    const TraceStep step(device_.trace(), TraceCategory::host, "count visits");
    const Stopwatch watch;
    const uint64_t ray_count = uint64_t{view.point_count} * queues.shape.obscurance_rays;
    const uint64_t most = std::max({uint64_t{view.ray_count}, uint64_t{view.shadow_count}, ray_count});
    if (counts_.bytes() < most * sizeof(u32x4))
        counts_ = Buffer(device_, "visits", "status", most * sizeof(u32x4));

    launch(device_, trace_, "trace_visits", view.ray_count, local_size_, queues.frame, scene_.nodes,
           scene_.blocks, queues.rays, queues.paths, counts_, view.ray_count);
    add(view.depth == 0 ? CAMERA : GLOSSY, view.ray_count);
    if (view.shadow_count > 0) {
        launch(device_, shadow_, "shadow_visits", view.shadow_count, local_size_, queues.frame, scene_.nodes,
               scene_.blocks, queues.shadow_rays, queues.paths, counts_, view.shadow_count);
        add(SHADOW, view.shadow_count);
    }
    if (view.point_count > 0) {
        launch(device_, obscurance_, "obscurance_visits", view.point_count, local_size_, queues.frame,
               scene_.nodes, scene_.blocks, queues.points, queues.paths, queues.counters, counts_,
               view.point_count, view.depth);
        add(OBSCURANCE, ray_count);
    }
    visits_.seconds += watch.seconds();
}

// What the latest launch has counted.
void VisitRecorder::add(size_t queue, uint64_t ray_count) {
    std::vector<u32x4> counts(ray_count);
    counts_.download(counts);
    for (const u32x4& ray : counts) {
        visits_.queues[queue].add(ray.x, ray.y, ray.z);
        pixel_nodes_->at(ray.w) += ray.x;
    }
}

}  // namespace obscura
