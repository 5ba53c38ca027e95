// SPDX-License-Identifier: Apache-2.0
// What the stage obscurance wrote for real rays against R(Q) rho(d) in double from Embree's hits, or R_ave where
// Embree finds nothing. The tolerance of each ray follows from the roundings that lead to it: of the distance
// (support/hit_comparison.h), of rho, of the texture coordinates.
#pragma once

#include "base/error.h"
#include "scene/material.h"
#include "scene/texture.h"
#include "support/capture.h"
#include "support/hit_comparison.h"

#include <array>
#include <cmath>
#include <vector>

namespace obscura::test {

// How the results of the stage obscurance compare with what Embree's hits give.
struct ResultTally {
    uint64_t checked = 0;
    uint64_t behind_panes = 0;  // first hit a pane: only that segment was compared
    uint64_t disputed = 0;      // another triangle: compared as a hit, not as a result
    double worst_share = 0;     // largest difference as a share of what rounding explains
    double worst = 0;           // the same, absolute

    void add(const ResultTally& other) {
        checked += other.checked;
        behind_panes += other.behind_panes;
        disputed += other.disputed;
        worst_share = std::max(worst_share, other.worst_share);
        worst = std::max(worst, other.worst);
    }
};

class ResultComparison {
  public:
    ResultComparison(const Scene& scene, const RenderSettings& settings, const HitComparison& comparison)
        : scene_(scene),
          settings_(settings),
          comparison_(comparison),
          d_max_(resolve_max_distance(settings.d_max, scene.bounds)) {
        for (const Material& material : scene.materials)
            models_.push_back(surface_model(material));
        for (const Texture& texture : scene.textures)
            textures_.emplace_back(texture);
    }

    ResultTally compare(const CapturedRays& captured, const std::vector<TraceHit>& embree,
                        const Frame& frame) const {
        return tbb::parallel_reduce(
            tbb::blocked_range<size_t>(0, captured.rays.size(), 4096), ResultTally{},
            [&](const auto& range, ResultTally tally) {
                for (size_t i = range.begin(); i < range.end(); ++i)
                    compare_one(captured, i, embree[i], frame, tally);
                return tally;
            },
            [](ResultTally a, const ResultTally& b) {
                a.add(b);
                return a;
            });
    }

  private:
    static constexpr double ROUNDING = 0x1p-24;

    struct Value {
        double value, error;
    };

    void compare_one(const CapturedRays& captured, size_t i, const TraceHit& embree, const Frame& frame,
                     ResultTally& tally) const {
        const f32x4& result = captured.results[i];
        if (captured.hits[i].primitive != embree.primitive) {
            ++tally.disputed;
            return;
        }
        std::array<Value, 3> expected;
        Value colourless{1, 0};
        if (embree.primitive == NO_PRIMITIVE) {
            expected = {Value{static_cast<double>(frame.miss.x), 0},
                        Value{static_cast<double>(frame.miss.y), 0},
                        Value{static_cast<double>(frame.miss.z), 0}};
        } else {
            const Material& material = scene_.materials[scene_.triangles[embree.primitive].material];
            if (is_pane(material)) {
                ++tally.behind_panes;
                return;
            }
            colourless = falloff(captured.rays[i], captured.starts[i], embree);
            expected = weighted(colourless, reflectivity(captured.hits[i], embree));
        }
        ++tally.checked;
        const float given[] = {result.x, result.y, result.z};
        for (size_t c = 0; c < 3; ++c)
            note(given[c], expected[c], tally);
        note(result.w, colourless, tally);
    }

    static void note(float given, const Value& expected, ResultTally& tally) {
        const double difference = std::abs(static_cast<double>(given) - expected.value);
        tally.worst = std::max(tally.worst, difference);
        if (difference > 0) tally.worst_share = std::max(tally.worst_share, difference / expected.error);
    }

    // rho at the distance from the point itself. The device is off by the distance's error, a few roundings of it and
    // at most 3 ulp of expm1 or pow.
    Value falloff(const TraceRay& ray, const V3f& start, const TraceHit& embree) const {
        const double d = (V3d(start) + static_cast<double>(embree.t) * V3d(ray.direction)).length();
        const double error =
            (2 * comparison_.distance(ray, embree.primitive).bound + 8 * ROUNDING * d) / d_max_;
        const double t = d / d_max_;
        const double value = falloff_value(settings_.falloff, t);
        const double spread = std::max(falloff_value(settings_.falloff, t + error) - value,
                                       value - falloff_value(settings_.falloff, std::max(0.0, t - error)));
        return {value, spread + 8 * ROUNDING};
    }

    // Colours of a bilinear texture change by at most 1 per texel: the two tracers' different barycentrics, and the
    // rounding of the texture coordinates, count so much.
    std::array<Value, 3> reflectivity(const TraceHit& device, const TraceHit& embree) const {
        if (!settings_.bleeding) return {Value{1, 0}, Value{1, 0}, Value{1, 0}};
        const Triangle& triangle = scene_.triangles[embree.primitive];
        const Material& material = scene_.materials[triangle.material];
        RgbD base(material.base_color);
        double error = 0;
        if (material.base_color_texture != NO_TEXTURE) {
            const auto index = static_cast<size_t>(material.base_color_texture);
            const Texture& texture = scene_.textures[index];
            OBSCURA_CHECK(texture.filter == TextureFilter::linear, "texture {} isn't bilinear", texture.name);
            const V2d size(texture.width, texture.height);
            V2d uv[3];
            for (int i = 0; i < 3; ++i)
                uv[i] = V2d(scene_.corner(embree.primitive, i).uv) * size;
            const auto u = static_cast<double>(embree.u);
            const auto v = static_cast<double>(embree.v);
            const V2d at = (1 - u - v) * uv[0] + u * uv[1] + v * uv[2];
            base *= textures_[index].sample(at.x, at.y);
            const double du = std::abs(static_cast<double>(device.u) - u);
            const double dv = std::abs(static_cast<double>(device.v) - v);
            for (int axis = 0; axis < 2; ++axis) {
                const double largest =
                    std::max({std::abs(uv[0][axis]), std::abs(uv[1][axis]), std::abs(uv[2][axis])});
                error += du * std::abs(uv[1][axis] - uv[0][axis]) + dv * std::abs(uv[2][axis] - uv[0][axis]) +
                         8 * ROUNDING * (largest + 1);
            }
        }
        std::array<Value, 3> result;
        for (int c = 0; c < 3; ++c) {
            const auto scale = static_cast<double>(models_[triangle.material].mean_scale[c]);
            result[static_cast<size_t>(c)] = {base[c] * scale, scale * (error + 8 * ROUNDING)};
        }
        return result;
    }

    static std::array<Value, 3> weighted(const Value& rho, const std::array<Value, 3>& r) {
        std::array<Value, 3> result;
        for (size_t c = 0; c < 3; ++c) {
            const double value = r[c].value * rho.value;
            result[c] = {value, r[c].value * rho.error + rho.value * r[c].error + 4 * ROUNDING * value};
        }
        return result;
    }

    using V2d = Imath::V2d;

    const Scene& scene_;
    const RenderSettings& settings_;
    const HitComparison& comparison_;
    double d_max_;
    std::vector<SurfaceModel> models_;
    std::vector<TextureIntegral> textures_;
};

}  // namespace obscura::test
