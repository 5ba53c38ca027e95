// SPDX-License-Identifier: Apache-2.0
// The random numbers of the kernels (kernels/lib/sampler.clh), bit for bit: sample points as a pure function of pixel,
// camera sample and dimension. A picture made with them differs from the device's in rounding alone.
#pragma once

#include "reference/directions.h"
#include "sampling/lattice.h"
#include "scene/settings.h"

#include <cstdint>

namespace obscura::reference {

// Dimensions at each vertex of a path, two numbers each.
enum class Dimension : uint32_t { obscurance = 0, area_light, select_light, lobe, bsdf };

// What all pixels of one set of samples share.
struct SamplePlan {
    SamplePlan(const RenderSettings& settings, uint64_t set_seed);

    SamplerKind kind;
    uint32_t spp, obscurance_rays, light_samples;
    uint32_t seed;
    LatticeSteps pixel, light, obscurance;
};

// The points that one camera sample owns in a dimension.
class SampleSet {
  public:
    // Point j: 24 bits of each coordinate, as directions and points on lights take them.
    V2d operator[](uint32_t j) const;
    // All 32 bits: of many things to choose from, each takes a small part of [0, 1).
    V2d exact(uint32_t j) const;

  private:
    friend class PathSampler;

    struct Codes {
        uint32_t x, y;
    };
    Codes codes(uint32_t j) const;

    uint32_t seed_x_, seed_y_;
    uint32_t sample_;  // the camera sample, or the one whose place it takes
    uint32_t stride_, count_;
    LatticeSteps steps_;
    SamplerKind kind_;
    bool permuted_;
};

// The numbers of one camera sample of one pixel. x, y: in the whole picture. The plan must outlive it.
class PathSampler {
  public:
    PathSampler(const SamplePlan& plan, uint32_t x, uint32_t y, uint32_t sample);

    V2d pixel() const;
    // dimension: lobe or bsdf.
    V2d point(uint32_t depth, Dimension dimension) const;
    // dimension: area_light or select_light.
    SampleSet light_points(uint32_t depth, Dimension dimension) const;
    SampleSet obscurance_directions(uint32_t depth) const;

  private:
    SampleSet make_set(uint32_t dimension, uint32_t count, LatticeSteps steps, bool permuted) const;

    const SamplePlan& plan_;
    uint32_t pixel_seed_, sample_;
};

}  // namespace obscura::reference
