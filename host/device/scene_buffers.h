// SPDX-License-Identifier: Apache-2.0
// The scene on the device: tracing structures, shading data, lights and tables (kernels/shared/scene.h).
#pragma once

#include "bvh/bvh.h"
#include "device/buffer.h"
#include "scene/scene.h"
#include "scene/settings.h"
#include "shared/scene.h"

#include <vector>

namespace obscura {

// The host's copies, in the device's layout: made without a device, so that tests can look at them.
struct SceneArrays {
    std::vector<SceneTriangle> triangles;
    std::vector<SceneMaterial> materials;
    std::vector<AreaLight> area_lights;
    std::vector<PointLight> point_lights;
    std::vector<uint32_t> texels;  // RGBA8
    std::vector<float> tables;     // TABLE_*
};

SceneArrays make_scene_arrays(const Scene& scene, PixelFilter filter);

struct SceneBuffers {
    Buffer nodes, blocks;                                                    // category "bvh"
    Buffer triangles, materials, area_lights, point_lights, texels, tables;  // category "scene"
};

SceneBuffers upload_scene(Device& device, const SceneArrays& arrays, const Bvh& bvh);

}  // namespace obscura
