// SPDX-License-Identifier: Apache-2.0
// The stages of the wavefront: the table from which kernels are compiled, launched, named in messages and tested.
// A stage called `shadow` is kernels/shadow.cl, its kernel, Stage::shadow and its profile row.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace obscura {

enum class Stage : uint32_t { camera = 0, trace, shade, shadow, obscurance, gather, film };  // = STAGE_*
constexpr uint32_t STAGE_COUNT = 7;

struct StageInfo {
    Stage stage;
    std::string_view name;
    std::string_view
        features;  // the NEED_* flags its kernel depends on: names of needs.h, separated by blanks
};

constexpr std::array<StageInfo, STAGE_COUNT> STAGES{{
    {Stage::camera, "camera", ""},
    {Stage::trace, "trace", ""},
    {Stage::shade, "shade",
     "textures smooth_normals glossy mirror transmission area_lights point_lights spot_lights "
     "directional_lights "
     "emission background ambient obscurance specular_paths"},
    {Stage::shadow, "shadow",
     "textures transmission area_lights point_lights spot_lights directional_lights"},
    {Stage::obscurance, "obscurance", "textures transmission bleeding falloff"},
    {Stage::gather, "gather",
     "glossy area_lights point_lights spot_lights directional_lights ambient obscurance"},
    {Stage::film, "film", ""},
}};

constexpr std::string_view stage_name(Stage stage) {
    return STAGES[static_cast<uint32_t>(stage)].name;
}

}  // namespace obscura
