// SPDX-License-Identifier: Apache-2.0
// The structs of kernels/shared have the same size and member offsets on the host and on the device.
#include <fmt/format.h>

#include <cstddef>

#include "device/launch.h"
#include "device/program.h"
#include "shared/bvh.h"
#include "shared/frame.h"
#include "shared/scene.h"
#include "shared/wavefront.h"
#include "support/device.h"

namespace obscura {
namespace {

using Layout = test::DeviceTest;

// What to ask the device, as an OpenCL C expression, and what the host says.
struct Question {
    std::string expression;
    uint64_t expected;
};

#define SIZE(type)                        \
    Question {                            \
        "sizeof(" #type ")", sizeof(type) \
    }
#define OFFSET(type, member)                                                             \
    Question {                                                                           \
        "(global const uchar*)&((global const " #type "*)memory)->" #member " - memory", \
            offsetof(type, member)                                                       \
    }

const std::vector<Question> QUESTIONS = {
    SIZE(f32x4),
    SIZE(u32x4),

    SIZE(BvhNode),
    OFFSET(BvhNode, bounds),
    OFFSET(BvhNode, child),

    SIZE(TriangleBlock),
    OFFSET(TriangleBlock, vertex),
    OFFSET(TriangleBlock, primitive),

    SIZE(SceneTriangle),
    OFFSET(SceneTriangle, corner),
    OFFSET(SceneTriangle, ids),
    OFFSET(SceneTriangle, normal),
    OFFSET(SceneTriangle, v),

    SIZE(SceneMaterial),
    OFFSET(SceneMaterial, base),
    OFFSET(SceneMaterial, dielectric_f0),
    OFFSET(SceneMaterial, f90),
    OFFSET(SceneMaterial, diffuse_scale),
    OFFSET(SceneMaterial, mean_scale),
    OFFSET(SceneMaterial, emission),
    OFFSET(SceneMaterial, texture),

    SIZE(AreaLight),
    OFFSET(AreaLight, entry),

    SIZE(PointLight),
    OFFSET(PointLight, entry),
    OFFSET(PointLight, position),
    OFFSET(PointLight, direction),
    OFFSET(PointLight, intensity),

    SIZE(Frame),
    OFFSET(Frame, camera_origin),
    OFFSET(Frame, camera_right),
    OFFSET(Frame, camera_up),
    OFFSET(Frame, camera_forward),
    OFFSET(Frame, image),
    OFFSET(Frame, crop),
    OFFSET(Frame, sampling),
    OFFSET(Frame, seed),
    OFFSET(Frame, lattice),
    OFFSET(Frame, lattice_points),
    OFFSET(Frame, obscurance),
    OFFSET(Frame, miss),
    OFFSET(Frame, ambient),
    OFFSET(Frame, background),
    OFFSET(Frame, lights),
    OFFSET(Frame, world_origin),
    OFFSET(Frame, plane),
    SIZE(FilmSum),
    OFFSET(FilmSum, sum),
    OFFSET(FilmSum, excess),
};

#undef SIZE
#undef OFFSET

std::string layout_kernel() {
    std::string text = R"(
#include "shared/bvh.h"
#include "shared/frame.h"
#include "shared/scene.h"
#include "shared/wavefront.h"
kernel void layout(global const uchar* memory, global uint* answers, uint count) {
    if (get_global_id(0) >= count)
        return;
)";
    for (size_t i = 0; i < QUESTIONS.size(); ++i)
        text += fmt::format("    answers[{}] = (uint)({});\n", i, QUESTIONS[i].expression);
    return text + "}\n";
}

TEST_F(Layout, DeviceAgreesWithHostOnSizesAndOffsets) {
    ProgramLibrary library(device());
    const cl::Kernel kernel = library.kernel_from_text("layout", layout_kernel(), "layout");
    const Buffer memory(device(), "memory", "scene", 1024);  // holds any of the structs
    Buffer answers(device(), "answers", "scene", QUESTIONS.size() * sizeof(uint32_t));
    launch(device(), kernel, "layout", 1, library.local_size(), memory, answers, 1u);
    const auto given = answers.contents<uint32_t>();
    for (size_t i = 0; i < QUESTIONS.size(); ++i)
        EXPECT_EQ(given[i], QUESTIONS[i].expected) << QUESTIONS[i].expression;
}

// Arrays of structs are walked with the same stride: what the host writes is what a kernel reads.
TEST_F(Layout, MembersOfArrayElementsArriveWhereTheKernelReadsThem) {
    constexpr const char* SOURCE = R"(
#include "shared/bvh.h"
kernel void probe(global const BvhNode* nodes, global const TriangleBlock* blocks, global float* out, uint count) {
    const uint i = (uint)get_global_id(0);
    if (i >= count)
        return;
    out[3 * i + 0] = nodes[i].bounds[11].w;
    out[3 * i + 1] = (float)nodes[i].child[1].w;
    out[3 * i + 2] = blocks[i].vertex[8].w + (float)blocks[i].primitive.x;
})";
    constexpr uint32_t COUNT = 3;
    std::vector<BvhNode> nodes(COUNT, BvhNode{});
    std::vector<TriangleBlock> blocks(COUNT, TriangleBlock{});
    std::vector<float> expected;
    for (uint32_t i = 0; i < COUNT; ++i) {
        nodes[i].bounds[11].w = 1.5f + static_cast<float>(i);
        nodes[i].child[1].w = 20 + i;
        blocks[i].vertex[8].w = 0.25f;
        blocks[i].primitive.x = 40 + i;
        expected.insert(expected.end(), {1.5f + static_cast<float>(i), 20.0f + static_cast<float>(i),
                                         40.25f + static_cast<float>(i)});
    }
    ProgramLibrary library(device());
    const cl::Kernel kernel = library.kernel_from_text("probe", SOURCE, "probe");
    Buffer out(device(), "out", "scene", 3 * COUNT * sizeof(float));
    launch(device(), kernel, "probe", COUNT, library.local_size(),
           Buffer::holding(device(), "nodes", "bvh", nodes),
           Buffer::holding(device(), "blocks", "bvh", blocks), out, COUNT);
    EXPECT_EQ(out.contents<float>(), expected);
}

}  // namespace
}  // namespace obscura
