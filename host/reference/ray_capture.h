// SPDX-License-Identifier: Apache-2.0
// The device's rays and hits, brought to the host: the real ones of a render (RayCapture looks at its queues between two
// depths), and those of any rays (DeviceTracer), with what they cost (VisitCounter). Obscurance rays are never stored by a render, so a kernel of its own
// makes them again with the very functions of the stage.
#pragma once

#include "bvh/bvh.h"
#include "device/program.h"
#include "reference/tracer.h"
#include "wavefront/scheduler.h"

#include <span>
#include <string>
#include <vector>

namespace obscura {

// Rays of one queue at one depth, and what the device made of them.
struct CapturedRays {
    std::vector<TraceRay> rays;
    std::vector<TraceHit> hits;  // not of shadow rays: they ask only whether anything is in the way
    // Of obscurance rays: where each starts relative to its point, from which distances count.
    std::vector<V3f> starts;
    // Of shadow rays the share of light that comes through, of obscurance rays what they bring back.
    std::vector<f32x4> results;
};

// As kernels write hits: t, u, v, primitive.
TraceHit hit_of(const f32x4& lane);

// As the kernels of check.cl and visits.cl take rays: origin with t_max, direction.
std::vector<f32x4> pack(std::span<const TraceRay> rays);

class RayCapture {
  public:
    // options: build options of the render's kernels.
    RayCapture(Device& device, ProgramLibrary& library, const Bvh& bvh, const std::string& options = {});

    CapturedRays traced(const DepthView& view, const Frame& frame, const Queues& queues) const;
    CapturedRays shadow(const DepthView& view, const Frame& frame, const Queues& queues) const;
    // The K rays of each obscurance point.
    CapturedRays obscurance(const DepthView& view, const Frame& frame, const Queues& queues);

  private:
    Device& device_;
    uint32_t local_size_;
    Buffer nodes_, blocks_, out_;
    cl::Kernel kernel_;
};

// What traversals visit, summed up.
struct Visits {
    uint64_t rays = 0, hits = 0, nodes = 0, blocks = 0;
    uint32_t stack_entries = 0;  // the most that any ray needed

    void add(const Visits& other);
};

// The device's traversal in a build that counts what it visits.
class VisitCounter {
  public:
    VisitCounter(Device& device, ProgramLibrary& library, const Bvh& bvh, const std::string& options = {});

    // any_hit: until something is hit, not the nearest.
    Visits count(std::span<const TraceRay> rays, bool any_hit) const;

  private:
    Device& device_;
    uint32_t local_size_;
    Buffer nodes_, blocks_;
    cl::Kernel kernel_;
};

// The device's traversal with the reference tracer's interface.
class DeviceTracer {
  public:
    DeviceTracer(Device& device, ProgramLibrary& library, const Bvh& bvh, const std::string& options = {});

    std::vector<TraceHit> closest(std::span<const TraceRay> rays) const {
        return trace(rays, RAY_QUERY_NEAREST);
    }
    // The same by the walk of single rays, as behind panes; to the bit.
    std::vector<TraceHit> closest_alone(std::span<const TraceRay> rays) const {
        return trace(rays, RAY_QUERY_ALONE);
    }
    // 1 where anything is hit, else 0.
    std::vector<uint8_t> occluded(std::span<const TraceRay> rays) const;

  private:
    std::vector<TraceHit> trace(std::span<const TraceRay> rays, uint32_t query) const;

    Device& device_;
    uint32_t local_size_;
    Buffer nodes_, blocks_;
    cl::Kernel kernel_;
};

}  // namespace obscura
