// SPDX-License-Identifier: Apache-2.0
// Rays that are hard to trace: random, aimed at edges and vertices, and along the axes. Pure functions of their arguments.
#pragma once

#include "reference/tracer.h"
#include "scene/scene.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace obscura {

// From anywhere around the scene into any direction, half of them with a limited reach.
std::vector<TraceRay> random_rays(const Scene& scene, size_t count, uint32_t seed);

// Aimed, as well as floats can, at points of edges and at vertices.
std::vector<TraceRay> edge_rays(const Scene& scene, size_t count, uint32_t seed);
std::vector<TraceRay> vertex_rays(const Scene& scene, size_t count, uint32_t seed);

// Along the six axis directions, with both signs of zero in the other components, from points whose coordinates are
// vertex coordinates half of the time: inside faces of boxes and planes of triangles.
std::vector<TraceRay> axis_rays(const Scene& scene, size_t count, uint32_t seed);

}  // namespace obscura
