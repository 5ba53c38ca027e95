// SPDX-License-Identifier: Apache-2.0
// The production kernels against Embree on the queues of a render, in one process. The render is done twice: first every
// mode of Embree traces its rays, which finds the best one and compares the hits; then, launch by launch, the device and
// Embree in that mode take turns.
//
// A run of the device is the launch of a stage as the render made it, with the same kernel on the same queue: trace;
// shadow, with what panes let through; obscurance, with its directions, falloff and colours. Both sides are timed by the
// same clock, from the call to the last result in memory, and have the same number of threads.
#pragma once

#include "reference/bench_statistics.h"
#include "reference/embree_modes.h"
#include "reference/ray_capture.h"
#include "reference/ray_dump.h"
#include "wavefront/render.h"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace obscura {

// A longer render is not replayed whole, but as many of its waves, spread evenly.
constexpr uint32_t BENCH_WAVES = 8;
// Rays of a queue whose hits may differ without making the comparison unfair, ties and rays at edges: this share, or so
// many where that is less.
constexpr double MAX_DIFFERING_SHARE = 1e-4;
constexpr uint64_t MAX_DIFFERING_RAYS = 3;

struct ModeResult {
    EmbreeMode mode;
    double seconds = 0;      // the better of two runs of each launch
    uint64_t differing = 0;  // rays with another answer than the device's
};

struct QueueBench {
    std::string name;
    RayQuery query = RayQuery::closest;
    Visits visits;  // of the device's traversal; behind panes nothing is counted
    std::vector<ModeResult> modes;
    PairedTimes robust, fast;  // against the best mode of each

    const ModeResult& best(bool is_robust) const;
    // Rays that the robust mode which differs most answers differently.
    uint64_t differing() const;
    bool agrees() const;
};

struct SceneBench {
    std::array<QueueBench, 4> queues;
    uint32_t waves = 0;
    bool has_panes = false;  // behind which the device's obscurance rays go on, but not Embree's
    int threads = 0;         // of Embree
    uint64_t bvh_bytes = 0;
    double build_seconds = 0;
    EmbreeCost robust, fast;
    bool complete = true;  // false: stopped early, what was timed until then counts

    bool is_timed() const;  // any queue
};

// fraction: of the work done; rays: traced so far by both sides. False stops the benchmark after the launch in hand.
using BenchCallback = std::function<bool(double fraction, uint64_t rays)>;

// dump: optional, takes the rays.
SceneBench bench_scene(Device& device, ProgramLibrary& library, const RenderJob& job, RayDump* dump,
                       const BenchCallback& go_on);

}  // namespace obscura
