// SPDX-License-Identifier: Apache-2.0
#include "reference/expected_results.h"

#include <algorithm>
#include <cmath>

namespace obscura {
namespace {

constexpr double ROUNDING = 0x1p-24;
constexpr size_t MAX_PANES = 16;  // that a ray passes; the next one stops it like a wall

Bounded operator+(const Bounded& a, const Bounded& b) {
    const double sum = a.value + b.value;
    return {sum, a.error + b.error + ROUNDING * std::abs(sum)};
}

Bounded operator*(const Bounded& a, const Bounded& b) {
    const double product = a.value * b.value;
    return {product, std::abs(a.value) * b.error + std::abs(b.value) * a.error + a.error * b.error +
                         ROUNDING * std::abs(product)};
}

Bounded rest_of(const Bounded& share) {
    return {1 - share.value, share.error + ROUNDING};
}

Bounded mean(const BoundedRgb& rgb) {
    return (rgb[0] + rgb[1] + rgb[2]) * Bounded{1.0 / 3, ROUNDING};
}

BoundedRgb constant(double value) {
    return {Bounded{value, 0}, Bounded{value, 0}, Bounded{value, 0}};
}

}  // namespace

ExpectedResults::ExpectedResults(const Scene& scene, const RenderSettings& settings,
                                 const HitComparison& hits)
    : scene_(scene),
      settings_(settings),
      hits_(hits),
      d_max_(resolve_max_distance(settings.d_max, scene) / scene.unit),
      reach_(scene.triangles.empty() ? 0 : V3d(scene.bounds.size()).length()) {
    for (const Material& material : scene.materials)
        models_.push_back(surface_model(material));
    textures_.reserve(scene.textures.size());
    for (const Texture& texture : scene.textures)
        textures_.emplace_back(texture);
}

ExpectedResult ExpectedResults::light_through(const TraceRay& ray, const Hits& hits) const {
    BoundedRgb through = constant(1);
    size_t panes = 0;
    for (const BruteHit& hit : hits) {
        if (!is_pane_hit(hit) || panes++ == MAX_PANES) return {};
        const BoundedRgb passed = passed_by(ray, hit);
        for (size_t c = 0; c < 3; ++c)
            through[c] = through[c] * passed[c];
    }
    return {through[0], through[1], through[2], mean(through)};
}

ExpectedResult ExpectedResults::brought_back(const TraceRay& ray, const V3f& start, const V3f& miss,
                                             const Hits& hits) const {
    BoundedRgb through = constant(1);
    BoundedRgb w = constant(0);
    Bounded colourless;
    double lateral = 0;
    size_t panes = 0;
    for (const BruteHit& hit : hits) {
        const Bounded rho = falloff(ray, start, hit, lateral);
        const SurfaceModel& model = models_[scene_.triangles[hit.primitive].material];
        const BoundedRgb base = base_color(ray, hit);
        const bool passes = is_pane_hit(hit) && panes++ < MAX_PANES;
        const BoundedRgb passed = passes ? passed_by(ray, hit) : constant(0);
        BoundedRgb blocked;
        for (size_t c = 0; c < 3; ++c) {
            blocked[c] = through[c] * rest_of(passed[c]);
            const Bounded scale{static_cast<double>(model.mean_scale[static_cast<int>(c)]), 0};
            const Bounded reflectivity = settings_.bleeding ? base[c] * scale : Bounded{1, 0};
            w[c] = w[c] + rho * blocked[c] * reflectivity;
            through[c] = through[c] * passed[c];
        }
        colourless = colourless + rho * mean(blocked);
        if (!passes) return {w[0], w[1], w[2], colourless};
        lateral += lift(hit);
    }
    for (size_t c = 0; c < 3; ++c)
        w[c] = w[c] + through[c] * Bounded{static_cast<double>(miss[static_cast<int>(c)]), 0};
    return {w[0], w[1], w[2], colourless + mean(through)};
}

ExpectedResults::Hits ExpectedResults::hits_of_embree(const TraceRay& ray) const {
    Hits hits;
    float after = 0;
    while (hits.size() <= MAX_PANES) {
        const TraceHit hit = hits_.embree().next(ray, after);
        if (hit.primitive == NO_PRIMITIVE) break;
        hits.push_back(hits_.oracle().examine(ray, hit.primitive));
        if (!is_pane_hit(hits.back())) break;
        after = hit.t;
    }
    return hits;
}

bool ExpectedResults::is_ambiguous(const TraceRay& ray) const {
    const double culling = 64 * ROUNDING * (reach_ + V3d(ray.origin).length());
    TraceRay longer = ray;
    longer.t_max = ray.t_max * (1 + 0x1p-10f);
    double lateral = 0;
    double last_t = 0;
    double last_error = 0;
    for (const BruteHit& hit : hits_.oracle().candidates(longer, culling)) {
        const double error = hits_.distance_error(ray, hit) + lateral / std::max(hit.cosine, 1e-12);
        const double near = hits_.position_error(ray, hit.primitive) + lateral;
        if (hit.inside_by() < -near) continue;
        const bool at_an_end = std::abs(hit.t - static_cast<double>(ray.t_max)) <= error;
        if (at_an_end || hit.inside_by() <= near || hit.t - last_t <= error + last_error) return true;
        if (hit.t > static_cast<double>(ray.t_max) || !is_pane_hit(hit)) return false;
        lateral += lift(hit);
        last_t = hit.t;
        last_error = error;
    }
    return false;
}

double ExpectedResults::lift(const BruteHit& pane) const {
    double largest = 0;
    for (int corner = 0; corner < 3; ++corner) {
        const V3f& p = scene_.corner(pane.primitive, corner).position;
        largest = std::max({largest, static_cast<double>(std::abs(p.x)), static_cast<double>(std::abs(p.y)),
                            static_cast<double>(std::abs(p.z))});
    }
    return 64 * ROUNDING * largest;
}

bool ExpectedResults::is_pane_hit(const BruteHit& hit) const {
    return is_pane(scene_.materials[scene_.triangles[hit.primitive].material]);
}

// The texture at the hit. The coordinates are off by what the weights are and by their own rounding; a colour changes by
// at most 1 per texel of a bilinear texture, and at the borders of texels of one that isn't filtered.
BoundedRgb ExpectedResults::base_color(const TraceRay& ray, const BruteHit& hit) const {
    const Material& material = scene_.materials[scene_.triangles[hit.primitive].material];
    RgbD base(material.base_color);
    double error = 0;
    if (material.base_color_texture != NO_TEXTURE) {
        const auto index = static_cast<size_t>(material.base_color_texture);
        const Texture& texture = scene_.textures[index];
        const Imath::V2d size(texture.width, texture.height);
        Imath::V2d uv[3];
        for (int i = 0; i < 3; ++i)
            uv[i] = Imath::V2d(scene_.corner(hit.primitive, i).uv) * size;
        const Imath::V2d at = (1 - hit.u - hit.v) * uv[0] + hit.u * uv[1] + hit.v * uv[2];
        const double du = hits_.weight_error(ray, hit, 1);
        const double dv = hits_.weight_error(ray, hit, 2);
        Imath::V2d apart;
        for (int axis = 0; axis < 2; ++axis) {
            const double largest =
                std::max({std::abs(uv[0][axis]), std::abs(uv[1][axis]), std::abs(uv[2][axis])});
            apart[axis] = du * std::abs(uv[1][axis] - uv[0][axis]) +
                          dv * std::abs(uv[2][axis] - uv[0][axis]) + 8 * ROUNDING * (largest + 1);
        }
        const RgbD color = textures_[index].sample(at.x, at.y);
        if (texture.filter == TextureFilter::linear) {
            error = apart.x + apart.y;
        } else {
            for (const double x : {at.x - apart.x, at.x + apart.x})
                for (const double y : {at.y - apart.y, at.y + apart.y})
                    for (int c = 0; c < 3; ++c)
                        error = std::max(error, std::abs(textures_[index].sample(x, y)[c] - color[c]));
        }
        base *= color;
    }
    BoundedRgb result;
    for (size_t c = 0; c < 3; ++c)
        result[c] = {base[static_cast<int>(c)], error + 8 * ROUNDING};
    return result;
}

// Schlick's reflectance rises by less than 10 per unit of the cosine, which the device has from its own normal.
BoundedRgb ExpectedResults::passed_by(const TraceRay& ray, const BruteHit& pane) const {
    const Material& material = scene_.materials[scene_.triangles[pane.primitive].material];
    const double share = static_cast<double>(material.transmission) * (1 - pane_reflectance(pane.cosine));
    const Bounded clear{share, 10 * 16 * ROUNDING + 16 * ROUNDING};
    BoundedRgb passed = base_color(ray, pane);
    for (Bounded& channel : passed)
        channel = channel * clear;
    return passed;
}

// rho at the distance from the point itself. The device is off by the distance's error, a few roundings of it and by what
// OpenCL allows: 16 ulp of pow, 3 of sqrt, 2 of cbrt. Our own exp is within 1.
Bounded ExpectedResults::falloff(const TraceRay& ray, const V3f& start, const BruteHit& hit,
                                 double lateral) const {
    const double d = (V3d(start) + hit.t * V3d(ray.direction)).length();
    const double apart = hits_.distance_error(ray, hit) + lateral * (1 + 1 / std::max(hit.cosine, 1e-12));
    const double error = (2 * apart + 8 * ROUNDING * d) / d_max_;
    const double t = d / d_max_;
    const double value = falloff_value(settings_.falloff, t);
    const double above = falloff_value(settings_.falloff, t + error) - value;
    const double below = value - falloff_value(settings_.falloff, std::max(0.0, t - error));
    const double ulps = settings_.falloff.kind == FalloffKind::pow ? 16 : 3;
    return {value, std::max(above, below) + (5 + ulps) * ROUNDING};
}

}  // namespace obscura
