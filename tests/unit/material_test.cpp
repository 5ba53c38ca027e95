// SPDX-License-Identifier: Apache-2.0
// The mapping of glTF's materials, and the directional albedo of the specular lobe: against Monte Carlo by
// another parametrisation, closed forms, and the conservation of energy.
#include "scene/material.h"

#include "scene/albedo_table.h"
#include "support/scene_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace obscura {
namespace {

Material dielectric(float roughness) {
    Material material;
    material.base_color = Rgb(0.9f, 0.5f, 0.1f);
    material.metallic = 0;
    material.roughness = roughness;
    return material;
}

// A and B with microfacet normals drawn from those visible (Heitz 2018), weight G2 / G1.
AlbedoTerms sampled_albedo(double mu, double alpha, int count) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit;
    const V3d o(std::sqrt(1 - mu * mu), 0, mu);
    const V3d stretched = V3d(alpha * o.x, 0, o.z).normalized();
    const V3d t1(0, 1, 0);
    const V3d t2 = stretched.cross(t1);
    const auto lambda = [alpha](double c) {
        return (std::sqrt(1 + alpha * alpha * (1 / (c * c) - 1)) - 1) / 2;
    };
    AlbedoTerms sum;
    for (int i = 0; i < count; ++i) {
        const double r = std::sqrt(unit(random));
        const double phi = 2 * std::numbers::pi * unit(random);
        const double x = r * std::cos(phi);
        const double s = (1 + stretched.z) / 2;
        const double y = (1 - s) * std::sqrt(1 - x * x) + s * r * std::sin(phi);
        const double z = std::sqrt(std::max(0.0, 1 - x * x - y * y));
        V3d h = x * t1 + y * t2 + z * stretched;
        h = V3d(alpha * h.x, alpha * h.y, std::max(0.0, h.z)).normalized();
        const double mu_i = 2 * o.dot(h) * h.z - mu;
        if (mu_i <= 0) continue;
        const double weight = (1 + lambda(mu)) / (1 + lambda(mu) + lambda(mu_i)) / count;
        const double grazing = std::pow(1 - o.dot(h), 5);
        sum.a += weight * (1 - grazing);
        sum.b += weight * grazing;
    }
    return sum;
}

TEST(Albedo, QuadratureAgreesWithSampling) {
    for (const double alpha : {0.002, 0.05, 0.4, 1.0}) {
        for (const double mu : {0.02, 0.3, 0.7, 1.0}) {
            const AlbedoTerms expected = sampled_albedo(mu, alpha, 200000);
            const AlbedoTerms found = integrate_albedo(mu, alpha, 1);
            // Weights lie in [0, 1]: five standard errors are below 5 * 0.5 / sqrt(200000).
            EXPECT_NEAR(found.a, expected.a, 5e-3) << mu << " " << alpha;
            EXPECT_NEAR(found.b, expected.b, 5e-3) << mu << " " << alpha;
        }
    }
}

TEST(Albedo, TableEntriesAreConverged) {
    for (size_t j = 1; j < AlbedoTable::SIZE; ++j) {
        for (const size_t i : {0u, 1u, 2u, 7u, 16u, 30u, 31u}) {
            const double mu = static_cast<double>(i) / 31;
            const double alpha = std::pow(static_cast<double>(j) / 31, 2);
            const AlbedoTerms expected = integrate_albedo(mu, alpha, 0.5);
            const AlbedoTerms found = directional_albedo(mu, alpha);
            EXPECT_NEAR(found.a, expected.a, 1e-4) << mu << " " << alpha;
            EXPECT_NEAR(found.b, expected.b, 1e-4) << mu << " " << alpha;
        }
    }
}

TEST(Albedo, GrazingIncidenceLosesNothing) {
    // Height-correlated masking: at mu = 0 one bounce reflects everything where F = 1, at any roughness.
    for (const double alpha : {0.01, 0.1, 0.5, 1.0}) {
        const AlbedoTerms terms = integrate_albedo(0, alpha, 0.5);
        EXPECT_NEAR(terms.a + terms.b, 1, 1e-5) << alpha;
    }
}

TEST(Albedo, SharpLobeIsSchlick) {
    for (const double mu : {0.0, 0.1, 0.5, 1.0}) {
        const double grazing = std::pow(1 - mu, 5);
        EXPECT_DOUBLE_EQ(directional_albedo(mu, 0).b, grazing);
        EXPECT_NEAR(directional_albedo(mu, 0).a + grazing, 1, 1e-15);
    }
    for (const double mu : {0.3, 0.5, 1.0}) {
        EXPECT_NEAR(integrate_albedo(mu, 1e-3, 1).b, std::pow(1 - mu, 5), 1e-4);
        EXPECT_NEAR(integrate_albedo(mu, 1e-3, 1).a, 1 - std::pow(1 - mu, 5), 1e-4);
    }
}

