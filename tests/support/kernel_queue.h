// SPDX-License-Identifier: Apache-2.0
// A bench for single stages: queues of a chosen capacity whose items a test writes by hand, one stage run over them,
// and the queues read back. All memory starts as canaries and every queue is followed by a few more, so that a test
// sees what a stage wrote and what it left alone. Kernels are built with every feature (--needs all).
#pragma once

#include "bvh/bvh.h"
#include "device/buffer.h"
#include "device/launch.h"
#include "device/program.h"
#include "device/scene_buffers.h"
#include "sampling/sample_order.h"
#include "scene/needs.h"
#include "scene/radiometry.h"
#include "scene/scene.h"
#include "shared/wavefront.h"
#include "wavefront/features.h"
#include "wavefront/frame.h"
#include "wavefront/stages.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace obscura::test {

constexpr uint32_t CANARY_BITS = 0xabadcafe;  // as a float -1.2e-12
constexpr uint32_t GUARD = 8;                 // canaries behind a queue

inline f32x4 canary() {
    const float value = std::bit_cast<float>(CANARY_BITS);
    return {value, value, value, value};
}

inline std::array<uint32_t, 4> bits(const f32x4& lane) {
    return std::bit_cast<std::array<uint32_t, 4>>(lane);
}

inline uint32_t bits(float value) {
    return std::bit_cast<uint32_t>(value);
}

inline float as_float(uint32_t word) {
    return std::bit_cast<float>(word);
}

inline V3f xyz_of(const f32x4& lane) {
    return {lane.x, lane.y, lane.z};
}

inline f32x4 lane_of(const V3f& v, float w = 0) {
    return {v.x, v.y, v.z, w};
}

// Lanes of `capacity` items on the device, mirrored on the host.
class LaneQueue {
  public:
    LaneQueue(Device& device, const char* name, uint32_t lane_count, uint32_t capacity)
        : capacity_(capacity),
          values_(size_t{lane_count} * capacity + GUARD, canary()),
          buffer_(Buffer::holding(device, name, "test", values_)) {}

    f32x4& at(uint32_t lane, uint32_t item) { return values_[size_t{lane} * capacity_ + item]; }
    const f32x4& at(uint32_t lane, uint32_t item) const { return values_[size_t{lane} * capacity_ + item]; }

    bool untouched(uint32_t lane, uint32_t item) const { return bits(at(lane, item)) == bits(canary()); }
    bool guard_untouched() const {
        return std::all_of(values_.end() - GUARD, values_.end(),
                           [](const f32x4& value) { return bits(value) == bits(canary()); });
    }

    void upload() { buffer_.upload(values_); }
    void download() { buffer_.download(values_); }
    const Buffer& buffer() const { return buffer_; }
    // A copy of the host's side, to compare with later.
    std::vector<std::array<uint32_t, 4>> snapshot() const {
        std::vector<std::array<uint32_t, 4>> words;
        for (const f32x4& value : values_)
            words.push_back(bits(value));
        return words;
    }

  private:
    uint32_t capacity_;
    std::vector<f32x4> values_;
    Buffer buffer_;
};

class StageBench {
  public:
    const uint32_t capacity;
    uint32_t light_samples = 0;  // per path, of both groups
    Frame frame;
    std::array<uint32_t, STATUS_WORDS> counters{};
    std::optional<std::string> kernel_options = {};  // in place of every feature

    // One wave of `capacity` path slots of a render with these settings; light_samples etc. come from them.
    StageBench(Device& device, const Scene& scene_to_render, RenderSettings settings,
               uint32_t capacity_of_wave, const std::vector<uint32_t>& wanted_layers = {})
        : capacity(capacity_of_wave), device_(device), library_(device) {
        settings.needs = NeedsMode::all;
        needs_ = analyse_needs(scene_to_render, settings);
        const LayerPlanes planes = assign_planes(needs_, wanted_layers);
        const SceneArrays arrays = make_scene_arrays(scene_to_render, settings.filter);
        scene_ = upload_scene(device, arrays, build_bvh(scene_to_render));
        const PixelRect rect = crop_pixels(settings.crop, settings.width, settings.height);
        frame = make_frame({scene_to_render, settings, compute_radiometry(scene_to_render), needs_, planes,
                            static_cast<uint32_t>(arrays.area_lights.size()),
                            static_cast<uint32_t>(arrays.point_lights.size()),
                            resolve_max_distance(settings.d_max, scene_to_render.bounds)},
                           rect, capacity);
        frame_buffer_ = Buffer(device, "frame", "test", sizeof(Frame));
        sample_order_ = Buffer::holding(device, "sample_order", "test", bit_reversed_order(settings.spp));
        counter_buffer_ = Buffer(device, "counters", "test", sizeof(counters));
        const uint32_t k_count = settings.obscurance_rays;
        plane_count_ = plane_count(planes);
        light_samples = 2 * settings.light_samples;  // of area lights, then of punctual lights
        queues_.reserve(8);
        for (const auto& [name, lanes, items] :
             {std::tuple{"rays", uint32_t{RAY_LANES}, capacity},
              {"next_rays", uint32_t{RAY_LANES}, capacity},
              {"paths", PATH_LAYERS + plane_count_ + 2 * light_samples, capacity},
              {"shadow_rays", uint32_t{SHADOW_LANES}, capacity * light_samples},
              {"visibility", light_samples, capacity},
              {"points", uint32_t{POINT_LANES}, capacity},
              {"results", 1u, capacity * k_count},
              {"film", plane_count_, static_cast<uint32_t>(rect.pixel_count())}}) {
            queues_.emplace_back(device, name, lanes, items);
        }
    }

