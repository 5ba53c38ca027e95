// SPDX-License-Identifier: Apache-2.0
// Everything that a path of the reference renderer may meet, and what both integrators ask of it.
#pragma once

#include "reference/bsdf.h"
#include "reference/lights.h"
#include "reference/precise_tracer.h"
#include "reference/surface.h"
#include "scene/settings.h"

namespace obscura::reference {

// The kernels' limit (kernels/lib/pane.clh): a ray passes so many panes; the next one stops it like a wall.
inline constexpr uint32_t MAX_PANES = 16;

// Weight of one of two strategies that could have drawn a sample (Veach 1997, section 9.2); 1 where the other can't.
inline double power_heuristic(double pdf, double other_pdf) {
    return 1 / (1 + (other_pdf / pdf) * (other_pdf / pdf));
}

struct World {
    // settings: with the sky resolved. The scene must outlive this.
    World(const Scene& scene, const RenderSettings& settings);

    PreciseTracer tracer;
    SurfaceScene surfaces;
    Lights lights;
    RgbD background;  // radiance

    // Share of a light sample that reaches a surface: 0 behind anything opaque, dimmed and tinted by panes.
    RgbD transmittance(const Surface& surface, const LightSample& light) const;
    // Share that passes the pane straight on, in a direction.
    static RgbD pane_transmittance(const Surface& pane, const V3d& direction);
};

}  // namespace obscura::reference