TEST(Albedo, MeanIsTheCosineWeightedIntegral) {
    for (const double alpha : {0.0, 0.0015, 0.2, 0.7, 1.0}) {
        AlbedoTerms sum;
        const int count = 31 * 1000;  // midpoints that never straddle a column
        for (int i = 0; i < count; ++i) {
            const double mu = (i + 0.5) / count;
            const AlbedoTerms terms = directional_albedo(mu, alpha);
            sum.a += 2 * mu * terms.a / count;
            sum.b += 2 * mu * terms.b / count;
        }
        EXPECT_NEAR(mean_albedo(alpha).a, sum.a, 1e-7) << alpha;
        EXPECT_NEAR(mean_albedo(alpha).b, sum.b, 1e-7) << alpha;
    }
}

TEST(Albedo, TableNeverExceedsOne) {
    for (const float value : ALBEDO_TABLE.values)
        EXPECT_TRUE(value >= 0 && value <= 1) << value;
    for (double alpha = 0; alpha <= 1; alpha += 0.01) {
        for (double mu = 0; mu <= 1; mu += 0.01) {
            const AlbedoTerms terms = directional_albedo(mu, alpha);
            EXPECT_LE(terms.a + terms.b, 1) << mu << " " << alpha;
        }
    }
}

TEST(Material, ReflectsNoMoreThanArrives) {
    for (const float metallic : {0.0f, 0.3f, 1.0f}) {
        for (const float roughness : {0.0f, 0.03f, 0.032f, 0.2f, 0.6f, 1.0f}) {
            for (const float specular : {0.0f, 0.5f, 1.0f}) {
                for (const float tint : {0.0f, 1.0f, 30.0f}) {
                    Material material;
                    material.base_color = Rgb(1, 0.5f, 0);
                    material.metallic = metallic;
                    material.roughness = roughness;
                    material.specular = specular;
                    material.specular_color = Rgb(tint, tint, 1);
                    const SurfaceModel model = surface_model(material);
                    for (double mu = 0; mu <= 1; mu += 0.03125) {
                        const AlbedoTerms terms = directional_albedo(mu, static_cast<double>(model.alpha));
                        for (int c = 0; c < 3; ++c) {
                            const double a = static_cast<double>(model.f0[c]) * terms.a +
                                             static_cast<double>(model.f90[c]) * terms.b;
                            const double diffuse = static_cast<double>(material.base_color[c]) *
                                                   static_cast<double>(model.diffuse_scale[c]) * (1 - a);
                            EXPECT_GE(diffuse, -1e-15);
                            EXPECT_LE(a + diffuse, 1 + 1e-15) << mu << " " << metallic << " " << roughness;
                        }
                    }
                }
            }
        }
    }
}

TEST(Material, WithoutSpecularIsLambert) {
    const SurfaceModel model = surface_model(test::matte(Rgb(0.2f, 0.4f, 0.6f)));
    EXPECT_FALSE(model.has_specular);
    EXPECT_EQ(model.f0, Rgb(0, 0, 0));
    EXPECT_EQ(model.f90, Rgb(0, 0, 0));
    EXPECT_EQ(model.mean_scale, Rgb(1, 1, 1));
    EXPECT_EQ(mean_reflectivity(test::matte(Rgb(1, 1, 1)), RgbD(0.25, 0.5, 1)), RgbD(0.25, 0.5, 1));
}

TEST(Material, DielectricReflectsFourPerCent) {
    const SurfaceModel model = surface_model(dielectric(0));
    EXPECT_TRUE(model.has_specular);
    EXPECT_EQ(model.alpha, 0);
    EXPECT_FLOAT_EQ(model.f0.x, 0.04f);
    EXPECT_EQ(model.f90, Rgb(1, 1, 1));
    // Mirror: a_mean = F0 20/21 + F90 1/21.
    const double a_mean = 0.04 * 20 / 21 + 1.0 / 21;
    EXPECT_NEAR(mean_reflectivity(dielectric(0), RgbD(0.5, 0.5, 0.5)).x, 0.5 * (1 - a_mean), 1e-15);
}

TEST(Material, MeanReflectivityIsTheMeanOfDiffuseAlbedo) {
    const Material material = dielectric(0.5f);
    const SurfaceModel model = surface_model(material);
    double sum = 0;
    const int count = 31000;
    for (int i = 0; i < count; ++i) {
        const double mu = (i + 0.5) / count;
        const AlbedoTerms terms = directional_albedo(mu, static_cast<double>(model.alpha));
        sum += 2 * mu * 0.9 * (1 - (0.04 * terms.a + terms.b)) / count;
    }
    EXPECT_NEAR(mean_reflectivity(material, RgbD(0.9, 0.9, 0.9)).x, sum, 1e-7);
}

