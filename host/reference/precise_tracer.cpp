// SPDX-License-Identifier: Apache-2.0
#include "reference/precise_tracer.h"

#include "base/error.h"
#include "reference/directions.h"
#include "reference/embree_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace obscura::reference {
namespace {

using Corners = std::array<V3d, 3>;

// What Embree's callbacks know of the scene.
struct Geometry {
    std::vector<Corners> triangles;
    double padding = 0;  // of the boxes, m
};

// Embree hands its context on to the callbacks: ours carries the ray in double and the nearest hit so far.
struct Query {
    RTCIntersectContext context;  // first, so that a pointer to it is one to the whole
    Ray ray;
    Basis basis;  // about the ray
    Hit hit;
};

float float_above(double x) {
    return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity());
}

// Seen along the ray: the ray is the origin of a plane.
V2d project(const V3d& corner, const Query& query) {
    const V3d from_origin = corner - query.ray.origin;
    return {from_origin.dot(query.basis.tangent), from_origin.dot(query.basis.bitangent)};
}

// Neighbours compute the same number with opposite signs for the edge they share, from the same projected corners, so
// no ray slips between them; nor through a corner, since the projection keeps the order of the edges around it.
double edge_function(const V2d& from, const V2d& to) {
    return from.x * to.y - from.y * to.x;
}

void intersect(const Corners& corners, uint32_t primitive, Query& query) {
    const V2d a = project(corners[0], query);
    const V2d b = project(corners[1], query);
    const V2d c = project(corners[2], query);
    const double at_a = edge_function(b, c);
    const double at_b = edge_function(c, a);
    const double at_c = edge_function(a, b);
    const bool inside = (at_a >= 0 && at_b >= 0 && at_c >= 0) || (at_a <= 0 && at_b <= 0 && at_c <= 0);
    const double sum = at_a + at_b + at_c;
    if (!inside || sum == 0) return;
    // From the plane: differences of float corners are exact, so its normal is good to the last places.
    const V3d n = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    const double t = n.dot(corners[0] - query.ray.origin) / n.dot(query.ray.direction);
    if (!(t > 0 && t < query.ray.t_max)) return;
    Hit& hit = query.hit;
    if (t < hit.t || (t == hit.t && primitive < hit.primitive)) hit = {t, at_b / sum, at_c / sum, primitive};
}

void bound_callback(const RTCBoundsFunctionArguments* arguments) {
    const auto& geometry = *static_cast<const Geometry*>(arguments->geometryUserPtr);
    Box3d box;
    for (const V3d& corner : geometry.triangles[arguments->primID])
        box.extendBy(corner);
    const V3d low = box.min - V3d(geometry.padding);
    const V3d high = box.max + V3d(geometry.padding);
    RTCBounds& bounds = *arguments->bounds_o;
    bounds.lower_x = -float_above(-low.x);
    bounds.lower_y = -float_above(-low.y);
    bounds.lower_z = -float_above(-low.z);
    bounds.upper_x = float_above(high.x);
    bounds.upper_y = float_above(high.y);
    bounds.upper_z = float_above(high.z);
}

void intersect_callback(const RTCIntersectFunctionNArguments* arguments) {
    const auto& geometry = *static_cast<const Geometry*>(arguments->geometryUserPtr);
    auto& query = *reinterpret_cast<Query*>(arguments->context);
    intersect(geometry.triangles[arguments->primID], arguments->primID, query);
    if (!query.hit.found()) return;
    auto& ray = reinterpret_cast<RTCRayHit*>(arguments->rayhit)->ray;  // one ray at a time: N is 1
    ray.tfar = std::min(ray.tfar, float_above(query.hit.t));
}

void occluded_callback(const RTCOccludedFunctionNArguments* arguments) {
    const auto& geometry = *static_cast<const Geometry*>(arguments->geometryUserPtr);
    auto& query = *reinterpret_cast<Query*>(arguments->context);
    intersect(geometry.triangles[arguments->primID], arguments->primID, query);
    if (query.hit.found())
        reinterpret_cast<RTCRay*>(arguments->ray)->tfar = -std::numeric_limits<float>::infinity();
}

