// SPDX-License-Identifier: Apache-2.0
#include "reference/ray_capture.h"

#include "device/launch.h"
#include "reference/ray_order.h"
#include "shared/wavefront.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace obscura {
namespace {

V3f xyz(const f32x4& lane) {
    return {lane.x, lane.y, lane.z};
}

// `count` items of a lane of a queue for `capacity` items.
std::vector<f32x4> lane(const Buffer& queue, uint64_t lane, uint64_t capacity, size_t count) {
    std::vector<f32x4> values(count);
    queue.download(values, lane * capacity);
    return values;
}

}  // namespace

TraceHit hit_of(const f32x4& lane) {
    return {lane.x, lane.y, lane.z, std::bit_cast<uint32_t>(lane.w)};
}

std::vector<f32x4> pack(std::span<const TraceRay> rays) {
    std::vector<f32x4> lanes;
    lanes.reserve(2 * rays.size());
    for (const TraceRay& ray : rays) {
        lanes.push_back({ray.origin.x, ray.origin.y, ray.origin.z, ray.t_max});
        lanes.push_back({ray.direction.x, ray.direction.y, ray.direction.z, 0});
    }
    return lanes;
}

RayCapture::RayCapture(Device& device, ProgramLibrary& library, const Bvh& bvh, const std::string& options)
    : device_(device),
      local_size_(library.local_size()),
      nodes_(Buffer::holding(device, "nodes", "check", bvh.nodes)),
      blocks_(Buffer::holding(device, "blocks", "check", bvh.blocks)),
      kernel_(library.kernel({"obscurance_rays", options, "check.cl", "obscurance_rays"})) {}

CapturedRays RayCapture::traced(const DepthView& view, const Frame& frame, const Queues& queues) const {
    const uint64_t capacity = frame.crop.w;
    const std::vector<f32x4> origins = lane(queues.rays, RAY_ORIGIN, capacity, view.ray_count);
    const std::vector<f32x4> directions = lane(queues.rays, RAY_DIRECTION, capacity, view.ray_count);
    const std::vector<f32x4> hits = lane(queues.rays, RAY_HIT, capacity, view.ray_count);
    CapturedRays captured;
    for (size_t i = 0; i < origins.size(); ++i) {
        captured.rays.push_back(
            {xyz(origins[i]), xyz(directions[i]), std::numeric_limits<float>::infinity()});
        captured.hits.push_back(hit_of(hits[i]));
    }
    return captured;
}

CapturedRays RayCapture::shadow(const DepthView& view, const Frame& frame, const Queues& queues) const {
    CapturedRays captured;
    if (view.shadow_count == 0) return captured;
    const uint64_t capacity = uint64_t{frame.crop.w} * queues.shape.light_samples;
    const std::vector<f32x4> origins = lane(queues.shadow_rays, SHADOW_ORIGIN, capacity, view.shadow_count);
    const std::vector<f32x4> directions =
        lane(queues.shadow_rays, SHADOW_DIRECTION, capacity, view.shadow_count);
    const std::vector<f32x4> visibility = queues.visibility.contents<f32x4>();
    for (size_t i = 0; i < origins.size(); ++i) {
        captured.rays.push_back({xyz(origins[i]), xyz(directions[i]), directions[i].w});
        captured.results.push_back(visibility[std::bit_cast<uint32_t>(origins[i].w)]);
    }
    return captured;
}

