// SPDX-License-Identifier: Apache-2.0
// Rays and hits of the device, brought to the host: of any rays a test makes up (DeviceTracer), and of the real
// rays that a render traces (RayCapture, which looks at the queues through RenderJob::observer). Obscurance rays
// are never stored by a render, so a probe kernel makes them again with the very functions of the stage.
#pragma once

#include "bvh/bvh.h"
#include "device/buffer.h"
#include "device/launch.h"
#include "device/program.h"
#include "reference/tracer.h"
#include "shared/frame.h"
#include "shared/wavefront.h"
#include "wavefront/scheduler.h"

#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace obscura::test {

inline V3f xyz(const f32x4& lane) {
    return {lane.x, lane.y, lane.z};
}

inline TraceHit hit_of(const f32x4& lane) {
    return {lane.x, lane.y, lane.z, std::bit_cast<uint32_t>(lane.w)};
}

// The device's traversal as a tracer with the reference tracer's interface.
class DeviceTracer {
  public:
    DeviceTracer(Device& device, const Bvh& bvh, const std::string& options = {})
        : device_(device),
          library_(device),
          nodes_(Buffer::holding(device, "nodes", "bvh", bvh.nodes)),
          blocks_(Buffer::holding(device, "blocks", "bvh", bvh.blocks)) {
        constexpr const char* SOURCE = R"(
#include "lib/traverse.clh"
kernel void probe(global const BvhNode* nodes, global const TriangleBlock* blocks, global const float4* rays,
                  global float4* hits, uint count, uint any_hit) {
    const uint i = (uint)get_global_id(0);
    if (i >= count) return;
    const float4 origin = rays[2u * i];
    const float3 direction = rays[2u * i + 1u].xyz;
    Hit hit;
    if (any_hit != 0u) {
        hit = traverse(nodes, blocks, origin.xyz, direction, origin.w, true);
    } else {
        hit = traverse(nodes, blocks, origin.xyz, direction, origin.w, false);
    }
    hits[i] = (float4)(hit.t, hit.u, hit.v, as_float(hit.primitive));
})";
        kernel_ = library_.kernel_from_text("traversal probe", SOURCE, "probe", options);
    }

    std::vector<TraceHit> closest(std::span<const TraceRay> rays) { return trace(rays, false); }

    // 1 where anything is hit, else 0.
    std::vector<uint8_t> occluded(std::span<const TraceRay> rays) {
        std::vector<uint8_t> blocked;
        for (const TraceHit& hit : trace(rays, true))
            blocked.push_back(hit.primitive != NO_PRIMITIVE ? 1 : 0);
        return blocked;
    }

  private:
    std::vector<TraceHit> trace(std::span<const TraceRay> rays, bool any_hit) {
        if (rays.empty()) return {};
        std::vector<f32x4> lanes;
        lanes.reserve(2 * rays.size());
        for (const TraceRay& ray : rays) {
            lanes.push_back({ray.origin.x, ray.origin.y, ray.origin.z, ray.t_max});
            lanes.push_back({ray.direction.x, ray.direction.y, ray.direction.z, 0});
        }
        const Buffer ray_buffer = Buffer::holding(device_, "probe rays", "test", lanes);
        const Buffer hit_buffer(device_, "probe hits", "test", rays.size() * sizeof(f32x4));
        launch(device_, kernel_, "traversal probe", rays.size(), library_.local_size(), nodes_, blocks_,
               ray_buffer, hit_buffer, static_cast<uint32_t>(rays.size()), any_hit ? 1u : 0u);
        std::vector<TraceHit> hits;
        hits.reserve(rays.size());
        for (const f32x4& lane : hit_buffer.contents<f32x4>())
            hits.push_back(hit_of(lane));
        return hits;
    }

    Device& device_;
    ProgramLibrary library_;
    Buffer nodes_, blocks_;
    cl::Kernel kernel_;
};

// Rays of one launch with what the device found. Of obscurance rays also where each starts relative to its point
// (distances count from there) and what the stage made of its hit.
struct CapturedRays {
    std::vector<TraceRay> rays;
    std::vector<TraceHit> hits;
    std::vector<V3f> starts;
    std::vector<f32x4> results;
};

