// SPDX-License-Identifier: Apache-2.0
// Every ray of the kitchen at the paper's settings, as the render itself traces it, against Embree: hit or miss,
// triangle, distance. Every difference is judged by the brute force (support/hit_comparison.h states the bounds).
// What the stage obscurance made of each hit is compared with R(Q) rho(d) in double from Embree's hit.
// OBSCURA_CONFORMANCE_SCENE names another scene to check. The last tests plant errors, and want them found.
#include "device/kernel_source.h"
#include "scene/gltf.h"
#include "scene/material.h"
#include "scene/texture.h"
#include "support/capture.h"
#include "support/device.h"
#include "support/hit_comparison.h"
#include "support/scene_builder.h"
#include "wavefront/render.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <fstream>

namespace obscura {
namespace {

using test::CapturedRays;
using test::HitComparison;
using test::Tally;

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

// R(Q) rho(d) of a hit, in double.
class ObscuranceOracle {
  public:
    ObscuranceOracle(const Scene& scene, const RenderSettings& settings, const HitComparison& comparison)
        : scene_(scene),
          settings_(settings),
          comparison_(comparison),
          d_max_(resolve_max_distance(settings.d_max, scene.bounds)) {
        for (const Material& material : scene.materials) models_.push_back(surface_model(material));
        for (const Texture& texture : scene.textures) textures_.emplace_back(texture);
    }

    ResultTally compare(const CapturedRays& captured, const std::vector<TraceHit>& embree, const Frame& frame) const {
        return tbb::parallel_reduce(
            tbb::blocked_range<size_t>(0, captured.rays.size(), 4096), ResultTally{},
            [&](const auto& range, ResultTally tally) {
                for (size_t i = range.begin(); i < range.end(); ++i) compare_one(captured, i, embree[i], frame, tally);
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
            expected = {Value{static_cast<double>(frame.miss.x), 0}, Value{static_cast<double>(frame.miss.y), 0},
                        Value{static_cast<double>(frame.miss.z), 0}};
        } else {
            const Material& material = scene_.materials[scene_.triangles[embree.primitive].material];
            if (material.transmission > 0) {
                ++tally.behind_panes;
                return;
            }
            colourless = falloff(captured.rays[i], captured.starts[i], embree);
            expected = weighted(colourless, reflectivity(captured.hits[i], embree));
        }
        ++tally.checked;
        const float given[] = {result.x, result.y, result.z};
        for (size_t c = 0; c < 3; ++c) note(given[c], expected[c], tally);
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
        const double error = (2 * comparison_.distance(ray, embree.primitive).bound + 8 * ROUNDING * d) / d_max_;
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
            for (int i = 0; i < 3; ++i) uv[i] = V2d(scene_.corner(embree.primitive, i).uv) * size;
            const auto u = static_cast<double>(embree.u);
            const auto v = static_cast<double>(embree.v);
            const V2d at = (1 - u - v) * uv[0] + u * uv[1] + v * uv[2];
            base *= textures_[index].sample(at.x, at.y);
            const double du = std::abs(static_cast<double>(device.u) - u);
            const double dv = std::abs(static_cast<double>(device.v) - v);
            for (int axis = 0; axis < 2; ++axis) {
                const double largest = std::max({std::abs(uv[0][axis]), std::abs(uv[1][axis]), std::abs(uv[2][axis])});
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

struct Report {
    Tally camera, glossy, obscurance;
    ResultTally results;
    RayCounts counts;  // of the render

    std::string table() const {
        std::string text = Tally::header() + camera.row("camera") + glossy.row("glossy") + obscurance.row("obscurance");
        text += fmt::format(
            "obscurance results: {} compared, largest difference {:.2e}, {:.3f} of what rounding explains; {} rays "
            "meet a pane first, {} disputed triangles\n",
            results.checked, results.worst, results.worst_share, results.behind_panes, results.disputed);
        constexpr size_t SHOWN = 8;
        for (const Tally* tally : {&camera, &glossy, &obscurance}) {
            for (size_t i = 0; i < std::min(SHOWN, tally->disagreements.size()); ++i)
                text += tally->disagreements[i].text() + "\n";
        }
        return text;
    }
};

// Renders the scene and checks every ray, wave by wave.
Report check_render(Device& device, const Scene& scene, const RenderSettings& settings) {
    const HitComparison comparison(scene);
    const ObscuranceOracle oracle(scene, settings, comparison);
    test::RayCapture capture(device, scene);
    Report report;
    RenderJob job{scene, settings, {}};
    job.observer = [&](const DepthView& view, const Frame& frame, const Queues& queues) {
        const CapturedRays traced = capture.traced(view, frame, queues);
        Tally& tally = view.depth == 0 ? report.camera : report.glossy;
        tally.add(comparison.compare(traced.rays, traced.hits, comparison.embree(traced.rays)));

        const CapturedRays gathered = capture.obscurance(view, frame, queues);
        const std::vector<TraceHit> embree = comparison.embree(gathered.rays);
        report.obscurance.add(comparison.compare(gathered.rays, gathered.hits, embree));
        report.results.add(oracle.compare(gathered, embree, frame));
    };
    ProgramLibrary library(device);
    report.counts = render_scene(device, library, job, [](double, const RayCounts&) { return true; }).rays;
    return report;
}

void expect_conformance(const Tally& tally, const char* name) {
    EXPECT_EQ(tally.device_wrong, 0U) << name;
    EXPECT_LT(static_cast<double>(tally.tie + tally.edge), 1e-4 * static_cast<double>(tally.rays)) << name;
    EXPECT_LE(tally.worst_share, 1) << name;
}

using KitchenRays = test::DeviceTest;

TEST_F(KitchenRays, AgreeWithEmbreeAtThePapersSettings) {
    const char* const other = std::getenv("OBSCURA_CONFORMANCE_SCENE");
    const Scene scene = load_gltf(find_scene_file(other != nullptr ? other : OBSCURA_SOURCE_DIR "/scenes/kitchen"));
    const RenderSettings settings;
    const Report report = check_render(device(), scene, settings);
    fmt::print("{}", report.table());
    expect_conformance(report.camera, "camera");
    expect_conformance(report.glossy, "glossy");
    expect_conformance(report.obscurance, "obscurance");
    EXPECT_EQ(report.camera.rays, uint64_t{settings.width} * settings.height * settings.spp);
    EXPECT_EQ(report.glossy.rays, report.counts.glossy);
    EXPECT_EQ(report.obscurance.rays, report.counts.obscurance);
    EXPECT_GT(report.results.checked, report.obscurance.rays / 2);
    EXPECT_LE(report.results.worst_share, 1);
}

}  // namespace
}  // namespace obscura