    LaneQueue& rays() { return queues_[0]; }
    LaneQueue& next_rays() { return queues_[1]; }
    LaneQueue& paths() { return queues_[2]; }
    LaneQueue& shadow_rays() { return queues_[3]; }
    LaneQueue& visibility() { return queues_[4]; }
    LaneQueue& points() { return queues_[5]; }
    LaneQueue& results() { return queues_[6]; }
    LaneQueue& film() { return queues_[7]; }

    void replace_bvh(const Bvh& bvh) {
        scene_.nodes = Buffer::holding(device_, "nodes", "test", bvh.nodes);
        scene_.blocks = Buffer::holding(device_, "blocks", "test", bvh.blocks);
    }

    uint32_t plane(uint32_t layer) const { return reinterpret_cast<const uint32_t*>(frame.plane)[layer]; }
    f32x4& layer(uint32_t layer, uint32_t slot) { return paths().at(PATH_LAYERS + plane(layer), slot); }
    f32x4& film_layer(uint32_t layer, uint32_t pixel) { return film().at(plane(layer), pixel); }
    // lobe: 0 diffuse, 1 glossy.
    f32x4& contribution(uint32_t sample, uint32_t lobe, uint32_t slot) {
        return paths().at(PATH_LAYERS + plane_count_ + 2 * sample + lobe, slot);
    }

    // A path as the camera starts it.
    void start_path(uint32_t slot, uint32_t seed = 1, uint32_t sample = 0) {
        paths().at(PATH_THROUGHPUT, slot) = {1, 1, 1, 0};
        paths().at(PATH_SAMPLE, slot) = {as_float(seed), as_float(sample), as_float(slot), 0};
        for (uint32_t plane = 0; plane < plane_count_; ++plane)
            paths().at(PATH_LAYERS + plane, slot) = {};
    }
    void set_ray(uint32_t item, uint32_t slot, const V3f& origin, const V3f& direction) {
        rays().at(RAY_ORIGIN, item) = lane_of(origin, as_float(slot));
        rays().at(RAY_DIRECTION, item) = lane_of(direction);
    }

    // An item of which only the path slot counts.
    void set_slot(uint32_t item, uint32_t slot) { rays().at(RAY_ORIGIN, item).w = as_float(slot); }

    // The stages, launched over more items than there are: the counts have to guard them.
    void run_camera(uint32_t first_pixel, uint32_t first_pass, uint32_t count) {
        run(Stage::camera, frame_buffer_, scene_.tables, sample_order_, rays().buffer(), paths().buffer(),
            first_pixel, first_pass, count);
    }
    void run_trace(uint32_t count) {
        run(Stage::trace, scene_.nodes, scene_.blocks, rays().buffer(), counter_buffer_, capacity, count);
    }
    void run_shade(uint32_t count, uint32_t depth) {
        run(Stage::shade, frame_buffer_, scene_.triangles, scene_.materials, scene_.area_lights,
            scene_.point_lights, scene_.texels, scene_.tables, rays().buffer(), paths().buffer(),
            next_rays().buffer(), shadow_rays().buffer(), points().buffer(), counter_buffer_, count, depth);
    }
    void run_shadow() {
        run(Stage::shadow, scene_.nodes, scene_.blocks, scene_.triangles, scene_.materials, scene_.texels,
            scene_.tables, shadow_rays().buffer(), visibility().buffer(), counter_buffer_,
            capacity * light_samples);
    }
    void run_obscurance(uint32_t depth) {
        run(Stage::obscurance, frame_buffer_, scene_.nodes, scene_.blocks, scene_.triangles, scene_.materials,
            scene_.texels, scene_.tables, points().buffer(), paths().buffer(), results().buffer(),
            counter_buffer_, depth);
    }
    void run_gather(uint32_t count, uint32_t depth) {
        run(Stage::gather, frame_buffer_, rays().buffer(), visibility().buffer(), results().buffer(),
            paths().buffer(), count, depth);
    }
    void run_film(uint32_t first_pixel, uint32_t first_pass, uint32_t count) {
        run(Stage::film, frame_buffer_, paths().buffer(), film().buffer(), counter_buffer_, first_pixel,
            first_pass, count);
    }

    bool guards_untouched() const {
        return std::ranges::all_of(queues_, [](const LaneQueue& queue) { return queue.guard_untouched(); });
    }
    // Everything a stage could have written.
    std::vector<std::vector<std::array<uint32_t, 4>>> snapshot() const {
        std::vector<std::vector<std::array<uint32_t, 4>>> all;
        for (const LaneQueue& queue : queues_)
            all.push_back(queue.snapshot());
        all.push_back({{counters[0], counters[1], counters[2], counters[3]},
                       {counters[4], counters[5], counters[6], counters[7]}});
        return all;
    }

  private:
    template <typename... Args>
    void run(Stage stage, const Args&... args) {
        frame_buffer_.upload(std::span(&frame, 1));
        counter_buffer_.upload(counters);
        for (LaneQueue& queue : queues_)
            queue.upload();
        const std::string name(stage_name(stage));
        const cl::Kernel kernel =
            library_.kernel(name, kernel_options.value_or(stage_options(stage, needs_, true, false)));
        constexpr uint64_t MORE_THAN_ENOUGH = 4096;
        launch(device_, kernel, name, MORE_THAN_ENOUGH, library_.local_size(), args...);
        for (LaneQueue& queue : queues_)
            queue.download();
        counter_buffer_.download(counters);
    }

    Device& device_;
    ProgramLibrary library_;
    Needs needs_;
    SceneBuffers scene_;
    Buffer frame_buffer_, sample_order_, counter_buffer_;
    uint32_t plane_count_ = 0;
    std::vector<LaneQueue> queues_;
};

}  // namespace obscura::test