TEST(Material, MetalHasNoDiffusePart) {
    const SurfaceModel model = surface_model(test::metal(Rgb(0.9f, 0.6f, 0.3f), 0.4f));
    EXPECT_EQ(model.f0, Rgb(0.9f, 0.6f, 0.3f));
    EXPECT_EQ(model.dielectric_f0, Rgb(0, 0, 0));
    EXPECT_EQ(model.f90, Rgb(1, 1, 1));
    EXPECT_EQ(model.diffuse_scale, Rgb(0, 0, 0));
    EXPECT_FLOAT_EQ(model.alpha, 0.16f);
    EXPECT_EQ(mean_reflectivity(test::metal(Rgb(1, 1, 1), 0.4f), RgbD(1, 1, 1)), RgbD(0, 0, 0));
}

TEST(Material, RoughnessBelowTheLimitIsAMirror) {
    EXPECT_EQ(surface_model(dielectric(0.0316f)).alpha, 0);
    EXPECT_GT(surface_model(dielectric(0.0317f)).alpha, 0);
}

TEST(Material, SpecularColorIsCappedAtFullReflection) {
    Material material = dielectric(0.3f);
    material.specular = 0.5f;
    material.specular_color = Rgb(100, 1, 0);
    const SurfaceModel model = surface_model(material);
    EXPECT_FLOAT_EQ(model.f0.x, 0.5f);
    EXPECT_FLOAT_EQ(model.f0.y, 0.02f);
    EXPECT_EQ(model.f0.z, 0);
    EXPECT_FLOAT_EQ(model.f90.x, 0.5f);
}

TEST(Material, PaneWeighsItsReflectance) {
    EXPECT_NEAR(pane_reflectance(1), 0.08 / 1.04, 1e-15);
    EXPECT_EQ(pane_reflectance(0), 1);
    double sum = 0;
    for (int i = 0; i < 100000; ++i) {
        const double mu = (i + 0.5) / 100000;
        sum += 2 * mu * pane_reflectance(mu) / 100000;
    }
    EXPECT_NEAR(mean_pane_reflectance(), sum, 1e-9);
    Material glass = test::matte(Rgb(1, 1, 1));
    glass.transmission = 1;
    EXPECT_NEAR(surface_model(glass).opacity, mean_pane_reflectance(), 1e-15);
    EXPECT_EQ(surface_model(glass).diffuse_scale, Rgb(0, 0, 0));
    EXPECT_EQ(surface_model(test::matte(Rgb(1, 1, 1))).opacity, 1);
}

TEST(Material, PanesAreSmooth) {
    Material glass = dielectric(0.5f);
    EXPECT_GT(surface_model(glass).alpha, 0);
    glass.transmission = 0.25f;
    EXPECT_EQ(surface_model(glass).alpha, 0);
    EXPECT_TRUE(surface_model(glass).has_specular);
}

// Reflected, passed and diffuse light as scene/material.h adds them up.
TEST(Material, PaneAndSurfaceShareWhatArrives) {
    for (const float transmission : {0.1f, 0.5f, 1.0f}) {
        for (const float metallic : {0.0f, 0.5f, 1.0f}) {
            Material material = dielectric(0.6f);
            material.base_color = Rgb(1, 0.5f, 0);
            material.metallic = metallic;
            material.transmission = transmission;
            const SurfaceModel model = surface_model(material);
            const auto t = static_cast<double>(transmission);
            for (double mu = 0; mu <= 1; mu += 0.03125) {
                const AlbedoTerms terms = directional_albedo(mu, static_cast<double>(model.alpha));
                const double pane = pane_reflectance(mu);
                for (int c = 0; c < 3; ++c) {
                    const auto base = static_cast<double>(material.base_color[c]);
                    const double a = static_cast<double>(model.f0[c]) * terms.a +
                                     static_cast<double>(model.f90[c]) * terms.b;
                    const double diffuse = base * static_cast<double>(model.diffuse_scale[c]) * (1 - a);
                    const double sum = (1 - t) * a + t * pane + t * (1 - pane) * base + diffuse;
                    EXPECT_LE(sum, 1 + 1e-7);
                    if (base < 1 || metallic > 0) continue;
                    EXPECT_NEAR(sum, 1, 1e-7) << mu << " " << transmission << " " << metallic;
                }
            }
        }
    }
}

TEST(Material, UnlitSurfaceIsOpaqueAndBlackToOthers) {
    Material picture = dielectric(0.5f);
    picture.emission = Rgb(1);
    picture.transmission = 0.5f;
    EXPECT_TRUE(is_pane(picture) && is_emissive(picture));
    picture.unlit = true;
    EXPECT_FALSE(is_pane(picture) || is_emissive(picture));
    const SurfaceModel model = surface_model(picture);
    EXPECT_FALSE(model.has_specular);
    EXPECT_EQ(model.opacity, 1);
    EXPECT_EQ(model.diffuse_scale, Rgb(0));
    EXPECT_EQ(model.mean_scale, Rgb(0));
    EXPECT_EQ(mean_reflectivity(picture, RgbD(1)), RgbD(0));
}

}  // namespace
}  // namespace obscura
