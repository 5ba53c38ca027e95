// SPDX-License-Identifier: Apache-2.0
// The one place where glTF's material becomes obscura's reflection model. Kernels evaluate the same model
// (kernels/lib/bsdf.clh) from the numbers computed here.
//
//   alpha   roughness^2 of GGX with height-correlated Smith masking; 0, a mirror, below MIRROR_ROUGHNESS
//           and for panes
//   F0      lerp(min(0.04 specular_color, 1) specular, base, metallic): Fresnel (Schlick) at normal incidence
//   F90     lerp(specular, 1, metallic): the same at grazing incidence
//   a(mu)   F0 A(mu, alpha) + F90 B(mu, alpha): directional albedo of the lobe; A, B in scene/albedo_table.h
//   a_mean  2 int_0^1 a(mu) mu dmu: its cosine-weighted mean
//   t       transmission: share of the surface that is a pane
//   R_d     base (1 - metallic) (1 - t) (1 - a(mu_o)): diffuse albedo seen from mu_o; a + R_d <= 1
//   R       base (1 - metallic) (1 - t) (1 - a_mean): mean diffuse albedo, in R_ave and as R(Q)
//   E       emission, one-sided unless double_sided
//
// A pane (t > 0) is thin, clear and smooth, of IOR 1.5. Its two faces together reflect
// P(mu) = 2 F / (1 + F), F = Schlick(0.04); the rest passes straight on, tinted by base. Where t < 1 the
// surface is a mixture: the share t is such a pane, the share 1 - t has the specular lobe over the diffuse one.
// The lobe is a mirror too, whatever the roughness, so that all that such a surface reflects specularly goes
// one way. Seen from mu under uniform light of radiance 1, the surface shows no more than arrives:
//
//   (1 - t) a(mu) + t P(mu)      reflected
//   t (1 - P(mu)) base           passed
//   R_d                          diffuse;  all three sum up to 1 for a white dielectric
//
// An unlit surface shows its base colour, opaque, and has no part in anything else: R = E = t = 0, no lobe.
//
// base is the factor times the texture. Only in R, so that it stays linear in the texture, a_mean takes F0
// from the factor alone; that matters for surfaces that are partly metallic and textured.
#pragma once

#include "scene/scene.h"

namespace obscura {

// Below this perceptual roughness (alpha < 1e-3) GGX is a mirror to float precision (pbrt-v4 does the same).
constexpr float MIRROR_ROUGHNESS = 0.0316228f;

constexpr double DIELECTRIC_F0 = 0.04;  // ((1.5 - 1) / (1.5 + 1))^2

struct SurfaceModel {
    Rgb f0;             // with the base colour factor alone: dielectric_f0 + metallic * base_color
    Rgb dielectric_f0;  // (1 - metallic) times the dielectric's F0; add metallic * base where it is textured
    Rgb f90;
    float alpha = 0;  // 0 = mirror
    bool has_specular = false;
    Rgb diffuse_scale;   // (1-metallic)(1-transmission): times base gives the diffuse albedo before (1 - a)
    Rgb mean_scale;      // (1-metallic)(1-transmission)(1-a_mean): times base gives R
    double opacity = 1;  // area weight in A_T: 1 - transmission (1 - mean pane reflectance)
};

// Whether light passes through.
bool is_pane(const Material& material);
// Whether it shines on others.
bool is_emissive(const Material& material);

SurfaceModel surface_model(const Material& material);

// Mean diffuse albedo R for a given base colour (the factor times the texture's mean).
RgbD mean_reflectivity(const Material& material, const RgbD& base_color);

// Reflectance of a pane, both faces: at the cosine mu, and its cosine-weighted mean.
double pane_reflectance(double mu);
double mean_pane_reflectance();

}  // namespace obscura
