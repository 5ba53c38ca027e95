// SPDX-License-Identifier: Apache-2.0
// The reflection model of scene/material.h at one hit: a Lambert lobe under a GGX lobe or a mirror, and thin panes.
#pragma once

#include "reference/surface.h"

namespace obscura::reference {

// A lobe's value and the density with which it is sampled there.
struct LobeValue {
    RgbD brdf{0, 0, 0};  // 1/sr
    double pdf_sr = 0;
};

// A direction drawn from a lobe.
struct LobeSample {
    V3d direction{0, 0, 1};  // world, unit
    RgbD weight{0, 0, 0};    // BRDF times cosine over the density
    double pdf_sr =
        0;  // 0 where no other strategy finds this direction: mirrors, panes, reflected directions
};

// What a pane does with a ray: reflected one way, passed straight on.
struct PaneShares {
    RgbD reflected, passed;
};

class Bsdf {
  public:
    // direction: of the ray that hit, unit.
    Bsdf(const Surface& surface, const V3d& direction);

    const V3d& n_shade() const { return basis_.normal; }
    const RgbD& diffuse() const { return diffuse_; }  // R_d
    const RgbD& specular() const {
        return specular_;
    }  // a: directional albedo of the specular lobe, with that of panes'
    bool is_pane() const { return surface_.material->pane; }
    bool is_glossy() const { return surface_.material->glossy; }
    bool is_mirror() const { return surface_.material->mirror; }

    // Of light from a unit direction above the surface.
    LobeValue glossy(const V3d& wi) const;
    double diffuse_pdf_sr(const V3d& wi) const;

    LobeSample sample_glossy(const V2d& u) const;
    LobeSample sample_diffuse(const V2d& u) const;
    LobeSample mirror() const;  // weight: Fresnel
    PaneShares pane() const;

  private:
    V3d above(const V3d& local, double& pdf_sr) const;

    Surface surface_;
    Basis basis_;
    V3d wo_;  // local, to the viewer
    RgbD f0_, f90_, diffuse_, specular_;
    double alpha_;
};

}  // namespace obscura::reference
