// SPDX-License-Identifier: Apache-2.0
// Every ray of the kitchen at the paper's settings, as the render itself traces it, against Embree: hit or miss,
// triangle, distance. Every difference is judged by the brute force (support/hit_comparison.h states the bounds).
// What the stage obscurance made of each hit is compared with R(Q) rho(d) in double from Embree's hit.
// OBSCURA_CONFORMANCE_SCENE names another scene to check. The last tests plant errors, and want them found.
#include "base/file.h"
#include "bvh/layout.h"
#include "device/kernel_source.h"
#include "scene/gltf.h"
#include "support/capture.h"
#include "support/device.h"
#include "support/hit_comparison.h"
#include "support/rays.h"
#include "support/result_comparison.h"
#include "support/scene_builder.h"
#include "support/temporary_folder.h"
#include "wavefront/render.h"

#include <fmt/format.h>

#include <cstdlib>

namespace obscura {
namespace {

using test::CapturedRays;
using test::HitComparison;
using test::ResultComparison;
using test::ResultTally;
using test::Tally;

struct Report {
    Tally camera, glossy, obscurance;
    ResultTally results;
    RayCounts counts;  // of the render

    std::string table() const {
        std::string text =
            Tally::header() + camera.row("camera") + glossy.row("glossy") + obscurance.row("obscurance");
        text += fmt::format(
            "obscurance results: {} compared, largest difference {:.2e}, {:.3f} of what rounding explains; "
            "{} rays "
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
    const ResultComparison results(scene, settings, comparison);
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
        report.results.add(results.compare(gathered, embree, frame));
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
    const Scene scene =
        load_gltf(find_scene_file(other != nullptr ? other : OBSCURA_SOURCE_DIR "/scenes/kitchen"));
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

// A small room with a bit of everything: shapes in reach of each other, a ball, a texture, a lamp, a mirror.
Scene small_room() {
    test::SceneBuilder builder;
    Texture texture{"checks", 2, 2, Wrap::repeat, Wrap::repeat, TextureFilter::linear, {}};
    for (const int code : {250, 40, 40, 250})
        texture.rgba.insert(texture.rgba.end(), {static_cast<uint8_t>(code), 128, 60, 255});
    Material checks = test::matte(Rgb(0.9f));
    checks.base_color_texture = builder.texture(texture);
    const uint32_t grey = builder.material(test::matte(Rgb(0.6f)));
    const uint32_t floor = builder.material(checks);
    const uint32_t mirror = builder.material(test::metal(Rgb(0.9f), 0));
    builder.box({-2, 0, -2}, {2, 2.5f, 2}, grey, true);
    builder.quad({-1.9f, 0.01f, 1.9f}, {3.8f, 0, 0}, {0, 0, -3.8f}, floor);
    builder.box({-1.5f, 0.02f, -1.5f}, {-0.5f, 0.8f, -0.5f}, grey);
    builder.box({0.1f, 0.02f, -1}, {0.9f, 0.3f, -0.2f}, mirror);
    builder.sphere({0.5f, 0.7f, -0.6f}, 0.35f, 3, builder.material(test::matte(Rgb(0.8f, 0.3f, 0.2f))));
    builder.quad({-0.5f, 2.45f, -0.5f}, {1, 0, 0}, {0, 0, 1},
                 builder.material(test::matte(Rgb(0.5f), Rgb(5))));
    builder.camera({0, 1.4, 1.9}, {0, 0.6, -0.8});
    return builder.finish();
}

// The program's kernels with one function replaced by another that calls it, as correct_<name>. Built programs go to a
// folder of their own, not to the user's cache.
class PlantedError {
  public:
    PlantedError(const std::string& file, const std::string& function, const std::string& replacement) {
        for (const EmbeddedFile& source : embedded_kernel_files()) {
            const std::filesystem::path path = folder_.path() / source.path;
            std::filesystem::create_directories(path.parent_path());
            std::string text(source.text);
            if (source.path == file) {
                text = fmt::format(
                    "#ifndef PLANTED_ERROR\n#define PLANTED_ERROR\n#define {0} correct_{0}\n{1}\n"
                    "#undef {0}\n{2}\n#endif\n",
                    function, text, replacement);
            }
            write_text(path, text);
        }
    }

  private:
    test::TemporaryFolder folder_;
    test::ScopedVariable kernels_{"OBSCURA_KERNEL_DIR", folder_.path().string()};
};

// traverse() that calls the correct one with this reach and does this to its hit.
PlantedError wrong_traversal(const std::string& reach, const std::string& change) {
    return {
        "lib/traverse.clh", "traverse",
        fmt::format("inline Hit traverse(global const BvhNode* nodes, global const TriangleBlock* blocks, "
                    "float3 origin, float3 direction, float t_max, const bool any_hit) {{\n"
                    "    Hit hit = correct_traverse(nodes, blocks, origin, direction, {}, any_hit);\n"
                    "    if (hit.primitive != NO_PRIMITIVE) {{ {} }}\n    return hit;\n}}",
                    reach, change)};
}

class SmallRoomRays : public test::DeviceTest {
  protected:
    SmallRoomRays() {
        settings_.width = 64;
        settings_.height = 48;
        settings_.spp = 4;
    }
    Report report() { return check_render(device(), scene_, settings_); }

    Scene scene_ = small_room();
    RenderSettings settings_;
    test::TemporaryFolder cache_;
    test::ScopedVariable cache_variable_{"OBSCURA_CACHE_DIR", cache_.path().string()};
};

TEST_F(SmallRoomRays, AgreeWithEmbreeUnlessAnErrorIsPlanted) {
    const Report correct = report();
    EXPECT_EQ(correct.camera.device_wrong + correct.glossy.device_wrong + correct.obscurance.device_wrong,
              0U);
    EXPECT_LE(correct.results.worst_share, 1);
    EXPECT_GT(correct.results.checked, 10000U);
    EXPECT_GT(correct.glossy.rays, 100U);
    {
        const PlantedError planted =
            wrong_traversal("t_max", "if ((hit.primitive & 1u) != 0u) hit.primitive = NO_PRIMITIVE;");
        const Report lost = report();
        EXPECT_GT(lost.camera.device_wrong, 1000U) << "every other triangle is never hit";
        EXPECT_GT(lost.obscurance.device_wrong, 1000U);
    }
    {
        const PlantedError planted = wrong_traversal("t_max", "hit.primitive ^= 1u;");
        const Report shifted = report();
        EXPECT_GT(shifted.camera.device_wrong, shifted.camera.hits * 9 / 10) << "the triangle's neighbour";
        EXPECT_GT(shifted.obscurance.device_wrong, shifted.obscurance.hits * 9 / 10);
    }
    {
        const PlantedError planted = wrong_traversal("INFINITY", "");
        const Report unlimited = report();
        EXPECT_EQ(unlimited.camera.device_wrong, 0U) << "camera rays have no limit";
        EXPECT_GT(unlimited.obscurance.device_wrong, 1000U) << "hits beyond the reach";
    }
    {
        const PlantedError planted = wrong_traversal("t_max", "hit.t *= 1.00001f;");
        EXPECT_GT(report().camera.device_wrong, 1000U) << "distances too long by 1e-5";
    }
    {
        const PlantedError planted(
            "lib/falloff.clh", "falloff",
            "inline float falloff(uint kind, float t, float parameter, float inv_norm) {\n"
            "    return 1.001f * correct_falloff(kind, t, parameter, inv_norm);\n}");
        const Report brighter = report();
        EXPECT_EQ(brighter.obscurance.device_wrong, 0U);
        EXPECT_GT(brighter.results.worst_share, 10) << "rho too large by a thousandth";
    }
}

// A tree that lost the last triangle of each full leaf block still gives a picture, but not to the judge.
TEST_F(SmallRoomRays, EmptiedLeafSlotsAreNoticed) {
    const HitComparison comparison(scene_);
    const std::vector<TraceRay> rays = test::random_rays(scene_, 20000, 1);
    const std::vector<TraceHit> embree = comparison.embree(rays);
    Bvh bvh = build_bvh(scene_);
    const auto device_wrong = [&] {
        return comparison.compare(rays, test::DeviceTracer(device(), bvh).closest(rays), embree).device_wrong;
    };
    EXPECT_EQ(device_wrong(), 0U);
    const V3f nowhere(0, 0, 0);
    for (TriangleBlock& block : bvh.blocks)
        set_triangle(block, BLOCK_WIDTH - 1, NO_PRIMITIVE, {nowhere, nowhere, nowhere});
    EXPECT_GT(device_wrong(), 50U);
}

}  // namespace
}  // namespace obscura
