// SPDX-License-Identifier: Apache-2.0
// The rays of a benchmark and their hits in a file, with the triangles that they were traced against, so that others can
// repeat it with a program of their own. Little-endian throughout, nothing padded:
//
//   char[8] "OBSCRAYS"; u32 version, 2; u32 zero; u64 vertices; u64 triangles
//   vertices:   f32 x, y, z, in metres; obscura moves a scene that lies far from the world's origin near it
//   triangles:  u32 vertex[3]; u32 pane, 1 if light passes through; a triangle's number is its primitive below
//   then launch after launch to the end of the file:
//     u32 queue: 0 camera, 1 shadow, 2 glossy, 3 obscurance
//     u32 query: 0 the closest hit is asked for, 1 whether there is any, 2 whether there is any but panes
//     u64 rays
//     rays:     f32 origin[3], t_max, direction[3], t, u, v; u32 primitive
//
// Hits count for 0 < t < t_max, in units of the direction's length; u and v are the weights of vertices 1 and 2. A miss
// has primitive 0xffffffff. A shadow ray tells only hit (0) from miss.
#pragma once

#include "base/file.h"
#include "reference/embree_modes.h"
#include "reference/tracer.h"

#include <filesystem>
#include <span>

namespace obscura {

class RayDump {
  public:
    // shown_as: the name in messages, for a file that still has its temporary name. Throws InputError.
    RayDump(const std::filesystem::path& path, const std::filesystem::path& shown_as, const Scene& scene);

    void add(uint32_t queue, RayQuery query, std::span<const TraceRay> rays, std::span<const TraceHit> hits);
    // Throws InputError if anything was not written.
    void close() { file_.close(); }

  private:
    FileWriter file_;
};

}  // namespace obscura
