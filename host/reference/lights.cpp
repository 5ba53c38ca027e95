// SPDX-License-Identifier: Apache-2.0
#include "reference/lights.h"

#include "shared/scene.h"

#include <cmath>

namespace obscura::reference {
namespace {

// While lights are few, each is weighed by what it could send to the receiver. Its centroid stands for it, so the
// cosine is kept above this and the squared distance above the light's own area.
constexpr double MIN_LIGHT_COSINE = 0.02;
// KHR_lights_punctual keeps the ramp of a spot light's edge from vanishing.
constexpr double SMALLEST_SPOT_RAMP = 0.001;

size_t pick_alias(const std::vector<AliasEntry>& table, double u) {
    const double x = u * static_cast<double>(table.size());
    const size_t column = std::min(static_cast<size_t>(x), table.size() - 1);
    const AliasEntry& entry = table[column];
    return x - static_cast<double>(column) < static_cast<double>(entry.acceptance) ? column : entry.alias;
}

// The unit square onto a triangle's barycentrics (Heitz 2019).
V3d triangle_weights(const V2d& u) {
    const V2d b = u.y > u.x ? V2d(u.x / 2, u.y - u.x / 2) : V2d(u.x - u.y / 2, u.y / 2);
    return {b.x, b.y, 1 - b.x - b.y};
}

// Irradiance in the middle of the scene; lamps count as no nearer than a quarter of its diagonal.
double punctual_weight(const Scene& scene, const PunctualLight& light) {
    const double intensity = mean_component(RgbD(light.intensity));
    if (light.type == LightType::directional || scene.bounds.isEmpty()) return intensity;
    const V3d low(scene.bounds.min), high(scene.bounds.max);
    const double nearest = (high - low).length() / 4;
    const double distance = std::max(nearest, (V3d(light.position) - (low + high) / 2).length());
    return intensity / (distance * distance);
}

double pdf_sr_of(double probability, double area, double distance2, double cosine) {
    return probability * distance2 / (area * cosine);
}

}  // namespace

Lights::Lights(const Scene& scene, const SurfaceScene& surfaces) : surfaces_(surfaces) {
    light_of_triangle_.assign(surfaces.triangle_count(), NO_LIGHT);
    std::vector<double> powers;
    for (uint32_t i = 0; i < surfaces.triangle_count(); ++i) {
        const MaterialData& material = surfaces.material_of(i);
        if (!(max_component(material.emission) > 0)) continue;
        const TriangleData& triangle = surfaces.triangle(i);
        const V3d center = triangle.point(V3d(1.0 / 3));
        light_of_triangle_[i] = static_cast<uint32_t>(area_lights_.size());
        area_lights_.push_back({i, center, material.double_sided});
        powers.push_back(mean_component(material.emission) * triangle.area * (material.double_sided ? 2 : 1));
    }
    if (!powers.empty()) area_table_ = build_alias_table(powers);

    std::vector<double> irradiances;
    for (const PunctualLight& light : scene.lights) {
        const double irradiance = punctual_weight(scene, light);
        if (!(irradiance > 0)) continue;
        punctual_lights_.push_back(light);
        irradiances.push_back(irradiance);
    }
    if (!irradiances.empty()) punctual_table_ = build_alias_table(irradiances);
}

double Lights::weight(size_t light, const V3d& position) const {
    const AreaLight& area_light = area_lights_[light];
    const TriangleData& triangle = surfaces_.triangle(area_light.triangle);
    const V3d to_point = position - area_light.center;
    const double height = to_point.dot(triangle.n_geo);
    if (height <= 0 && !area_light.two_sided) return 0;
    const double distance2 = std::max(to_point.length2(), triangle.area);
    const double cosine = std::max(std::abs(height) / std::sqrt(distance2), MIN_LIGHT_COSINE);
    return static_cast<double>(area_table_[light].probability) * cosine / distance2;
}

double Lights::probability(size_t light, const V3d& position) const {
    if (area_lights_.size() > MAX_WEIGHED_LIGHTS) return static_cast<double>(area_table_[light].probability);
    double sum = 0;
    for (size_t i = 0; i < area_lights_.size(); ++i)
        sum += weight(i, position);
    return sum > 0 ? weight(light, position) / sum : 0;
}

// Of few lights u.x picks one, and what is left of it is stretched to [0, 1) again.
size_t Lights::pick(const V3d& position, V2d& u, double select_u, double& probability) const {
    if (area_lights_.size() > MAX_WEIGHED_LIGHTS) {
        const size_t light = pick_alias(area_table_, select_u);
        probability = static_cast<double>(area_table_[light].probability);
        return light;
    }
    std::array<double, MAX_WEIGHED_LIGHTS> weights;
    double sum = 0;
    for (size_t i = 0; i < area_lights_.size(); ++i) {
        weights[i] = weight(i, position);
        sum += weights[i];
    }
    probability = 0;
    size_t light = 0;
    double below = 0;  // weights of the lights before this one
    double before = 0;
    for (size_t i = 0; i < area_lights_.size(); ++i) {
        if (!(weights[i] > 0)) continue;
        light = i;
        before = below;
        probability = weights[i] / sum;
        below += weights[i];
        if (u.x * sum < below) break;
    }
    if (probability > 0) u.x = std::clamp((u.x * sum - before) / weights[light], 0.0, 1 - 0x1p-53);
    return light;
}

LightSample Lights::sample_area(const V3d& position, const V2d& u, double select_u) const {
    LightSample sample;
    if (area_lights_.empty()) return sample;
    V2d on_light = u;
    double probability = 0;
    const AreaLight& light = area_lights_[pick(position, on_light, select_u, probability)];
    if (!(probability > 0)) return sample;
    const TriangleData& triangle = surfaces_.triangle(light.triangle);
    const V3d point = triangle.point(triangle_weights(on_light));
    const V3d to_light = point - position;
    const double distance2 = to_light.length2();
    if (!(distance2 > 0)) return sample;
    sample.direction = to_light / std::sqrt(distance2);
    const double cosine = -sample.direction.dot(triangle.n_geo);
    if (cosine == 0) return sample;
    sample.pdf_sr = pdf_sr_of(probability, triangle.area, distance2, std::abs(cosine));
    sample.target = point + std::copysign(triangle.lift, cosine) * triangle.n_geo;
    if (cosine > 0 || light.two_sided)
        sample.radiance = surfaces_.material_of(light.triangle).emission / sample.pdf_sr;
    return sample;
}

LightSample Lights::sample_punctual(const V3d& position, double select_u) const {
    LightSample sample;
    if (punctual_lights_.empty()) return sample;
    const size_t index = pick_alias(punctual_table_, select_u);
    const PunctualLight& light = punctual_lights_[index];
    sample.radiance = RgbD(light.intensity) / static_cast<double>(punctual_table_[index].probability);
    if (light.type == LightType::directional) {
        sample.parallel = true;
        sample.direction = -V3d(light.direction).normalized();
        return sample;
    }
    sample.target = V3d(light.position);
    const V3d to_light = sample.target - position;
    const double distance2 = to_light.length2();
    sample.direction = to_light / std::sqrt(distance2);
    double attenuation = 1 / distance2;
    if (light.range > 0) {
        const double ratio = std::sqrt(distance2) / static_cast<double>(light.range);
        attenuation *= std::clamp(1 - std::pow(ratio, 4), 0.0, 1.0);
    }
    if (light.type == LightType::spot) {
        const auto cos_outer = static_cast<double>(light.cos_outer);
        const double ramp = std::max(SMALLEST_SPOT_RAMP, static_cast<double>(light.cos_inner) - cos_outer);
        const double cosine = -sample.direction.dot(V3d(light.direction));
        const double cone = std::clamp((cosine - cos_outer) / ramp, 0.0, 1.0);
        attenuation *= cone * cone;
    }
    sample.radiance *= attenuation;
    return sample;
}

double Lights::area_pdf_sr(uint32_t triangle, const V3d& from, const V3d& direction, double distance) const {
    const uint32_t light = light_of_triangle_[triangle];
    if (light == NO_LIGHT) return 0;
    const TriangleData& data = surfaces_.triangle(triangle);
    return pdf_sr_of(probability(light, from), data.area, distance * distance,
                     std::abs(direction.dot(data.n_geo)));
}

}  // namespace obscura::reference
