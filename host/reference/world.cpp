// SPDX-License-Identifier: Apache-2.0
#include "reference/world.h"

namespace obscura::reference {

World::World(const Scene& scene, const RenderSettings& settings)
    : tracer(scene),
      surfaces(scene),
      lights(scene, surfaces),
      background(settings.background.value_or(Rgb(0))) {}

RgbD World::pane_transmittance(const Surface& pane, const V3d& direction) {
    const double cosine = std::min(1.0, -direction.dot(pane.n_geo));
    return pane.material->transmission * (1 - pane_reflectance(cosine)) * pane.base;
}

RgbD World::transmittance(const Surface& surface, const LightSample& light) const {
    RgbD share(1);
    V3d origin = surface.position + surface.lift;
    for (uint32_t panes = 0;; ++panes) {
        Ray ray{origin, light.direction};
        if (!light.parallel) {
            const V3d rest = light.target - origin;
            ray.t_max = rest.length();
            ray.direction = rest / ray.t_max;
        }
        const Hit hit = tracer.nearest(ray);
        if (!hit.found()) return share;
        const Surface met = surfaces.surface_at(hit, ray.direction);
        if (!met.material->pane || panes == MAX_PANES) return RgbD(0);
        share *= pane_transmittance(met, ray.direction);
        origin = met.position - met.lift;
    }
}

}  // namespace obscura::reference
