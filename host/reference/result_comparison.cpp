// SPDX-License-Identifier: Apache-2.0
#include "reference/result_comparison.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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

std::string text(const std::array<double, 4>& values) {
    return fmt::format("rgb {:.9g} {:.9g} {:.9g}, without colours {:.9g}", values[0], values[1], values[2],
                       values[3]);
}

}  // namespace

void ResultTally::add(const ResultTally& other) {
    checked += other.checked;
    behind_panes += other.behind_panes;
    worst_share = std::max(worst_share, other.worst_share);
    worst = std::max(worst, other.worst);
}

ResultComparison::ResultComparison(const Scene& scene, const RenderSettings& settings,
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

namespace {

// Both results of a chunk of rays.
struct Tallies {
    ResultTally results;
    HitTally hits;

    static Tallies sum(Tallies a, const Tallies& b) {
        a.results.add(b.results);
        a.hits.add(b.hits);
        return a;
    }
};

template <typename Compare>
ResultTally for_each_ray(size_t count, HitTally& tally, const Compare& compare) {
    const Tallies all = tbb::parallel_deterministic_reduce(
        tbb::blocked_range<size_t>(0, count, 4096), Tallies{},
        [&](const auto& range, Tallies tallies) {
            for (size_t i = range.begin(); i < range.end(); ++i)
                compare(i, tallies.results, tallies.hits);
            return tallies;
        },
        Tallies::sum);
    tally.add(all.hits);
    return all.results;
}

}  // namespace

ResultTally ResultComparison::shadow(const CapturedRays& captured, size_t every, HitTally& tally) const {
    return for_each_ray(captured.rays.size(), tally, [&](size_t i, ResultTally& results, HitTally& hits) {
        const TraceRay& ray = captured.rays[i];
        const f32x4& passed = captured.results[i];
        const f32x4 given{passed.x, passed.y, passed.z, (passed.x + passed.y + passed.z) / 3};
        ++hits.rays;
        if (given.w == 0) ++hits.hits;
        const auto expect = [&](const Hits& along) { return light_through(ray, along); };
        compare_one(ray, given, hits_of_embree(ray), expect, is_drawn(i, every), results, hits);
    });
}

ResultTally ResultComparison::obscurance(const CapturedRays& captured, const Frame& frame, size_t every,
                                         HitTally& tally) const {
    const V3f miss(frame.miss.x, frame.miss.y, frame.miss.z);
    return for_each_ray(captured.rays.size(), tally, [&](size_t i, ResultTally& results, HitTally& hits) {
        const TraceRay& ray = captured.rays[i];
        const Hits embree = hits_of_embree(ray);
        const uint32_t first = embree.empty() ? NO_PRIMITIVE : embree.front().primitive;
        if (first != captured.hits[i].primitive) return;
        const auto expect = [&](const Hits& along) {
            return brought_back(ray, captured.starts[i], miss, along);
        };
        compare_one(ray, captured.results[i], embree, expect, is_drawn(i, every), results, hits);
    });
}

// expect: what a ray with these hits brings back.
template <typename Expect>
void ResultComparison::compare_one(const TraceRay& ray, const f32x4& given, const Hits& hits,
                                   const Expect& expect, bool judge_anyway, ResultTally& results,
                                   HitTally& tally) const {
    const std::array<double, 4> values{static_cast<double>(given.x), static_cast<double>(given.y),
                                       static_cast<double>(given.z), static_cast<double>(given.w)};
    struct Difference {
        double share = 0, largest = 0;
    };
    const auto difference = [&](const Expected& expected) {
        Difference worst;
        for (size_t i = 0; i < values.size(); ++i) {
            const double apart = std::abs(values[i] - expected[i].value);
            worst.largest = std::max(worst.largest, apart);
            const double share = apart == 0 ? 0 : apart / expected[i].error;
            worst.share =
                std::max(worst.share, std::isnan(share) ? std::numeric_limits<double>::infinity() : share);
        }
        return worst;
    };
    ++results.checked;
    if (!hits.empty() && is_pane_hit(hits.front())) ++results.behind_panes;
    Expected expected = expect(hits);
    Difference found = difference(expected);
    Outcome outcome = Outcome::same;
    if (judge_anyway || found.share > 1) {
        ++tally.judged;
        const Expected of_oracle = expect(hits_.oracle().candidates(ray));
        const Difference truth = difference(of_oracle);
        if (truth.share <= 1) {
            // Embree's rounding may be to blame too, and at the ends: they are inclusive there.
            if (found.share > 1 && !is_ambiguous(ray)) outcome = Outcome::embree_wrong;
            found = truth;
        } else {
            outcome = is_ambiguous(ray) ? Outcome::edge : Outcome::device_wrong;
        }
        expected = of_oracle;
    }
    if (outcome != Outcome::edge) {
        results.worst_share = std::max(results.worst_share, found.share);
        results.worst = std::max(results.worst, found.largest);
    }
    tally.count(outcome, ray, [&] {
        return std::pair(text(values),
                         text({expected[0].value, expected[1].value, expected[2].value, expected[3].value}));
    });
}

ResultComparison::Expected ResultComparison::light_through(const TraceRay& ray, const Hits& hits) const {
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

ResultComparison::Expected ResultComparison::brought_back(const TraceRay& ray, const V3f& start,
                                                          const V3f& miss, const Hits& hits) const {
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

// Exact intersections with the triangles that Embree meets, up to the first that stops the ray.
ResultComparison::Hits ResultComparison::hits_of_embree(const TraceRay& ray) const {
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

// Whether rounding may decide what the ray meets: up to the first surface that stops it, a triangle's edge or another
// triangle is within the errors, or an end of the ray is.
bool ResultComparison::is_ambiguous(const TraceRay& ray) const {
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

double ResultComparison::lift(const BruteHit& pane) const {
    double largest = 0;
    for (int corner = 0; corner < 3; ++corner) {
        const V3f& p = scene_.corner(pane.primitive, corner).position;
        largest = std::max({largest, static_cast<double>(std::abs(p.x)), static_cast<double>(std::abs(p.y)),
                            static_cast<double>(std::abs(p.z))});
    }
    return 64 * ROUNDING * largest;
}

bool ResultComparison::is_pane_hit(const BruteHit& hit) const {
    return is_pane(scene_.materials[scene_.triangles[hit.primitive].material]);
}

// The texture at the hit. The coordinates are off by what the weights are and by their own rounding; a colour changes by
// at most 1 per texel of a bilinear texture, and at the borders of texels of one that isn't filtered.
BoundedRgb ResultComparison::base_color(const TraceRay& ray, const BruteHit& hit) const {
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
BoundedRgb ResultComparison::passed_by(const TraceRay& ray, const BruteHit& pane) const {
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
Bounded ResultComparison::falloff(const TraceRay& ray, const V3f& start, const BruteHit& hit,
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
