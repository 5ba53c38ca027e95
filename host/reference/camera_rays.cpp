// SPDX-License-Identifier: Apache-2.0
#include "reference/camera_rays.h"

#include "sampling/filter.h"
#include "shared/scene.h"

#include <cmath>

namespace obscura::reference {

CameraRays::CameraRays(const Camera& camera, const RenderSettings& settings)
    : orthographic_(camera.orthographic), width_(settings.width), height_(settings.height) {
    const double half_height = camera.orthographic ? camera.half_height : std::tan(camera.vertical_fov / 2);
    camera.camera_to_world.multDirMatrix(V3d(half_height * width_ / height_, 0, 0), right_);
    camera.camera_to_world.multDirMatrix(V3d(0, half_height, 0), up_);
    camera.camera_to_world.multDirMatrix(V3d(0, 0, -1), forward_);
    origin_ = camera.camera_to_world.translation();
    if (settings.filter != PixelFilter::box) filter_ = inverse_filter_cdf(settings.filter, FILTER_TABLE_SIZE);
}

// From the pixel's centre, in pixels: linear between the entries of the table.
double CameraRays::filter_offset(double u) const {
    if (filter_.empty()) return u - 0.5;
    const double x = u * FILTER_TABLE_SIZE;
    const auto i = static_cast<size_t>(x);
    return std::lerp(static_cast<double>(filter_[i]), static_cast<double>(filter_[i + 1]),
                     x - static_cast<double>(i));
}

Ray CameraRays::ray(uint32_t x, uint32_t y, const PathSampler& sampler) const {
    const V2d u = sampler.pixel();
    const double across = 2 * (x + 0.5 + filter_offset(u.x)) / width_ - 1;
    const double upwards = 1 - 2 * (y + 0.5 + filter_offset(u.y)) / height_;
    const V3d shift = across * right_ + upwards * up_;
    if (orthographic_) return {origin_ + shift, forward_};
    return {origin_, (forward_ + shift).normalized()};
}

}  // namespace obscura::reference
