// SPDX-License-Identifier: Apache-2.0
// A whole render: scene and settings in, picture and figures out. The command line and the tests both come in here.
#pragma once

#include "bvh/bvh.h"
#include "device/program.h"
#include "film/image.h"
#include "scene/needs.h"
#include "scene/radiometry.h"
#include "scene/scene.h"
#include "scene/settings.h"
#include "wavefront/frame.h"
#include "wavefront/profiler.h"
#include "wavefront/scheduler.h"
#include "wavefront/visit_recorder.h"

#include <functional>
#include <future>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace obscura {

constexpr uint64_t DEFAULT_QUEUE_BYTES = uint64_t{256} << 20;  // leaves room on a 1 GiB device
constexpr uint64_t DEFAULT_WAVE_SIZE = uint64_t{1} << 17;      // camera samples

struct RenderJob {
    const Scene& scene;
    RenderSettings settings;
    std::vector<std::string> layers;  // beside beauty: names of film/develop.h
    uint64_t queue_bytes = DEFAULT_QUEUE_BYTES;
    uint64_t wave_size = DEFAULT_WAVE_SIZE;
    bool portable = false;  // kernels without instructions of one processor
    BvhQuality bvh_quality = BvhQuality::high;
    DepthObserver observer = {};       // optional
    std::shared_future<Bvh> bvh = {};  // of the scene, built or being built; built here if there is none
    bool count_visits = false;         // fills RenderResult::visits, in about the time of another render
};

// Wall times, seconds. The BVH is built while the kernels are compiled.
struct RenderSeconds {
    double build = 0;    // BVH
    double compile = 0;  // kernels, cached or not
    double upload = 0;   // scene to the device, queues
    double render = 0;
};

// What a device did for a render and what it took; the sums of several.
struct DeviceWork {
    RayCounts rays;
    QueueShape shape;
    LayerPlanes planes{};
    std::map<std::string, StageProfile> profile;
    std::optional<RenderVisits> visits;
    uint32_t wave_capacity = 0;
    std::map<std::string, uint64_t>
        bytes;  // device memory at its peak during the render: scene bvh queues film peak_device
};

// Its work is that of all devices together.
struct RenderResult : DeviceWork {
    std::vector<DeviceWork> devices;  // in the order they were given in
    Image image;                      // its attributes are filled
    std::vector<float>
        nodes_per_sample;  // with visits: nodes that all rays of a pixel visit; rows from the top
    RenderSeconds seconds;
    Radiometry radiometry;
    Needs needs;
    RenderSettings settings;         // with the sky that was chosen
    double d_max = 0;                // m
    bool complete = true;            // false: stopped early, pixels have fewer samples
    uint32_t samples_per_pixel = 0;  // that every pixel has; some have more
};

// What settings come to in the job's scene.
struct RenderSetup {
    RenderSettings settings;  // with the sky that was chosen
    Needs needs;
    LayerPlanes planes{};
    PixelRect rect;  // the pixels to render
};

// Throws InputError where there is no such camera or the picture doesn't fit into memory.
RenderSetup set_up_render(const RenderJob& job);

// Builds the BVH in a thread of its own, which the last copy of the future waits for. trace: null = nowhere.
std::shared_future<Bvh> start_building(const RenderJob& job, TraceRecord* trace);

// fraction: of the samples done, 0 before the first wave; false stops the render there.
using RenderCallback = std::function<bool(double fraction, const RayCounts& rays)>;

struct RenderDevice {
    Device& device;
    ProgramLibrary& programs;
};

// "A, B"
std::string device_names(std::span<const RenderDevice> devices);

// Several devices share the work, each in a thread of its own; one does it in this thread. The callback is called by one
// thread at a time. With several devices there is no observer.
RenderResult render_scene(std::span<const RenderDevice> devices, const RenderJob& job,
                          const RenderCallback& after_wave);
// The same for a job that was set up earlier.
RenderResult render_scene(std::span<const RenderDevice> devices, const RenderJob& job,
                          const RenderSetup& setup, const RenderCallback& after_wave);
RenderResult render_scene(Device& device, ProgramLibrary& library, const RenderJob& job,
                          const RenderCallback& after_wave);

}  // namespace obscura
