// SPDX-License-Identifier: Apache-2.0
// Rays and hits as a report tells them and `obscura check --ray` takes them: in the file's coordinates and in metres,
// wherever the loader has moved the scene (scene/local_frame.h). Directions are the same in both frames, so that
// distances in units of a direction's length scale as lengths do.
#pragma once

#include "reference/brute_force.h"
#include "reference/tracer.h"

#include <optional>
#include <span>
#include <string>

namespace obscura {

// A ray as --ray takes it. start: of an obscurance ray, its origin relative to the point from which distances count.
struct GivenRay {
    TraceRay ray;
    std::optional<V3f> start = {};
};

// "ox,oy,oz,dx,dy,dz,t_max" and, if there is a start, ",sx,sy,sz"; with digits for ray_of_numbers() to find the same floats
// again; only of a coordinate below 2^-40 of how far the loader has moved the scene are bits lost, since 64 hold the sum.
std::string ray_text(const Scene& scene, const GivenRay& given);

// The ray with these seven or ten numbers, as the scene's tracers take it. Throws InputError for any other number of them,
// or where floats or Embree couldn't hold it.
GivenRay ray_of_numbers(const Scene& scene, std::span<const long double> numbers);

std::string hit_text(const Scene& scene, const TraceHit& hit);
std::string hit_text(const Scene& scene, const BruteHit& hit);

}  // namespace obscura