CapturedRays RayCapture::obscurance(const DepthView& view, const Frame& frame, const Queues& queues) {
    constexpr uint64_t LANES = 4;
    const uint32_t k_count = frame.sampling.y;
    const uint32_t count = view.point_count * k_count;
    CapturedRays captured;
    if (count == 0) return captured;
    const uint64_t bytes = LANES * count * sizeof(f32x4);
    if (out_.bytes() < bytes) out_ = Buffer(device_, "obscurance rays", "check", bytes);
    launch(device_, kernel_, "obscurance_rays", view.point_count, local_size_, queues.frame, nodes_, blocks_,
           queues.points, queues.paths, queues.counters, out_, view.point_count, view.depth);
    const std::vector<f32x4> origins = lane(out_, 0, count, count);
    const std::vector<f32x4> directions = lane(out_, 1, count, count);
    const std::vector<f32x4> hits = lane(out_, 2, count, count);
    const std::vector<f32x4> starts = lane(out_, 3, count, count);
    const std::vector<f32x4> results = queues.results.contents<f32x4>();
    for (uint32_t i = 0; i < count; ++i) {
        captured.rays.push_back({xyz(origins[i]), xyz(directions[i]), origins[i].w});
        captured.hits.push_back(hit_of(hits[i]));
        captured.starts.push_back(xyz(starts[i]));
        captured.results.push_back(results[std::bit_cast<uint32_t>(directions[i].w)]);
    }
    return captured;
}

DeviceTracer::DeviceTracer(Device& device, ProgramLibrary& library, const Bvh& bvh,
                           const std::string& options)
    : device_(device),
      local_size_(library.local_size()),
      nodes_(Buffer::holding(device, "nodes", "check", bvh.nodes)),
      blocks_(Buffer::holding(device, "blocks", "check", bvh.blocks)),
      kernel_(library.kernel({"trace_rays", options, "check.cl", "trace_rays"})) {}

std::vector<uint8_t> DeviceTracer::occluded(std::span<const TraceRay> rays) const {
    std::vector<uint8_t> blocked;
    for (const TraceHit& hit : trace(rays, RAY_QUERY_ANY))
        blocked.push_back(hit.primitive != NO_PRIMITIVE ? 1 : 0);
    return blocked;
}

std::vector<TraceHit> DeviceTracer::trace(std::span<const TraceRay> rays, uint32_t query) const {
    if (rays.empty()) return {};
    const Buffer ray_buffer = Buffer::holding(device_, "rays", "check", pack(rays));
    const Buffer hit_buffer(device_, "hits", "check", rays.size() * sizeof(f32x4));
    launch(device_, kernel_, "trace_rays", rays.size(), local_size_, nodes_, blocks_, ray_buffer, hit_buffer,
           static_cast<uint32_t>(rays.size()), query);
    std::vector<TraceHit> hits;
    hits.reserve(rays.size());
    for (const f32x4& lane : hit_buffer.contents<f32x4>())
        hits.push_back(hit_of(lane));
    return hits;
}

void Visits::add(const Visits& other) {
    rays += other.rays;
    hits += other.hits;
    nodes += other.nodes;
    blocks += other.blocks;
    stack_entries = std::max(stack_entries, other.stack_entries);
}

VisitCounter::VisitCounter(Device& device, ProgramLibrary& library, const Bvh& bvh,
                           const std::string& options)
    : device_(device),
      local_size_(library.local_size()),
      nodes_(Buffer::holding(device, "nodes", "check", bvh.nodes)),
      blocks_(Buffer::holding(device, "blocks", "check", bvh.blocks)),
      kernel_(library.kernel("visits", options)) {}

Visits VisitCounter::count(std::span<const TraceRay> rays, bool any_hit) const {
    Visits sum;
    if (rays.empty()) return sum;
    const Buffer ray_buffer = Buffer::holding(device_, "rays", "check", pack(rays));
    const Buffer count_buffer(device_, "visits", "check", rays.size() * sizeof(u32x4));
    launch(device_, kernel_, "visits", rays.size(), local_size_, nodes_, blocks_, ray_buffer, count_buffer,
           static_cast<uint32_t>(rays.size()), any_hit ? 1u : 0u);
    for (const u32x4& one : count_buffer.contents<u32x4>())
        sum.add({1, one.w, one.x, one.y, one.z});
    return sum;
}

}  // namespace obscura
