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
#include "sampling/pixel_order.h"
#include "sampling/sample_order.h"
#include "scene/needs.h"
#include "scene/radiometry.h"
#include "scene/scene.h"
#include "shared/wavefront.h"
#include "wavefront/features.h"
#include "wavefront/frame.h"
#include "wavefront/plan.h"
#include "wavefront/stages.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
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

// Lanes of `item_count` items: the host's mirror of a buffer that it fills with canaries.
class LaneQueue {
  public:
    LaneQueue(Device& device, std::string_view name, uint64_t lane_count, uint64_t item_count, Buffer& buffer)
        : item_count_(item_count), values_(lane_count * item_count + GUARD, canary()), buffer_(buffer) {
        buffer = Buffer::holding(device, std::string(name), "test", values_);
    }

    f32x4& at(uint32_t lane, uint32_t item) { return values_[lane * item_count_ + item]; }
    const f32x4& at(uint32_t lane, uint32_t item) const { return values_[lane * item_count_ + item]; }

    bool untouched(uint32_t lane, uint32_t item) const { return bits(at(lane, item)) == bits(canary()); }
    bool guard_untouched() const {
        return std::all_of(values_.end() - GUARD, values_.end(),
                           [](const f32x4& value) { return bits(value) == bits(canary()); });
    }

    void upload() { buffer_.upload(values_); }
    void download() { buffer_.download(values_); }
    // A copy of the host's side, to compare with later.
    std::vector<std::array<uint32_t, 4>> snapshot() const {
        std::vector<std::array<uint32_t, 4>> words;
        for (const f32x4& value : values_)
            words.push_back(bits(value));
        return words;
    }

  private:
    uint64_t item_count_;
    std::vector<f32x4> values_;
    Buffer& buffer_;
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
        : capacity(capacity_of_wave), device_(device), library_(device), buffers_(new Queues) {
        settings.needs = NeedsMode::all;
        needs_ = analyse_needs(scene_to_render, settings);
        const LayerPlanes planes = assign_planes(needs_, wanted_layers);
        const SceneArrays arrays = make_scene_arrays(scene_to_render, settings.filter);
        scene_ = upload_scene(device, arrays, build_bvh(scene_to_render));
        const PixelRect rect = crop_pixels(settings.crop, settings.width, settings.height);
        frame = make_frame({scene_to_render, settings, compute_radiometry(scene_to_render), needs_, planes,
                            static_cast<uint32_t>(arrays.area_lights.size()),
                            static_cast<uint32_t>(arrays.point_lights.size()),
                            resolve_max_distance(settings.d_max, scene_to_render)},
                           rect, capacity);
        const QueueShape shape = queue_shape(needs_, settings, plane_count(planes));
        plane_count_ = shape.layer_planes;
        light_samples = shape.light_samples;  // of area lights, then of punctual lights
        Queues& buffers = *buffers_;
        buffers.shape = shape;
        buffers.frame = Buffer(device, "frame", "test", sizeof(Frame));
        buffers.sample_order =
            Buffer::holding(device, "sample_order", "test", bit_reversed_order(settings.spp));
        buffers.pixel_order =
            Buffer::holding(device, "pixel_order", "test", tiled_pixel_order(rect.width(), rect.height()));
        buffers.counters = Buffer(device, "counters", "test", sizeof(counters));
        for (const QueueSize& size : queue_sizes(shape))
            queues_.try_emplace(size.name, device, size.name, size.lanes, size.items * capacity,
                                buffers.buffer(size.queue));
        queues_.try_emplace("film", device, "film", plane_count_, 2 * rect.pixel_count(), buffers.film);
    }

    LaneQueue& rays() { return queues_.at("rays"); }
    LaneQueue& next_rays() { return queues_.at("next_rays"); }
    LaneQueue& paths() { return queues_.at("paths"); }
    LaneQueue& shadow_rays() { return queues_.at("shadow_rays"); }
    LaneQueue& visibility() { return queues_.at("visibility"); }
    LaneQueue& points() { return queues_.at("points"); }
    LaneQueue& results() { return queues_.at("results"); }
    LaneQueue& film() { return queues_.at("film"); }

    void replace_bvh(const Bvh& bvh) {
        scene_.nodes = Buffer::holding(device_, "nodes", "test", bvh.nodes);
        scene_.blocks = Buffer::holding(device_, "blocks", "test", bvh.blocks);
    }

    uint32_t plane(uint32_t layer) const { return reinterpret_cast<const uint32_t*>(frame.plane)[layer]; }
    f32x4& layer(uint32_t layer, uint32_t slot) { return paths().at(PATH_LAYERS + plane(layer), slot); }
    // A sum of the film and its excess.
    f32x4& film_layer(uint32_t layer, uint32_t pixel) { return film().at(plane(layer), 2 * pixel); }
    f32x4& film_excess(uint32_t layer, uint32_t pixel) { return film().at(plane(layer), 2 * pixel + 1); }
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
    void run_camera(const Wave& wave) { run(Stage::camera, {wave, wave.sample_count(), 0}); }
    void run_trace(uint32_t count, uint32_t depth) { run(Stage::trace, {{}, count, depth}); }
    void run_shade(uint32_t count, uint32_t depth) { run(Stage::shade, {{}, count, depth}); }
    void run_shadow() { run(Stage::shadow, {}); }
    void run_obscurance(uint32_t depth) { run(Stage::obscurance, {{}, 0, depth}); }
    void run_gather(uint32_t count, uint32_t depth) { run(Stage::gather, {{}, count, depth}); }
    void run_film(const Wave& wave) { run(Stage::film, {wave, 0, 0}); }
    void run(Stage stage, const Work& work) {
        buffers_->frame.upload(std::span(&frame, 1));
        buffers_->counters.upload(counters);
        for (auto& [name, queue] : queues_)
            queue.upload();
        const StageInfo& info = stage_info(stage);
        const cl::Kernel stage_kernel = kernel(stage);
        constexpr uint64_t MORE_THAN_ENOUGH = 4096;
        launch({device_, stage_kernel, info.name, MORE_THAN_ENOUGH, library_.local_size()},
               stage_arguments(info, scene_, *buffers_, work));
        for (auto& [name, queue] : queues_)
            queue.download();
        buffers_->counters.download(counters);
    }
    cl::Kernel kernel(Stage stage) {
        return library_.kernel(std::string(stage_info(stage).name),
                               kernel_options.value_or(stage_options(stage, needs_, true, false)));
    }

    bool guards_untouched() const {
        return std::ranges::all_of(queues_, [](const auto& queue) { return queue.second.guard_untouched(); });
    }
    // Everything a stage could have written.
    std::vector<std::vector<std::array<uint32_t, 4>>> snapshot() const {
        std::vector<std::vector<std::array<uint32_t, 4>>> all;
        for (const auto& [name, queue] : queues_)
            all.push_back(queue.snapshot());
        all.push_back({{counters[0], counters[1], counters[2], counters[3]},
                       {counters[4], counters[5], counters[6], counters[7]}});
        return all;
    }

  private:
    Device& device_;
    ProgramLibrary library_;
    Needs needs_;
    SceneBuffers scene_;
    std::unique_ptr<Queues> buffers_;  // which queues_ refers to, however the bench is moved
    uint32_t plane_count_ = 0;
    std::map<std::string_view, LaneQueue> queues_;
};

}  // namespace obscura::test
