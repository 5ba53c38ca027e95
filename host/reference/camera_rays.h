// SPDX-License-Identifier: Apache-2.0
// Camera rays in double.
#pragma once

#include "reference/precise_tracer.h"
#include "reference/sampler.h"
#include "scene/settings.h"

#include <vector>

namespace obscura::reference {

class CameraRays {
  public:
    CameraRays(const Camera& camera, const RenderSettings& settings);

    // Through pixel x, y of the whole picture, at the sample's place within the pixel filter.
    Ray ray(uint32_t x, uint32_t y, const PathSampler& sampler) const;

  private:
    double filter_offset(double u) const;

    bool orthographic_;
    V3d origin_, right_, up_, forward_;  // right and up scaled to half the picture
    double width_, height_;              // pixels
    std::vector<float> filter_;          // inverse cdf; empty for the box
};

}  // namespace obscura::reference
