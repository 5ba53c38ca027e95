// SPDX-License-Identifier: Apache-2.0
#include "reference/embree_modes.h"

#include "base/stopwatch.h"
#include "reference/embree_scene.h"
#include "reference/flush_denormals.h"
#include "reference/ray_order.h"
#include "scene/material.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>
#include <optional>
#include <type_traits>
#include <utility>

namespace obscura {
namespace {

using RayBlock = ArrangedRays::RayBlock;
using HitBlock = ArrangedRays::HitBlock;
constexpr size_t BLOCK = ArrangedRays::BLOCK;
constexpr size_t BLOCKS_PER_TASK = 64;
constexpr size_t BLOCKS_PER_STREAM = 16;  // so that the rays of a call stay in the first-level cache

struct Work {
    RTCScene scene;
    RTCIntersectContext* context;
    std::span<const RayBlock> rays;
    std::span<HitBlock> hits;
    size_t count;  // of rays: the last block may not be full
};

RTCRay ray_of(const RayBlock& block, size_t lane) {
    RTCRay ray{};
    ray.org_x = block.org_x[lane];
    ray.org_y = block.org_y[lane];
    ray.org_z = block.org_z[lane];
    ray.dir_x = block.dir_x[lane];
    ray.dir_y = block.dir_y[lane];
    ray.dir_z = block.dir_z[lane];
    ray.tnear = EmbreeScene::T_NEAR;
    ray.tfar = block.t_max[lane];
    ray.mask = ~0u;
    return ray;
}

RTCRayHit query_of(const RayBlock& block, size_t lane) {
    RTCRayHit query;
    query.ray = ray_of(block, lane);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return query;
}

void store(const RTCRayHit& query, HitBlock& hits, size_t lane) {
    hits.t[lane] = query.ray.tfar;
    hits.u[lane] = query.hit.u;
    hits.v[lane] = query.hit.v;
    hits.primitive[lane] = query.hit.geomID == RTC_INVALID_GEOMETRY_ID ? NO_PRIMITIVE : query.hit.primID;
}

// Embree marks an occluded ray by t_far = -inf.
void store(const RTCRay& ray, HitBlock& hits, size_t lane) {
    hits.primitive[lane] = ray.tfar < 0 ? 0 : NO_PRIMITIVE;
}

void trace_single(const Work& work, RayQuery query) {
    for (size_t i = 0; i < work.count; ++i) {
        const RayBlock& block = work.rays[i / BLOCK];
        HitBlock& hits = work.hits[i / BLOCK];
        if (query != RayQuery::closest) {
            RTCRay ray = ray_of(block, i % BLOCK);
            rtcOccluded1(work.scene, work.context, &ray);
            store(ray, hits, i % BLOCK);
        } else {
            RTCRayHit closest = query_of(block, i % BLOCK);
            rtcIntersect1(work.scene, work.context, &closest);
            store(closest, hits, i % BLOCK);
        }
    }
}

template <size_t N>
void copy_row(const float* from, float (&to)[N]) {
    std::memcpy(to, from, sizeof(to));
}

// As many rays as the packet has lanes, from the given one on.
template <typename Packet>
Packet packet_of(const RayBlock& block, size_t lane) {
    Packet packet{};
    copy_row(block.org_x + lane, packet.org_x);
    copy_row(block.org_y + lane, packet.org_y);
    copy_row(block.org_z + lane, packet.org_z);
    copy_row(block.dir_x + lane, packet.dir_x);
    copy_row(block.dir_y + lane, packet.dir_y);
    copy_row(block.dir_z + lane, packet.dir_z);
    copy_row(block.t_max + lane, packet.tfar);
    std::ranges::fill(packet.tnear, EmbreeScene::T_NEAR);
    std::ranges::fill(packet.mask, ~0u);
    return packet;
}

// RayHit: RTCRayHit8 or 16; closest, any: the functions that trace it.
template <typename RayHit, typename Closest, typename Any>
void trace_packets(const Work& work, RayQuery query, const Closest& closest, const Any& any) {
    using Ray = decltype(RayHit::ray);
    constexpr size_t WIDTH = std::extent_v<decltype(Ray::tfar)>;
    for (size_t first = 0; first < work.count; first += WIDTH) {
        const size_t begin = first % BLOCK;
        HitBlock& hits = work.hits[first / BLOCK];
        alignas(64) std::array<int, WIDTH> valid;
        for (size_t lane = 0; lane < WIDTH; ++lane)
            valid[lane] = first + lane < work.count ? -1 : 0;
        RayHit packet;
        packet.ray = packet_of<Ray>(work.rays[first / BLOCK], begin);
        if (query != RayQuery::closest) {
            any(valid.data(), work.scene, work.context, &packet.ray);
            for (size_t lane = 0; lane < WIDTH; ++lane)
                hits.primitive[begin + lane] = packet.ray.tfar[lane] < 0 ? 0 : NO_PRIMITIVE;
            continue;
        }
        std::ranges::fill(packet.hit.geomID, RTC_INVALID_GEOMETRY_ID);
        std::ranges::fill(packet.hit.instID[0], RTC_INVALID_GEOMETRY_ID);
        closest(valid.data(), work.scene, work.context, &packet);
        for (size_t lane = 0; lane < WIDTH; ++lane) {
            hits.t[begin + lane] = packet.ray.tfar[lane];
            hits.u[begin + lane] = packet.hit.u[lane];
            hits.v[begin + lane] = packet.hit.v[lane];
            hits.primitive[begin + lane] =
                packet.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID ? NO_PRIMITIVE : packet.hit.primID[lane];
        }
    }
}

// make: a ray in Embree's form; call: what traces so many of them.
template <typename Make, typename Call>
void trace_stream(const Work& work, const Make& make, const Call& call) {
    constexpr size_t STREAM = BLOCKS_PER_STREAM * BLOCK;
    std::array<decltype(make(work.rays[0], 0)), STREAM> stream;
    for (size_t first = 0; first < work.count; first += STREAM) {
        const size_t count = std::min(STREAM, work.count - first);
        for (size_t i = 0; i < count; ++i)
            stream[i] = make(work.rays[(first + i) / BLOCK], i % BLOCK);
        call(work.scene, work.context, stream.data(), static_cast<unsigned>(count), sizeof(stream[0]));
        for (size_t i = 0; i < count; ++i)
            store(stream[i], work.hits[(first + i) / BLOCK], i % BLOCK);
    }
}

void trace_part(const Work& work, EmbreeCall call, RayQuery query) {
    switch (call) {
        case EmbreeCall::single:
            return trace_single(work, query);
        case EmbreeCall::packet8:
            return trace_packets<RTCRayHit8>(work, query, rtcIntersect8, rtcOccluded8);
        case EmbreeCall::packet16:
            return trace_packets<RTCRayHit16>(work, query, rtcIntersect16, rtcOccluded16);
        case EmbreeCall::stream:
            if (query != RayQuery::closest) return trace_stream(work, ray_of, rtcOccluded1M);
            return trace_stream(work, query_of, rtcIntersect1M);
    }
}

std::vector<uint32_t> queue_order(size_t count) {
    std::vector<uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    return order;
}

}  // namespace

const std::vector<EmbreeMode>& embree_modes() {
    static const std::vector<EmbreeMode> modes = [] {
        using enum EmbreeCall;
        std::vector<EmbreeMode> all;
        for (const bool robust : {true, false}) {
            for (const EmbreeCall call : {single, packet8, packet16, stream}) {
                for (const bool coherent : {false, true}) {
                    if (call == single && coherent) continue;
                    for (const bool sorted : {false, true})
                        all.push_back({robust, call, coherent, sorted});
                }
            }
        }
        return all;
    }();
    return modes;
}

std::string call_text(const EmbreeMode& mode) {
    static constexpr std::array NAMES{"single", "packets of 8", "packets of 16", "stream"};
    return std::string(NAMES.at(static_cast<size_t>(mode.call))) + (mode.coherent ? ", coherent" : "") +
           (mode.sorted ? ", sorted" : "");
}

ArrangedRays::ArrangedRays(std::span<const TraceRay> rays, std::vector<uint32_t> order)
    : order_(std::move(order)),
      rays_((order_.size() + BLOCK - 1) / BLOCK, RayBlock{}),
      hits_(rays_.size(), HitBlock{}) {
    for (size_t i = 0; i < order_.size(); ++i) {
        const TraceRay& ray = rays[order_[i]];
        check_embree_limit(ray.origin, ray.direction);
        RayBlock& block = rays_[i / BLOCK];
        const size_t lane = i % BLOCK;
        block.org_x[lane] = ray.origin.x;
        block.org_y[lane] = ray.origin.y;
        block.org_z[lane] = ray.origin.z;
        block.dir_x[lane] = ray.direction.x;
        block.dir_y[lane] = ray.direction.y;
        block.dir_z[lane] = ray.direction.z;
        // Embree's ends are inclusive, ours aren't: a shadow ray would end at its own lamp.
        block.t_max[lane] = std::isinf(ray.t_max) ? ray.t_max : std::nextafter(ray.t_max, 0.0f);
    }
}

std::vector<TraceHit> ArrangedRays::hits_in_order() const {
    std::vector<TraceHit> hits(order_.size());
    for (size_t i = 0; i < order_.size(); ++i) {
        const HitBlock& block = hits_[i / BLOCK];
        const size_t lane = i % BLOCK;
        hits[order_[i]] = {block.t[lane], block.u[lane], block.v[lane], block.primitive[lane]};
    }
    return hits;
}

EmbreeRays::EmbreeRays(std::span<const TraceRay> rays)
    : unsorted_(rays, queue_order(rays.size())), sorted_(rays, coherent_order(rays)) {}

struct EmbreeRunner::State {
    EmbreeScene robust, fast;
    tbb::task_arena threads;
    std::optional<EmbreeScene> robust_through_panes, fast_through_panes;  // where the scene has any

