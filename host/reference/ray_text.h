// SPDX-License-Identifier: Apache-2.0
// Rays and hits as a report tells them and `obscura check --ray` takes them: in the file's coordinates and in metres,
// wherever the loader has moved the scene (scene/local_frame.h). Directions are the same in both frames, so that
// distances in units of a direction's length scale as lengths do.
#pragma once

#include "reference/brute_force.h"
#include "reference/tracer.h"

#include <span>
#include <string>

namespace obscura {

// "ox,oy,oz,dx,dy,dz,t_max", with digits for ray_of_numbers() to find the same floats again; only of a coordinate below
// 2^-40 of how far the loader has moved the scene are bits lost, since 64 hold the sum.
std::string ray_text(const Scene& scene, const TraceRay& ray);

// The ray with these seven numbers, as the scene's tracers take it. Throws InputError where floats or Embree couldn't.
TraceRay ray_of_numbers(const Scene& scene, std::span<const long double> numbers);

std::string hit_text(const Scene& scene, const TraceHit& hit);
std::string hit_text(const Scene& scene, const BruteHit& hit);

}  // namespace obscura
