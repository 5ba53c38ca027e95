// SPDX-License-Identifier: Apache-2.0
// Reference pictures of scenes built in code.
#pragma once

#include "reference/reference_render.h"
#include "scene/scene.h"
#include "scene/settings.h"

namespace obscura::test {

using reference::IntegratorKind;

inline Image reference_picture(const Scene& scene, const RenderSettings& settings, IntegratorKind integrator,
                               uint32_t sets = 1) {
    const reference::ReferenceJob job{scene, settings, integrator, sets};
    return render_reference(job, [](double, uint64_t) { return true; }).image;
}

inline Image path_picture(const Scene& scene, const RenderSettings& settings) {
    return reference_picture(scene, settings, IntegratorKind::path);
}

inline Image obscurance_picture(const Scene& scene, const RenderSettings& settings) {
    return reference_picture(scene, settings, IntegratorKind::obscurance);
}

}  // namespace obscura::test
