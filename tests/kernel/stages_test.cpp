// SPDX-License-Identifier: Apache-2.0
// The table of stages against the kernels: what a launch sets is what the kernel takes, a stage without work touches
// nothing, an item that points out of its queue is reported, not followed, and a render profiles its stages.
#include <algorithm>
#include <fstream>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "support/device.h"
#include "support/kernel_queue.h"
#include "support/render.h"
#include "support/scene_builder.h"

namespace obscura {
namespace {

constexpr uint32_t CAPACITY = 4;
constexpr uint32_t K = 3;

class StageTable : public test::DeviceTest, public testing::WithParamInterface<std::string_view> {
  protected:
    static const StageInfo& row() { return *std::ranges::find(STAGES, GetParam(), &StageInfo::name); }
    test::StageBench bench() {
        test::SceneBuilder builder;
        builder.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, builder.material(test::matte(Rgb(0.5f))));
        RenderSettings settings;
        settings.width = 2;
        settings.height = 2;
        settings.obscurance_rays = K;
        return {device(), builder.finish(), settings, CAPACITY};
    }
    // Item 0 of every queue points to this path slot and to this light sample's result.
    static void point_to(test::StageBench& wave, uint32_t slot, uint32_t result) {
        wave.rays().at(RAY_ORIGIN, 0).w = test::as_float(slot);
        wave.points().at(POINT_POSITION, 0).w = test::as_float(slot);
        wave.shadow_rays().at(SHADOW_ORIGIN, 0).w = test::as_float(result);
    }
};

std::string parameter_name(const cl::Kernel& kernel, cl_uint index) {
    std::string name;
    EXPECT_EQ(kernel.getArgInfo(index, CL_KERNEL_ARG_NAME, &name), CL_SUCCESS);
    return name.c_str();  // without the final zero
}

TEST_P(StageTable, NamesTheParametersOfTheKernelInTheirOrder) {
    const cl::Kernel kernel = bench().kernel(row().stage);
    cl_uint count = 0;
    ASSERT_EQ(kernel.getInfo(CL_KERNEL_NUM_ARGS, &count), CL_SUCCESS);
    ASSERT_LE(count, row().parameters.size());
    for (cl_uint i = 0; i < row().parameters.size(); ++i)
        EXPECT_EQ(row().parameters[i].name, i < count ? parameter_name(kernel, i) : "") << i;
}

TEST_P(StageTable, StageWithoutWorkTouchesNothing) {
    test::StageBench wave = bench();
    point_to(wave, 0, 0);
    wave.start_path(0);
    const auto before = wave.snapshot();
    wave.run(row().stage, {});
    EXPECT_EQ(wave.snapshot(), before);
}

TEST_P(StageTable, KernelAndTestBearItsName) {
    const std::string root = OBSCURA_SOURCE_DIR;
    const std::string name(GetParam());
    EXPECT_TRUE(std::ifstream(root + "/kernels/" + name + ".cl")) << name;
    EXPECT_TRUE(std::ifstream(root + "/tests/kernel/" + name + "_test.cpp")) << name;
}

std::vector<std::string_view> stage_names() {
    std::vector<std::string_view> names;
    for (const StageInfo& info : STAGES)
        names.push_back(info.name);
    return names;
}

INSTANTIATE_TEST_SUITE_P(Stages, StageTable, testing::ValuesIn(stage_names()),
                         [](const auto& stage) { return std::string(stage.param); });

class BadSlot : public StageTable {};

// The slot of the one item lies just beyond the last.
TEST_P(BadSlot, IsReportedNotFollowed) {
    test::StageBench wave = bench();
    point_to(wave, CAPACITY, CAPACITY * wave.light_samples);
    wave.counters[COUNT_SHADOWS] = 1;
    wave.counters[COUNT_POINTS] = 1;
    const auto before = wave.snapshot();
    wave.run(row().stage, {{}, 1, 0});
    EXPECT_EQ(wave.counters[STATUS_CODE], STATUS_BAD_SLOT);
    EXPECT_EQ(wave.counters[STATUS_STAGE], static_cast<uint32_t>(row().stage));
    EXPECT_EQ(wave.counters[STATUS_ITEM], 0u);
    wave.counters[STATUS_CODE] = wave.counters[STATUS_STAGE] = STATUS_OK;
    EXPECT_EQ(wave.snapshot(), before);
}

INSTANTIATE_TEST_SUITE_P(Stages, BadSlot, testing::Values("shade", "shadow", "obscurance"),
                         [](const auto& stage) { return std::string(stage.param); });

class Profile : public test::DeviceTest {
  protected:
    // Inside a glowing box.
    static RenderResult render_box(const Material& material) {
        test::SceneBuilder builder;
        builder.box({-1, -1, -1}, {1, 1, 1}, builder.material(material), true);
        return test::render(builder.finish(), test::picture(4, 4, 2, K));
    }
    static std::set<std::string_view> rows(const RenderResult& result) {
        std::set<std::string_view> names;
        for (const auto& [name, row] : result.profile)
            names.insert(name);
        return names;
    }
};

TEST_F(Profile, HasTheRowsOfTheNeededStages) {
    Material mirror = test::metal(Rgb(0.9f), 0);
    for (const Material& material : {test::matte(Rgb(0.5f)), test::matte(Rgb(0.5f), Rgb(1)), mirror}) {
        const RenderResult result = render_box(material);
        std::set<std::string_view> expected;
        for (const Stage stage : needed_stages(result.needs)) {
            expected.insert(stage_info(stage).row(0));
            if (result.rays.glossy > 0) expected.insert(stage_info(stage).row(1));
        }
        EXPECT_EQ(rows(result), expected);
    }
    EXPECT_GT(render_box(mirror).rays.glossy, 0u);
}

TEST_F(Profile, CountsTheRaysTraced) {
    Material glossy = test::metal(Rgb(0.9f), 0.5f);
    glossy.metallic = 0.5f;
    glossy.emission = Rgb(1);
    const RenderResult result = render_box(glossy);
    EXPECT_EQ(result.profile.at("trace_camera").items, result.rays.camera);
    EXPECT_EQ(result.profile.at("trace_glossy").items, result.rays.glossy);
    EXPECT_EQ(result.profile.at("shadow").items, result.rays.shadow);
    EXPECT_EQ(result.profile.at("obscurance").items, result.rays.obscurance);
    EXPECT_GT(result.rays.shadow, 0u);
    EXPECT_GT(result.rays.obscurance, 0u);
}

constexpr const char* LIGHT_SAMPLES_SOURCE = R"(
#include "lib/layers.clh"
kernel void light_samples(global const Frame* frame, global uint* out, uint count) {
    if (get_global_id(0) < count) out[0] = light_sample_count(frame);
})";

