// SPDX-License-Identifier: Apache-2.0
// The constants of one render in the device's layout (kernels/shared/frame.h).
#pragma once

#include "scene/needs.h"
#include "scene/radiometry.h"
#include "scene/scene.h"
#include "scene/settings.h"
#include "shared/frame.h"
#include "shared/wavefront.h"
#include "wavefront/plan.h"

#include <array>
#include <span>

namespace obscura {

// Plane of each layer in path slots and film, NO_PLANE for layers that aren't kept.
using LayerPlanes = std::array<uint32_t, LAYER_COUNT>;

// The layers that a render keeps: those of beauty that can differ from zero, and the wanted others (LAYER_*).
LayerPlanes assign_planes(const Needs& needs, std::span<const uint32_t> wanted_layers);
uint32_t plane_count(const LayerPlanes& planes);

// The camera that the settings name: by name, by index, or the first. Throws InputError that lists them.
const Camera& select_camera(const Scene& scene, const RenderSettings& settings);

// World space to the picture's plane, as OpenEXR defines worldToNDC: (0, 0) is the upper left corner of the full picture,
// (1, 1) the lower right. For row vectors, as all of Imath; z grows towards the camera.
M44d world_to_ndc(const Camera& camera, uint32_t width, uint32_t height);

struct FrameInput {
    const Scene& scene;
    const RenderSettings& settings;  // sampler resolved
    const Radiometry& radiometry;
    const Needs& needs;
    LayerPlanes planes;
    uint32_t area_light_count;
    uint32_t point_light_count;
    double d_max;  // resolved, m
};

// rect: the pixels to render; capacity: path slots of a wave.
Frame make_frame(const FrameInput& input, const PixelRect& rect, uint32_t capacity);

}  // namespace obscura
