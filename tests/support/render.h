// SPDX-License-Identifier: Apache-2.0
// Renders of scenes built in code, on the shared device, and their pixels as numbers.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "support/device.h"
#include "wavefront/render.h"

namespace obscura::test {

// The kernels of one local size, compiled at most once per program. Like the device, they are never given back.
inline ProgramLibrary& shared_library(uint32_t local_size) {
    Device& device = shared_device();
    static auto& libraries = *new std::map<uint32_t, ProgramLibrary>;
    return libraries.try_emplace(local_size, device, local_size).first->second;
}

// What may change a render's speed but none of its bits.
struct RenderCut {
    uint64_t wave_size = DEFAULT_WAVE_SIZE;
    uint64_t queue_bytes = DEFAULT_QUEUE_BYTES;
    uint32_t local_size = 64;
    bool portable = false;
    BvhQuality bvh_quality = BvhQuality::high;
};

inline RenderResult render(const Scene& scene, const RenderSettings& settings,
                           std::vector<std::string> layers = {}, const RenderCut& cut = {}) {
    const RenderJob job{scene,         settings,     std::move(layers), cut.queue_bytes,
                        cut.wave_size, cut.portable, cut.bvh_quality};
    return render_scene(shared_device(), shared_library(cut.local_size), job,
                        [](double, const RayCounts&) { return true; });
}

// A picture of the given size lit by nothing but what the scene holds.
inline RenderSettings picture(uint32_t width, uint32_t height, uint32_t spp = 1,
                              uint32_t obscurance_rays = 1) {
    RenderSettings settings;
    settings.width = width;
    settings.height = height;
    settings.spp = spp;
    settings.obscurance_rays = obscurance_rays;
    settings.background = Rgb(0);
    return settings;
}

// All pixels of one channel, rows from the top. layer: "" is beauty.
inline std::vector<double> channel(const Image& image, const std::string& layer, size_t index) {
    const Layer* const found = image.find_layer(layer);
    if (found == nullptr) {
        ADD_FAILURE() << "the picture has no layer '" << layer << "'";
        return {};
    }
    std::vector<double> values;
    for (size_t i = index; i < found->pixels.size(); i += found->channel_count())
        values.push_back(static_cast<double>(found->pixels[i]));
    return values;
}

}  // namespace obscura::test