class LightSamples : public test::DeviceTest {};

// The host sizes the queues by that number, the kernels index them by it.
TEST_F(LightSamples, AreCountedAlikeByHostAndKernels) {
    RenderSettings settings;
    settings.light_samples = 3;
    Frame frame{};
    frame.sampling.z = settings.light_samples;
    const Buffer frame_buffer = Buffer::holding(device(), "frame", "test", std::span(&frame, 1));
    Buffer out(device(), "out", "test", sizeof(uint32_t));
    ProgramLibrary library(device());
    for (const bool area : {false, true}) {
        for (const bool punctual : {false, true}) {
            Needs needs;
            needs.area_lights = area;
            needs.directional_lights = punctual;
            for (const Stage stage : {Stage::shade, Stage::shadow, Stage::gather}) {
                const cl::Kernel kernel =
                    library.kernel_from_text("light_samples", LIGHT_SAMPLES_SOURCE, "light_samples",
                                             stage_options(stage, needs, false, false));
                launch(device(), kernel, "light_samples", 1, library.local_size(), frame_buffer, out, 1u);
                EXPECT_EQ(out.contents<uint32_t>()[0], queue_shape(needs, settings, 0).light_samples)
                    << stage_info(stage).name << " with area lights " << area << ", punctual lights "
                    << punctual;
            }
        }
    }
}

}  // namespace
}  // namespace obscura
