// SPDX-License-Identifier: Apache-2.0
// Rays that leave a surface don't hit it again, nor the neighbours that go on in its plane or fold away from it, near
// the world's origin and far from it; and what hovers just above is still seen.
#include <gtest/gtest.h>

#include "bvh/bvh.h"
#include "device/launch.h"
#include "device/program.h"
#include "device/scene_buffers.h"
#include "reference/meshes.h"
#include "support/device.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

namespace obscura {
namespace {

// One item: a ray hits a random point from `reach` away, and another leaves from there to that side, all directions
// equally likely. Answers: 0 nothing hit, 1 the leaving ray is free, 2 it hits something.
constexpr const char* PROBE = R"(
#include "lib/surface.clh"
#include "lib/traverse.clh"

inline float next_uniform(uint* state) {
    *state = *state * 747796405u + 2891336453u;
    const uint word = ((*state >> ((*state >> 28) + 4u)) ^ *state) * 277803737u;
    return (float)(((word >> 22) ^ word) >> 8) * 5.9604645e-8f;
}

inline float3 towards(float3 n, float cosine, float phi) {
    float3 tangent, bitangent;
    make_basis(n, &tangent, &bitangent);
    const float sine = sqrt(fmax(0.0f, 1.0f - cosine * cosine));
    return cosine * n + sine * (cos(phi) * tangent + sin(phi) * bitangent);
}

kernel void probe(global const BvhNode* nodes, global const TriangleBlock* blocks,
                  global const SceneTriangle* triangles, global uint* answers, uint triangle_count, uint count,
                  float reach, float least_cosine) {
    const uint i = (uint)get_global_id(0);
    if (i >= count) return;
    uint state = i * 2654435761u;
    global const SceneTriangle* aim = triangles + min((uint)(next_uniform(&state) * (float)triangle_count), triangle_count - 1u);
    float u = next_uniform(&state);
    float v = next_uniform(&state);
    if (u + v > 1.0f) { u = 1.0f - u; v = 1.0f - v; }
    const float3 target = interpolate_position(aim, hit_weights(u, v));
    const float from = 0.3f + 0.7f * next_uniform(&state);
    const float3 back = towards(triangle_normal(aim), from, 2.0f * PI * next_uniform(&state));
    const float3 origin = target + reach * back;
    const Hit hit = traverse(nodes, blocks, origin, -back, INFINITY, false);
    answers[i] = 0u;
    if (hit.primitive == NO_PRIMITIVE) return;
    const Surface s = make_surface(triangles + hit.primitive, hit.u, hit.v, -back);
    const float cosine = least_cosine + (1.0f - least_cosine) * next_uniform(&state);
    const float3 direction = towards(s.n_geo, cosine, 2.0f * PI * next_uniform(&state));
    const Hit again = traverse(nodes, blocks, s.position + s.offset * s.n_geo, direction, INFINITY, false);
    answers[i] = again.primitive == NO_PRIMITIVE ? 1u : 2u;
})";

// Coordinates that stay exact up to 10^6 m from the origin, so that moving the mesh doesn't bend it.
Scene lone_triangle(float offset) {
    const V3f at(offset, -offset, offset);
    MeshBuilder mesh;
    mesh.triangle(at, at + V3f(1, 0, 0.5f), at + V3f(0.25f, 1, 0));
    return mesh.finish();
}

// 2 * 16^2 triangles in the plane z = x + 2 y.
Scene plane_grid(float offset) {
    constexpr uint32_t SIDE = 16;
    MeshBuilder mesh;
    for (uint32_t y = 0; y <= SIDE; ++y) {
        for (uint32_t x = 0; x <= SIDE; ++x) {
            const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
            mesh.vertex(V3f(offset + fx, -offset + fy, offset + fx + 2 * fy));
        }
    }
    for (uint32_t y = 0; y < SIDE; ++y) {
        for (uint32_t x = 0; x < SIDE; ++x) {
            const uint32_t corner = y * (SIDE + 1) + x;
            mesh.triangle(corner, corner + 1, corner + SIDE + 2);
            mesh.triangle(corner, corner + SIDE + 2, corner + SIDE + 1);
        }
    }
    return mesh.finish();
}

// Large enough to stay convex where coordinates are multiples of 1/16 m.
Scene sphere(float offset) {
    return icosphere(2, 8, V3f(offset, -offset, offset));
}

// Two floors at the height of 1 m; the upper one, which is larger, goes on over the rim of the lower.
Scene sheets(float gap) {
    MeshBuilder mesh;
    for (const auto& [y, low, high] : {std::array{1.0f, 0.75f, 1.25f}, std::array{1.0f + gap, 0.5f, 1.5f}}) {
        const V3f corners[] = {{low, y, low}, {low, y, high}, {high, y, high}, {high, y, low}};
        mesh.triangle(corners[0], corners[1], corners[2]);
        mesh.triangle(corners[0], corners[2], corners[3]);
    }
    return mesh.finish();
}

struct Answers {
    size_t lost = 0, free = 0, blocked = 0;
};

class SelfIntersection : public test::DeviceTest {
  protected:
    // aimed: the first triangles of the scene, which are those that rays are aimed at.
    Answers spawn(const Scene& scene, uint32_t aimed, float reach, float least_cosine) {
        constexpr uint32_t COUNT = 1'200'000;
        ProgramLibrary library(device());
        const cl::Kernel kernel = library.kernel_from_text("leaving rays", PROBE, "probe");
        const SceneBuffers buffers =
            upload_scene(device(), make_scene_arrays(scene, PixelFilter::box), build_bvh(scene));
        const Buffer answers(device(), "answers", "test", COUNT * sizeof(uint32_t));
        launch(device(), kernel, "leaving rays", COUNT, library.local_size(), buffers.nodes, buffers.blocks,
               buffers.triangles, answers, aimed, COUNT, reach, least_cosine);
        Answers sum;
        for (const uint32_t answer : answers.contents<uint32_t>())
            ++(answer == 0 ? sum.lost : answer == 1 ? sum.free : sum.blocked);
        return sum;
    }
};

TEST_F(SelfIntersection, LeavingRaysDoNotComeBack) {
    for (const auto& [name, make] : {std::pair{"triangle", &lone_triangle}, std::pair{"grid", &plane_grid},
                                     std::pair{"sphere", &sphere}}) {
        for (const float offset : {0.0f, 10.0f, 1e3f, 1e4f, 1e5f, 1e6f}) {
            const Scene scene = make(offset);
            const Answers answers = spawn(scene, static_cast<uint32_t>(scene.triangles.size()), 4, 0);
            EXPECT_EQ(answers.blocked, 0U) << name << ", " << offset << " m off";
            EXPECT_GT(answers.free, 1'000'000U) << name << ", " << offset << " m off";
        }
    }
}

TEST_F(SelfIntersection, SheetsCloseTogetherSeeEachOther) {
    constexpr float GAP = 4e-5f;
    const Answers answers = spawn(sheets(GAP), 2, GAP / 2, 0.05f);
    EXPECT_EQ(answers.free, 0U);
    EXPECT_GT(answers.blocked, 1'150'000U);
}

}  // namespace
}  // namespace obscura
