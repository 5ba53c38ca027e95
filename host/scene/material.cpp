// SPDX-License-Identifier: Apache-2.0
#include "scene/material.h"

#include "scene/albedo_table.h"

#include <algorithm>
#include <cmath>

namespace obscura {

namespace {

constexpr int PANE_INTERVALS = 256;  // of Simpson's rule; the integrand is smooth, the error below 1e-12

// All in double; the kernels get the rounded values.
struct ExactModel {
    RgbD dielectric_f0{0, 0, 0}, f0{0, 0, 0}, mean_albedo{0, 0, 0};
    double f90 = 0;
    double alpha = 0;
    double diffuse_scale = 0;
};

ExactModel exact_model(const Material& material) {
    ExactModel model;
    if (material.unlit) return model;
    const double metallic = static_cast<double>(material.metallic);
    const double specular = static_cast<double>(material.specular);
    const double roughness = static_cast<double>(material.roughness);
    model.f90 = specular + (1 - specular) * metallic;
    const bool mirror = material.roughness < MIRROR_ROUGHNESS || is_pane(material);
    model.alpha = mirror ? 0 : roughness * roughness;
    model.diffuse_scale = (1 - metallic) * (1 - static_cast<double>(material.transmission));
    const AlbedoTerms mean = mean_albedo(model.alpha);
    for (int c = 0; c < 3; ++c) {
        const double tint = static_cast<double>(material.specular_color[c]);
        model.dielectric_f0[c] = (1 - metallic) * std::min(DIELECTRIC_F0 * tint, 1.0) * specular;
        model.f0[c] = model.dielectric_f0[c] + metallic * static_cast<double>(material.base_color[c]);
        model.mean_albedo[c] = model.f0[c] * mean.a + model.f90 * mean.b;
    }
    return model;
}

}  // namespace

bool is_pane(const Material& material) {
    return !material.unlit && material.transmission > 0;
}

bool is_emissive(const Material& material) {
    return !material.unlit && (material.emission.x > 0 || material.emission.y > 0 || material.emission.z > 0);
}

double pane_reflectance(double mu) {
    const double f = DIELECTRIC_F0 + (1 - DIELECTRIC_F0) * std::pow(1 - mu, 5);
    return 2 * f / (1 + f);
}

double mean_pane_reflectance() {
    const auto integrand = [](double mu) { return 2 * mu * pane_reflectance(mu); };
    double sum = integrand(0) + integrand(1);
    for (int i = 1; i < PANE_INTERVALS; ++i)
        sum += (i % 2 == 1 ? 4 : 2) * integrand(static_cast<double>(i) / PANE_INTERVALS);
    return sum / (3 * PANE_INTERVALS);
}

SurfaceModel surface_model(const Material& material) {
    const ExactModel exact = exact_model(material);
    const double transmission = is_pane(material) ? static_cast<double>(material.transmission) : 0;
    SurfaceModel model;
    model.dielectric_f0 = Rgb(exact.dielectric_f0);
    model.f0 = Rgb(exact.f0);
    model.f90 = Rgb(static_cast<float>(exact.f90));
    model.alpha = static_cast<float>(exact.alpha);
    model.has_specular = !material.unlit && (material.specular > 0 || material.metallic > 0);
    model.diffuse_scale = Rgb(static_cast<float>(exact.diffuse_scale));
    model.mean_scale = Rgb(exact.diffuse_scale * (RgbD(1, 1, 1) - exact.mean_albedo));
    static const double reflectance = mean_pane_reflectance();
    model.opacity = 1 - transmission * (1 - reflectance);
    return model;
}

RgbD mean_reflectivity(const Material& material, const RgbD& base_color) {
    const ExactModel exact = exact_model(material);
    return exact.diffuse_scale * (base_color * (RgbD(1, 1, 1) - exact.mean_albedo));
}

}  // namespace obscura
