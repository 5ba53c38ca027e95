// SPDX-License-Identifier: Apache-2.0
#include "reference/bsdf.h"

#include "scene/albedo_table.h"

#include <cmath>
#include <numbers>

namespace obscura::reference {
namespace {

RgbD schlick(const RgbD& f0, const RgbD& f90, double cosine) {
    return f0 + (f90 - f0) * std::pow(std::clamp(1 - cosine, 0.0, 1.0), 5);
}

// Smith's Lambda for GGX.
double masking_lambda(const V3d& w, double alpha) {
    const double tan2 = (w.x * w.x + w.y * w.y) / (w.z * w.z);
    return (std::sqrt(1 + alpha * alpha * tan2) - 1) / 2;
}

double normal_density(const V3d& m, double alpha) {
    const double a2 = alpha * alpha;
    const double s = m.x * m.x + m.y * m.y + a2 * m.z * m.z;
    return a2 / (std::numbers::pi * s * s);
}

// A shading normal that faces away is bent until it sees the viewer at a grazing angle.
V3d facing_normal(const V3d& n_shade, const V3d& to_viewer) {
    const double facing = n_shade.dot(to_viewer);
    if (facing >= GRAZING_COSINE) return n_shade;
    return (n_shade + (GRAZING_COSINE - facing) * to_viewer).normalized();
}

// Visible normal of GGX (Heitz 2018, "Sampling the GGX Distribution of Visible Normals").
V3d sample_visible_normal(const V3d& wo, double alpha, const V2d& u) {
    const V3d stretched = V3d(alpha * wo.x, alpha * wo.y, wo.z).normalized();
    const double length = std::hypot(stretched.x, stretched.y);
    const V3d t1 = length > 0 ? V3d(-stretched.y, stretched.x, 0) / length : V3d(1, 0, 0);
    const V3d t2 = stretched.cross(t1);
    const V2d disc = concentric_disc(u);
    const double s = (1 + stretched.z) / 2;
    const double y = (1 - s) * std::sqrt(std::max(0.0, 1 - disc.x * disc.x)) + s * disc.y;
    const double z = std::sqrt(std::max(0.0, 1 - disc.x * disc.x - y * y));
    const V3d n = disc.x * t1 + y * t2 + z * stretched;
    return V3d(alpha * n.x, alpha * n.y, std::max(0.0, n.z)).normalized();
}

}  // namespace

Bsdf::Bsdf(const Surface& surface, const V3d& direction)
    : surface_(surface),
      basis_(facing_normal(surface.n_shade, -direction)),
      wo_(basis_.to_local(-direction)),
      alpha_(static_cast<double>(surface.material->model.alpha)) {
    wo_.z = std::max(GRAZING_COSINE, wo_.z);
    const SurfaceModel& model = surface.material->model;
    // lerp(dielectric, base, metallic): the model has the first part, f0 at the factor's colour less it the second.
    f0_ = RgbD(model.dielectric_f0) + surface.material->metallic * surface.base;
    f90_ = RgbD(model.f90);
    specular_ = RgbD(0);
    if (model.has_specular) {
        const AlbedoTerms terms = directional_albedo(std::min(1.0, wo_.z), alpha_);
        specular_ = terms.a * f0_ + terms.b * f90_;
    }
    diffuse_ = surface.base * RgbD(model.diffuse_scale) * (RgbD(1) - specular_);
}

LobeValue Bsdf::glossy(const V3d& wi) const {
    const V3d local = basis_.to_local(wi);
    const V3d m = (wo_ + local).normalized();
    const double d = normal_density(m, alpha_);
    const double lambda_o = masking_lambda(wo_, alpha_);
    const double lambda_i = masking_lambda(local, alpha_);
    const double scale = d / ((1 + lambda_o + lambda_i) * 4 * wo_.z * local.z);
    return {scale * schlick(f0_, f90_, wo_.dot(m)), d / ((1 + lambda_o) * 4 * wo_.z)};
}

double Bsdf::diffuse_pdf_sr(const V3d& wi) const {
    return std::max(0.0, wi.dot(basis_.normal)) / std::numbers::pi;
}

// World direction on the geometric normal's side; one that had to be reflected there has no density to compare with.
V3d Bsdf::above(const V3d& local, double& pdf_sr) const {
    const V3d world = basis_.to_world(local);
    if (world.dot(surface_.n_geo) < 0) pdf_sr = 0;
    return reflect_above(world, surface_.n_geo).normalized();
}

LobeSample Bsdf::sample_glossy(const V2d& u) const {
    const V3d m = sample_visible_normal(wo_, alpha_, u);
    const V3d wi = 2 * wo_.dot(m) * m - wo_;
    LobeSample sample;
    if (wi.z <= 0) return sample;
    const double lambda_o = masking_lambda(wo_, alpha_);
    const double lambda_i = masking_lambda(wi, alpha_);
    sample.pdf_sr = normal_density(m, alpha_) / ((1 + lambda_o) * 4 * wo_.z);
    sample.weight = (1 + lambda_o) / (1 + lambda_o + lambda_i) * schlick(f0_, f90_, wo_.dot(m));
    sample.direction = above(wi, sample.pdf_sr);
    return sample;
}

LobeSample Bsdf::sample_diffuse(const V2d& u) const {
    const V3d local = cosine_hemisphere(u);
    LobeSample sample;
    sample.weight = diffuse_;
    sample.pdf_sr = local.z / std::numbers::pi;
    sample.direction = above(local, sample.pdf_sr);
    return sample;
}

LobeSample Bsdf::mirror() const {
    LobeSample sample;
    sample.direction = above(V3d(-wo_.x, -wo_.y, wo_.z), sample.pdf_sr);
    sample.weight = schlick(f0_, f90_, wo_.z);
    return sample;
}

PaneShares Bsdf::pane() const {
    const double transmission = surface_.material->transmission;
    const double reflectance = pane_reflectance(std::min(1.0, wo_.z));
    const RgbD lobe = schlick(f0_, f90_, wo_.z);
    return {(1 - transmission) * lobe + transmission * RgbD(reflectance),
            transmission * (1 - reflectance) * surface_.base};
}

}  // namespace obscura::reference
