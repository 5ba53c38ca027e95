// SPDX-License-Identifier: Apache-2.0
// What this scene, rendered with these settings, has to model. A feature that is not needed is neither
// compiled into a kernel, nor allocated, nor launched; pictures are bit-identical with everything on.
#pragma once

#include "scene/scene.h"
#include "scene/settings.h"

#include <string>
#include <vector>

namespace obscura {

// One row of the list that `obscura info` prints.
struct Need {
    std::string name;  // "textures"; the kernels see NEED_TEXTURES
    bool needed = false;
    std::string reason;  // "3 materials have a base colour texture", "no light besides emissive triangles"
};

struct Needs {
    bool textures = false;        // a base colour texture on some triangle
    bool smooth_normals = false;  // some vertex normal differs from its triangle's geometric normal
    bool glossy = false;          // a rough GGX lobe (alpha > 0), specular reflection on
    bool mirror = false;          // a mirror lobe, specular reflection on
    bool transmission = false;    // thin panes
    bool area_lights = false;     // emissive triangles to sample (for direct light or for rough lobes)
    bool point_lights = false;
    bool spot_lights = false;
    bool directional_lights = false;
    bool emission = false;        // any emissive or unlit surface that a ray can see
    bool background = false;      // a sky with radiance > 0
    bool bleeding = false;        // obscurance rays fetch R(Q)
    bool obscurance = false;      // obscurance rays at all (not with constant or no ambient light)
    bool ambient = false;         // an ambient term at all
    bool specular_paths = false;  // depth > 0: glossy, mirror or pane continuations
    FalloffKind falloff = FalloffKind::exp;

    bool direct() const { return area_lights || point_lights || spot_lights || directional_lights; }
    bool operator==(const Needs&) const = default;
};

// With settings.needs == all every flag is set (falloff stays a value: kernels then hold all of them).
Needs analyse_needs(const Scene& scene, const RenderSettings& settings);

// The list with reasons, one row per flag, in the order above.
std::vector<Need> explain_needs(const Scene& scene, const RenderSettings& settings);

}  // namespace obscura
