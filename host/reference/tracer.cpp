// SPDX-License-Identifier: Apache-2.0
// Embree in its most careful mode: robust (watertight) intersection, high build quality, rays traced one by
// one, as suits rays without coherence.
#include "reference/tracer.h"

#include "base/error.h"
#include "reference/embree_scene.h"
#include "reference/flush_denormals.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace obscura {
namespace {

constexpr size_t RAYS_PER_TASK = 1024;

RTCRay embree_ray(const TraceRay& ray) {
    check_embree_limit(ray.origin, ray.direction);
    RTCRay result{};
    result.org_x = ray.origin.x;
    result.org_y = ray.origin.y;
    result.org_z = ray.origin.z;
    result.dir_x = ray.direction.x;
    result.dir_y = ray.direction.y;
    result.dir_z = ray.direction.z;
    result.tnear = EmbreeScene::T_NEAR;
    result.tfar = ray.t_max;
    result.mask = ~0U;
    return result;
}

template <typename Trace>
void for_each_ray(size_t count, const Trace& trace) {
    tbb::parallel_for(tbb::blocked_range<size_t>(0, count, RAYS_PER_TASK), [&](const auto& range) {
        const FlushDenormals flush;
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        for (size_t i = range.begin(); i < range.end(); ++i)
            trace(context, i);
    });
}

}  // namespace

struct ReferenceTracer::Embree {
    EmbreeScene scene;

    TraceHit closest(RTCIntersectContext& context, const RTCRay& ray) const {
        RTCRayHit query{};
        query.ray = ray;
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene.handle(), &context, &query);
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {ray.tfar, 0, 0, NO_PRIMITIVE};
        return {query.ray.tfar, query.hit.u, query.hit.v, query.hit.primID};
    }
};

ReferenceTracer::ReferenceTracer(const Scene& scene) : embree_(new Embree{EmbreeScene(scene)}) {}
ReferenceTracer::~ReferenceTracer() = default;

void ReferenceTracer::closest(std::span<const TraceRay> rays, std::span<TraceHit> hits) const {
    OBSCURA_CHECK(rays.size() == hits.size(), "{} rays, room for {} hits", rays.size(), hits.size());
    for_each_ray(rays.size(), [&](RTCIntersectContext& context, size_t i) {
        hits[i] = embree_->closest(context, embree_ray(rays[i]));
    });
}

TraceHit ReferenceTracer::next(const TraceRay& ray, float after) const {
    const FlushDenormals flush;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay beyond = embree_ray(ray);
    beyond.tnear = std::max(beyond.tnear, std::nextafter(after, std::numeric_limits<float>::infinity()));
    return embree_->closest(context, beyond);
}

void ReferenceTracer::occluded(std::span<const TraceRay> rays, std::span<uint8_t> results) const {
    OBSCURA_CHECK(rays.size() == results.size(), "{} rays, room for {} results", rays.size(), results.size());
    for_each_ray(rays.size(), [&](RTCIntersectContext& context, size_t i) {
        RTCRay ray = embree_ray(rays[i]);
        rtcOccluded1(embree_->scene.handle(), &context, &ray);
        results[i] = ray.tfar == -std::numeric_limits<float>::infinity() ? 1 : 0;
    });
}

}  // namespace obscura
