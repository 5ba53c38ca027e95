// SPDX-License-Identifier: Apache-2.0
#include "reference/embree_scene.h"

#include "base/error.h"
#include "base/stopwatch.h"

#include <cmath>

namespace obscura {
namespace {

bool count_bytes(void* sum, ssize_t bytes, bool) {
    *static_cast<std::atomic<int64_t>*>(sum) += bytes;
    return true;
}

bool is_within_limit(const V3f& vector) {
    return std::abs(vector.x) <= EMBREE_LARGEST && std::abs(vector.y) <= EMBREE_LARGEST &&
           std::abs(vector.z) <= EMBREE_LARGEST;
}

}  // namespace

void check_embree_limit(const V3f& origin, const V3f& direction) {
    const auto refuse = [](const char* ray, const V3f& far_away, const char* what) {
        throw InputError(
            "{} ({:g}, {:g}, {:g}), and Embree takes no coordinate above {:g}; move the {} nearer to the "
            "scene",
            ray, far_away.x, far_away.y, far_away.z, EMBREE_LARGEST, what);
    };
    if (!is_within_limit(origin)) refuse("a ray starts at", origin, "camera");
    if (!is_within_limit(direction)) refuse("a shadow ray goes along", direction, "light");
}

EmbreeScene::EmbreeScene(const Scene& scene, bool robust) : device_(rtcNewDevice(nullptr)) {
    OBSCURA_CHECK(device_ != nullptr, "Embree has no device, error {}",
                  static_cast<int>(rtcGetDeviceError(nullptr)));
    rtcSetDeviceMemoryMonitorFunction(device_, count_bytes, &bytes_);
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);

    if (!scene.triangles.empty()) {
        positions_.reserve(scene.vertices.size() + 1);
        for (const Vertex& vertex : scene.vertices)
            positions_.push_back(vertex.position);
        positions_.emplace_back(0.0f);  // Embree reads 16 bytes at each vertex
        indices_.reserve(scene.triangles.size());
        for (const Triangle& triangle : scene.triangles)
            indices_.push_back(triangle.vertex);
        const RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions_.data(), 0,
                                   sizeof(V3f), scene.vertices.size());
        rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, indices_.data(), 0,
                                   sizeof(indices_[0]), indices_.size());
        rtcSetGeometryBuildQuality(mesh, RTC_BUILD_QUALITY_HIGH);
        rtcCommitGeometry(mesh);
        rtcAttachGeometry(scene_, mesh);
        rtcReleaseGeometry(mesh);
    }
    const Stopwatch build_watch;
    rtcCommitScene(scene_);
    build_seconds_ = build_watch.seconds();
    const RTCError error = rtcGetDeviceError(device_);
    OBSCURA_CHECK(error == RTC_ERROR_NONE, "Embree failed to build the scene, error {}",
                  static_cast<int>(error));
}

EmbreeScene::~EmbreeScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
}

}  // namespace obscura
