// SPDX-License-Identifier: Apache-2.0
// How light along one camera ray is estimated: by the model of the kernels, or without it.
#pragma once

#include "reference/sampler.h"
#include "reference/world.h"
#include "scene/radiometry.h"
#include "shared/wavefront.h"

#include <array>
#include <memory>

namespace obscura::reference {

enum class IntegratorKind { obscurance, path };

// What one camera ray brings back.
struct PathLight {
    std::array<RgbD, BEAUTY_LAYERS> parts;  // radiance by LAYER_*; their sum is the pixel's
    double coverage = 0;                    // 1 if the ray hit anything
    RgbD obscurance{0, 0, 0};               // W at the first hit with a diffuse part
    // Traced for it, counted as the kernels' queues do: a shadow or obscurance ray that passes panes is one.
    uint32_t rays = 0;

    PathLight() { parts.fill(RgbD(0)); }
    // Of the sum, what some diffuse surface has reflected: all but lights and sky, seen as they are or mirrored.
    RgbD diffuse() const {
        return parts[LAYER_DIRECT] + parts[LAYER_AMBIENT] + parts[LAYER_SPECULAR_DIRECT] +
               parts[LAYER_SPECULAR_AMBIENT];
    }
};

class Integrator {
  public:
    virtual ~Integrator() = default;
    virtual PathLight estimate(const Ray& camera_ray, const PathSampler& sampler) const = 0;
};

// The model of obscura render in double: the same picture for the same random numbers, but for rounding. d_max: in the
// scene's unit.
std::unique_ptr<Integrator> make_obscurance_integrator(const World& world, const RenderSettings& settings,
                                                       const Radiometry& radiometry, double d_max);

// All light by unbiased path tracing, with diffuse interreflection in place of obscurances. What no diffuse surface has
// reflected is in LAYER_EMISSION, the rest in LAYER_DIRECT.
std::unique_ptr<Integrator> make_path_integrator(const World& world, const RenderSettings& settings);

}  // namespace obscura::reference
