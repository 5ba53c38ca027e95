// SPDX-License-Identifier: Apache-2.0
#include "reference/embree_scene.h"

#include "base/error.h"
#include "base/stopwatch.h"
#include "scene/material.h"

#include <cmath>

namespace obscura {
namespace {

bool count_bytes(void* sum, ssize_t bytes, bool) {
    *static_cast<std::atomic<int64_t>*>(sum) += bytes;
    return true;
}

void let_pass(const RTCFilterFunctionNArguments* hits) {
    for (unsigned i = 0; i < hits->N; ++i)
        hits->valid[i] = 0;
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

EmbreeScene::EmbreeScene(const Scene& scene, bool robust, EmbreePanes panes)
    : device_(rtcNewDevice(nullptr)) {
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
        const auto passes = [&](const Triangle& triangle) {
            return panes == EmbreePanes::passed && is_pane(scene.materials[triangle.material]);
        };
        for (const Triangle& triangle : scene.triangles)
            if (!passes(triangle)) indices_.push_back(triangle.vertex);
        const size_t solid_count = indices_.size();
        for (const Triangle& triangle : scene.triangles)
            if (passes(triangle)) indices_.push_back(triangle.vertex);
        attach_mesh(0, solid_count, EmbreePanes::solid);
        attach_mesh(solid_count, indices_.size(), EmbreePanes::passed);
    }
    const Stopwatch build_watch;
    rtcCommitScene(scene_);
    build_seconds_ = build_watch.seconds();
    const RTCError error = rtcGetDeviceError(device_);
    OBSCURA_CHECK(error == RTC_ERROR_NONE, "Embree failed to build the scene, error {}",
                  static_cast<int>(error));
}

void EmbreeScene::attach_mesh(size_t first, size_t last, EmbreePanes panes) {
    if (first == last) return;
    const RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions_.data(), 0,
                               sizeof(V3f), positions_.size() - 1);
    rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, indices_.data(),
                               first * sizeof(indices_[0]), sizeof(indices_[0]), last - first);
    rtcSetGeometryBuildQuality(mesh, RTC_BUILD_QUALITY_HIGH);
    if (panes == EmbreePanes::passed) rtcSetGeometryOccludedFilterFunction(mesh, let_pass);
    rtcCommitGeometry(mesh);
    rtcAttachGeometry(scene_, mesh);
    rtcReleaseGeometry(mesh);
}

EmbreeScene::~EmbreeScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
}

}  // namespace obscura