    const EmbreeScene& scene(bool is_robust, RayQuery query) const {
        const auto& through_panes = is_robust ? robust_through_panes : fast_through_panes;
        if (query == RayQuery::opaque && through_panes) return *through_panes;
        return is_robust ? robust : fast;
    }
};

EmbreeRunner::EmbreeRunner(const Scene& scene, int threads)
    : state_(
          new State{EmbreeScene(scene, true), EmbreeScene(scene, false), tbb::task_arena(threads), {}, {}}) {
    const bool has_panes = std::ranges::any_of(scene.triangles, [&](const Triangle& triangle) {
        return is_pane(scene.materials[triangle.material]);
    });
    if (!has_panes) return;
    state_->robust_through_panes.emplace(scene, true, EmbreePanes::passed);
    state_->fast_through_panes.emplace(scene, false, EmbreePanes::passed);
}
EmbreeRunner::~EmbreeRunner() = default;

double EmbreeRunner::trace(const EmbreeMode& mode, RayQuery query, EmbreeRays& rays) const {
    ArrangedRays& arranged = rays.arranged(mode);
    const std::span<const RayBlock> blocks = arranged.rays();
    const auto trace_range = [&](const tbb::blocked_range<size_t>& range) {
        const FlushDenormals flush;
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags =
            mode.coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
        const size_t count = std::min(range.size() * BLOCK, arranged.size() - range.begin() * BLOCK);
        const Work work{state_->scene(mode.robust, query).handle(), &context,
                        blocks.subspan(range.begin(), range.size()),
                        arranged.hits().subspan(range.begin(), range.size()), count};
        trace_part(work, mode.call, query);
    };
    const Stopwatch watch;
    state_->threads.execute([&] {
        tbb::parallel_for(tbb::blocked_range<size_t>(0, blocks.size(), BLOCKS_PER_TASK), trace_range);
    });
    return watch.seconds();
}

bool EmbreeRunner::has_panes() const {
    return state_->robust_through_panes.has_value();
}

EmbreeCost EmbreeRunner::cost(bool robust) const {
    const EmbreeScene& scene = state_->scene(robust, RayQuery::closest);
    return {scene.bytes(), scene.build_seconds()};
}

}  // namespace obscura
