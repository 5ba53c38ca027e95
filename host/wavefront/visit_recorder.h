// SPDX-License-Identifier: Apache-2.0
// What the rays of a render visit in the tree: they are traced once more, between two depths, by kernels built to count
// (visits.cl). The kernels that are timed stay as they are.
#pragma once

#include "device/program.h"
#include "device/scene_buffers.h"
#include "wavefront/plan.h"
#include "wavefront/scheduler.h"

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace obscura {

// Of the rays of one queue. visits[n]: rays with n of them.
struct RayVisits {
    using Histogram = std::vector<uint64_t>;

    uint64_t rays = 0;
    Histogram nodes, blocks;
    Histogram stack;  // the most entries at once

    void add(uint32_t node_count, uint32_t block_count, uint32_t stack_entries);
};

double mean(const RayVisits::Histogram& histogram);

// Camera, shadow, glossy and obscurance rays, named so.
constexpr std::array<std::string_view, 4> RAY_QUEUES{"camera", "shadow", "glossy", "obscurance"};

struct RenderVisits {
    std::array<RayVisits, RAY_QUEUES.size()> queues;
    // Nodes that all rays of a pixel visit, per sample; rows from the top of the rendered part.
    std::vector<float> nodes_per_sample;
    double seconds = 0;  // that the counting took, beside the render
};

class VisitRecorder {
  public:
    // needs, all, portable: what the render's kernels are built for (stage_options()).
    VisitRecorder(Device& device, ProgramLibrary& library, const Needs& needs, bool all, bool portable,
                  const SceneBuffers& scene);

    // A DepthObserver: counts the rays of the depth.
    void observe(const DepthView& view, const Frame& frame, const Queues& queues);
    // When the pixels of a band have this many samples, the first pixels_ahead of pixel_order one more. Bands come from the
    // top down.
    void finish_band(std::span<const uint32_t> pixel_order, uint64_t samples, uint64_t pixels_ahead);

    const RenderVisits& visits() const { return visits_; }

  private:
    void add(size_t queue, uint64_t ray_count);

    Device& device_;
    uint32_t local_size_;
    const SceneBuffers& scene_;
    cl::Kernel trace_, shadow_, obscurance_;
    Buffer counts_;                      // of the rays of one launch
    std::vector<uint64_t> pixel_nodes_;  // of the band in hand
    RenderVisits visits_;
};

}  // namespace obscura