Query make_query(const Ray& ray) {
    Query query{{}, ray, Basis(ray.direction), {}};
    rtcInitIntersectContext(&query.context);
    return query;
}

RTCRay float_ray(const Ray& ray) {
    const V3f origin(ray.origin);
    const V3f direction(ray.direction);
    check_embree_limit(origin, direction);
    RTCRay result{};
    result.org_x = origin.x;
    result.org_y = origin.y;
    result.org_z = origin.z;
    result.dir_x = direction.x;
    result.dir_y = direction.y;
    result.dir_z = direction.z;
    result.tfar = float_above(ray.t_max);
    result.mask = ~0U;
    return result;
}

// A rounded ray strays from the true one by 2^-24 of its origin's coordinates and of its length. Within the scene, seen
// from any of its cameras, neither is longer than a few times the largest coordinate. From farther than Embree's limit no
// ray is traced.
double box_padding(const Scene& scene) {
    double largest = 0;
    const auto include = [&](const V3d& p) {
        for (int axis = 0; axis < 3; ++axis)
            largest = std::max(largest, std::abs(p[axis]));
    };
    for (const Vertex& vertex : scene.vertices)
        include(V3d(vertex.position));
    for (const Camera& camera : scene.cameras)
        include(camera.camera_to_world.translation());
    return 0x1p-21 * std::min(largest, static_cast<double>(EMBREE_LARGEST));
}

}  // namespace

struct PreciseTracer::Embree {
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene scene = nullptr;
    Geometry geometry;

    Embree() = default;
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;
    ~Embree() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
};

std::string tracer_name() {
    return "Embree " RTC_VERSION_STRING;
}

PreciseTracer::PreciseTracer(const Scene& scene) : embree_(std::make_unique<Embree>()) {
    Embree& embree = *embree_;
    OBSCURA_CHECK(embree.device != nullptr, "Embree has no device, error {}",
                  static_cast<int>(rtcGetDeviceError(nullptr)));
    embree.geometry.padding = box_padding(scene);
    for (uint32_t i = 0; i < scene.triangles.size(); ++i) {
        embree.geometry.triangles.push_back({V3d(scene.corner(i, 0).position),
                                             V3d(scene.corner(i, 1).position),
                                             V3d(scene.corner(i, 2).position)});
    }
    embree.scene = rtcNewScene(embree.device);
    rtcSetSceneFlags(embree.scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(embree.scene, RTC_BUILD_QUALITY_HIGH);
    if (!scene.triangles.empty()) {
        const RTCGeometry mesh = rtcNewGeometry(embree.device, RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(mesh, static_cast<unsigned int>(scene.triangles.size()));
        rtcSetGeometryUserData(mesh, &embree.geometry);
        rtcSetGeometryBoundsFunction(mesh, bound_callback, nullptr);
        rtcSetGeometryIntersectFunction(mesh, intersect_callback);
        rtcSetGeometryOccludedFunction(mesh, occluded_callback);
        rtcCommitGeometry(mesh);
        rtcAttachGeometry(embree.scene, mesh);
        rtcReleaseGeometry(mesh);
    }
    rtcCommitScene(embree.scene);
    const RTCError error = rtcGetDeviceError(embree.device);
    OBSCURA_CHECK(error == RTC_ERROR_NONE, "Embree failed to build the scene, error {}",
                  static_cast<int>(error));
}

PreciseTracer::~PreciseTracer() = default;

Hit PreciseTracer::nearest(const Ray& ray) const {
    Query query = make_query(ray);
    RTCRayHit rayhit{};
    rayhit.ray = float_ray(ray);
    rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(embree_->scene, &query.context, &rayhit);
    return query.hit;
}

bool PreciseTracer::is_blocked(const Ray& ray) const {
    Query query = make_query(ray);
    RTCRay float_query = float_ray(ray);
    rtcOccluded1(embree_->scene, &query.context, &float_query);
    return query.hit.found();
}

}  // namespace obscura::reference