class RayCapture {
  public:
    RayCapture(Device& device, const Scene& scene) : device_(device), library_(device) {
        const Bvh bvh = build_bvh(scene);
        nodes_ = Buffer::holding(device, "nodes", "bvh", bvh.nodes);
        blocks_ = Buffer::holding(device, "blocks", "bvh", bvh.blocks);
        constexpr const char* SOURCE = R"(
#include "lib/obscurance_ray.clh"
#include "lib/traverse.clh"
kernel void probe(global const Frame* frame, global const BvhNode* nodes, global const TriangleBlock* blocks,
                  global const float4* points, global const float4* paths, global float4* out, uint count,
                  uint depth) {
    const uint item = (uint)get_global_id(0);
    if (item >= count) return;
    const uint k_count = frame->sampling.y;
    const ObscurancePoint point = load_obscurance_point(frame, points, paths, item / k_count, depth);
    const uint lane = item % k_count % DIRECTION_BATCH;
    Directions directions;
    obscurance_directions(&point, item % k_count - lane, &directions);
    const float3 direction = (float3)(directions.x[lane], directions.y[lane], directions.z[lane]);
    const float limit = distance_limit(point.start, direction, frame->obscurance.x);
    const float3 origin = point.position + point.start;
    const Hit hit = traverse(nodes, blocks, origin, direction, limit, false);
    out[4u * item] = (float4)(origin, limit);
    out[4u * item + 1u] = (float4)(direction, as_float(point.slot));
    out[4u * item + 2u] = (float4)(hit.t, hit.u, hit.v, as_float(hit.primitive));
    out[4u * item + 3u] = (float4)(point.start, 0.0f);
})";
        probe_ = library_.kernel_from_text("obscurance probe", SOURCE, "probe");
    }

    // The rays of the stage trace at one depth, with the hits it stored.
    CapturedRays traced(const DepthView& view, const Frame& frame, const Queues& queues) const {
        const uint32_t capacity = frame.crop.w;
        std::vector<f32x4> origins(view.ray_count), directions(view.ray_count), hits(view.ray_count);
        queues.rays.download(origins, uint64_t{RAY_ORIGIN} * capacity);
        queues.rays.download(directions, uint64_t{RAY_DIRECTION} * capacity);
        queues.rays.download(hits, uint64_t{RAY_HIT} * capacity);
        CapturedRays captured;
        for (size_t i = 0; i < origins.size(); ++i) {
            captured.rays.push_back(
                {xyz(origins[i]), xyz(directions[i]), std::numeric_limits<float>::infinity()});
            captured.hits.push_back(hit_of(hits[i]));
        }
        return captured;
    }

    // The K rays of each obscurance point of a depth.
    CapturedRays obscurance(const DepthView& view, const Frame& frame, const Queues& queues) {
        constexpr size_t LANES = 4;
        const uint32_t k_count = frame.sampling.y;
        const uint32_t count = view.point_count * k_count;
        CapturedRays captured;
        if (count == 0) return captured;
        const uint64_t bytes = LANES * count * sizeof(f32x4);
        if (out_.bytes() < bytes) out_ = Buffer(device_, "probe", "test", bytes);
        launch(device_, probe_, "obscurance probe", count, library_.local_size(), queues.frame, nodes_,
               blocks_, queues.points, queues.paths, out_, count, view.depth);
        std::vector<f32x4> lanes(LANES * count);
        out_.download(lanes);
        const std::vector<f32x4> results = queues.results.contents<f32x4>();
        for (uint32_t item = 0; item < count; ++item) {
            const f32x4* const lane = &lanes[LANES * item];
            const auto slot = std::bit_cast<uint32_t>(lane[1].w);
            captured.rays.push_back({xyz(lane[0]), xyz(lane[1]), lane[0].w});
            captured.hits.push_back(hit_of(lane[2]));
            captured.starts.push_back(xyz(lane[3]));
            captured.results.push_back(results[size_t{slot} * k_count + item % k_count]);
        }
        return captured;
    }

  private:
    Device& device_;
    ProgramLibrary library_;
    Buffer nodes_, blocks_, out_;
    cl::Kernel probe_;
};

}  // namespace obscura::test
