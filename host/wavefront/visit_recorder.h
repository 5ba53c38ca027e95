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
    void add(const RayVisits& other);
};

double mean(const RayVisits::Histogram& histogram);

// Camera, shadow, glossy and obscurance rays, named so.
constexpr std::array<std::string_view, 4> RAY_QUEUES{"camera", "shadow", "glossy", "obscurance"};

struct RenderVisits {
    std::array<RayVisits, RAY_QUEUES.size()> queues;
    double seconds = 0;  // that the counting took, beside the render
};

// Nodes that all rays of a pixel visit; pixels of a band in rows.
using PixelNodes = std::vector<uint64_t>;

// Per sample, of those pixels. Both arrays of numbers are in the order of rows that pixel_order counts in.
void average_nodes(const PixelNodes& pixel_nodes, std::span<const uint32_t> pixel_order,
                   const SampleCounts& samples, std::span<float> nodes_per_sample);

class VisitRecorder {
  public:
    // needs, all, portable: what the render's kernels are built for (stage_options()).
    VisitRecorder(Device& device, ProgramLibrary& library, const Needs& needs, bool all, bool portable,
                  const SceneBuffers& scene);

    // Those of the pixels of the next pieces, which must live until then. Several devices may share them: a pixel is in one
    // hand at a time.
    void count_into(PixelNodes& pixel_nodes) { pixel_nodes_ = &pixel_nodes; }
    // A DepthObserver: counts the rays of the depth.
    void observe(const DepthView& view, const Frame& frame, const Queues& queues);

    const RenderVisits& visits() const { return visits_; }

  private:
    void add(size_t queue, uint64_t ray_count);

    Device& device_;
    uint32_t local_size_;
    const SceneBuffers& scene_;
    cl::Kernel trace_, shadow_, obscurance_;
    Buffer counts_;  // of the rays of one launch
    PixelNodes* pixel_nodes_ = nullptr;
    RenderVisits visits_;
};

}  // namespace obscura
