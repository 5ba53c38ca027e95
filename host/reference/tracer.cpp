// SPDX-License-Identifier: Apache-2.0
// Embree in its most careful mode: robust (watertight) intersection, high build quality, rays traced one by
// one, as suits rays without coherence.
#include "reference/tracer.h"

#include "base/error.h"

#include <embree3/rtcore.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace obscura {
namespace {

constexpr size_t RAYS_PER_TASK = 1024;

// Embree asks for denormals to be flushed to zero while it traces, because they are slow.
// Restores the thread's mode, which belongs to the caller.
class FlushDenormals {
  public:
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;
#if defined(__SSE__)
    FlushDenormals() : saved_(_mm_getcsr()) {
        _mm_setcsr(saved_ | FLUSH_TO_ZERO | DENORMALS_ARE_ZERO);
    }
    ~FlushDenormals() {
        _mm_setcsr(saved_);
    }

  private:
    static constexpr unsigned int FLUSH_TO_ZERO = 0x8000;
    static constexpr unsigned int DENORMALS_ARE_ZERO = 0x0040;
    unsigned int saved_;
#else
    FlushDenormals() = default;
#endif
};

RTCRay embree_ray(const TraceRay& ray) {
    RTCRay result{};
    result.org_x = ray.origin.x;
    result.org_y = ray.origin.y;
    result.org_z = ray.origin.z;
    result.dir_x = ray.direction.x;
    result.dir_y = ray.direction.y;
    result.dir_z = ray.direction.z;
    // Embree's ends are inclusive, ours starts at 0 exclusive: without denormals t > 0 is the same as this.
    result.tnear = std::numeric_limits<float>::min();
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
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;

    Embree() = default;
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;
    ~Embree() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }

    TraceHit closest(RTCIntersectContext& context, const RTCRay& ray) const {
        RTCRayHit query{};
        query.ray = ray;
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene, &context, &query);
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {ray.tfar, 0, 0, NO_PRIMITIVE};
        return {query.ray.tfar, query.hit.u, query.hit.v, query.hit.primID};
    }
};

ReferenceTracer::ReferenceTracer(const Scene& scene) : embree_(std::make_unique<Embree>()) {
    embree_->device = rtcNewDevice(nullptr);
    OBSCURA_CHECK(embree_->device != nullptr, "Embree has no device, error {}",
                  static_cast<int>(rtcGetDeviceError(nullptr)));
    embree_->scene = rtcNewScene(embree_->device);
    rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(embree_->scene, RTC_BUILD_QUALITY_HIGH);

    if (!scene.triangles.empty()) {
        const RTCGeometry mesh = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* const positions = static_cast<V3f*>(rtcSetNewGeometryBuffer(
            mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(V3f), scene.vertices.size()));
        auto* const indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
            mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), scene.triangles.size()));
        OBSCURA_CHECK(positions != nullptr && indices != nullptr, "Embree has no memory for the scene");
        for (size_t i = 0; i < scene.vertices.size(); ++i)
            positions[i] = scene.vertices[i].position;
        for (size_t i = 0; i < scene.triangles.size(); ++i)
            std::memcpy(indices + 3 * i, scene.triangles[i].vertex.data(), 3 * sizeof(uint32_t));
        rtcSetGeometryBuildQuality(mesh, RTC_BUILD_QUALITY_HIGH);
        rtcCommitGeometry(mesh);
        rtcAttachGeometry(embree_->scene, mesh);
        rtcReleaseGeometry(mesh);
    }
    rtcCommitScene(embree_->scene);
    const RTCError error = rtcGetDeviceError(embree_->device);
    OBSCURA_CHECK(error == RTC_ERROR_NONE, "Embree failed to build the scene, error {}",
                  static_cast<int>(error));
}

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
        rtcOccluded1(embree_->scene, &context, &ray);
        results[i] = ray.tfar == -std::numeric_limits<float>::infinity() ? 1 : 0;
    });
}

}  // namespace obscura
