// SPDX-License-Identifier: Apache-2.0
// The padding of the boxes' far planes: what a ray finds through the tree is what it finds by trying every block of
// triangles, with the same triangle test. Rays aimed at the rims of plates, whose boxes are flat and end where the
// plates end, tell a tree without enough padding.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "bvh/bvh.h"
#include "bvh/layout.h"
#include "device/launch.h"
#include "device/program.h"
#include "reference/hard_rays.h"
#include "reference/meshes.h"
#include "support/device.h"
#include "support/temporary_folder.h"

namespace obscura {
namespace {

// Counts rays whose closest hit differs, in one word per work item.
constexpr const char* PROBE = R"(
#include "lib/traverse.clh"
kernel void probe(global const BvhNode* nodes, global const TriangleBlock* blocks, global const float4* rays,
                  global uint* differs, uint block_count, uint count) {
    const uint i = (uint)get_global_id(0);
    if (i >= count) return;
    const float3 origin = rays[2u * i].xyz;
    const float3 direction = rays[2u * i + 1u].xyz;
    const Hit found = traverse(nodes, blocks, origin, direction, INFINITY, false);
    const Shear shear = make_shear(origin, direction);
    Hit nearest;
    nearest.t = INFINITY;
    nearest.primitive = 0u;
    for (uint block = 0u; block < block_count; ++block)
        intersect_block(blocks + block, &shear, &nearest, INFINITY, false);
    if (nearest.t == INFINITY) nearest.primitive = NO_PRIMITIVE;
    differs[i] = found.primitive != nearest.primitive || found.t != nearest.t ? 1u : 0u;
})";

// Fans of four triangles, small and far apart, so that each fills a leaf: seven plates in planes of the axes for every
// one in general position.
Scene plates(uint32_t count) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(0, 1);
    const auto point = [&] {
        const float x = unit(random), y = unit(random), z = unit(random);
        return V3f(x, y, z);
    };
    MeshBuilder mesh;
    for (uint32_t i = 0; i < count; ++i) {
        const V3f a = point();
        V3f u = 0.02f * point(), v = 0.02f * point();
        if (i % 8 != 7) {
            const int axis = static_cast<int>(i % 3);
            u[axis] = v[axis] = u[(axis + 1) % 3] = v[(axis + 2) % 3] = 0;
        }
        const V3f corners[] = {a, a + u, a + u + v, a + v};
        for (size_t corner = 0; corner < 4; ++corner)
            mesh.triangle(a + 0.5f * (u + v), corners[corner], corners[(corner + 1) % 4]);
    }
    return mesh.finish();
}

// Share of the leaves' boxes that are flat.
double flat_share(const Bvh& bvh) {
    size_t flat = 0, all = 0;
    for (const BvhNode& node : bvh.nodes) {
        for (size_t child = 0; child < BVH_WIDTH; ++child) {
            const uint32_t reference = child_reference(node, child);
            if (reference == BVH_EMPTY_CHILD || !is_leaf_reference(reference)) continue;
            const V3f size = child_bounds(node, child).size();
            flat += size.x == 0 || size.y == 0 || size.z == 0 ? 1 : 0;
            ++all;
        }
    }
    return static_cast<double>(flat) / static_cast<double>(all);
}

// The kernels' sources with one expression of the box test replaced.
class ChangedTraversal {
  public:
    ChangedTraversal(const std::string& expression, const std::string& replacement)
        : use_("OBSCURA_KERNEL_DIR", folder_.path().string()) {
        namespace fs = std::filesystem;
        fs::copy(fs::path(OBSCURA_SOURCE_DIR) / "kernels", folder_.path(), fs::copy_options::recursive);
        const fs::path file = folder_.path() / "lib" / "intersect.clh";
        std::string text;
        {
            std::ifstream in(file);
            text.assign(std::istreambuf_iterator<char>(in), {});
        }
        const size_t at = text.find(expression);
        EXPECT_NE(at, std::string::npos) << expression;
        if (at != std::string::npos) text.replace(at, expression.size(), replacement);
        std::ofstream(file) << text;
    }

  private:
    test::TemporaryFolder folder_;
    test::ScopedVariable use_;
};

class SlabRounding : public test::DeviceTest {
  protected:
    // Rays of `count` that find something else through the tree.
    size_t false_answers(size_t count, const std::string& options = "") {
        const Scene scene = plates(100);
        const Bvh bvh = build_bvh(scene);
        EXPECT_GE(flat_share(bvh), 0.75);
        ProgramLibrary library(device());
        const cl::Kernel kernel = library.kernel_from_text("slab probe", PROBE, "probe", options);
        const Buffer nodes = Buffer::holding(device(), "nodes", "test", bvh.nodes);
        const Buffer blocks = Buffer::holding(device(), "blocks", "test", bvh.blocks);
        std::vector<f32x4> lanes;
        for (const TraceRay& ray : edge_rays(scene, count, 2)) {
            lanes.push_back({ray.origin.x, ray.origin.y, ray.origin.z, 0});
            lanes.push_back({ray.direction.x, ray.direction.y, ray.direction.z, 0});
        }
        const auto ray_count = static_cast<uint32_t>(lanes.size() / 2);
        EXPECT_EQ(ray_count, count);
        const Buffer rays = Buffer::holding(device(), "rays", "test", lanes);
        const Buffer differs(device(), "differs", "test", ray_count * sizeof(uint32_t));
        const auto block_count = static_cast<uint32_t>(bvh.blocks.size());
        launch(device(), kernel, "slab probe", ray_count, library.local_size(), nodes, blocks, rays, differs,
               block_count, ray_count);
        size_t sum = 0;
        for (const uint32_t one : differs.contents<uint32_t>())
            sum += one;
        return sum;
    }
};

TEST_F(SlabRounding, EdgeRaysMissNoTriangleOfAnyBuild) {
    EXPECT_EQ(false_answers(4'000'000), 0U);
    EXPECT_EQ(false_answers(4'000'000, "-D OBSCURA_PORTABLE"), 0U);
}

TEST_F(SlabRounding, PaddingIsNeeded) {
    const ChangedTraversal unpadded("(1.0f + 2.0f * GAMMA(9))", "1.0f");
    EXPECT_GT(false_answers(1'000'000), 0U);
}

// As far as OpenCL allows a reciprocal to be wrong: 2.5 ulp, of another sign for each axis of each ray.
constexpr const char* WRONG_RECIPROCAL =
    "(1.0f / direction) * (1.0f + 2.0f * 1.1920929e-7f * "
    "(float3)(as_uint(direction.x) & 1u ? 1.0f : -1.0f, as_uint(direction.y) & 1u ? 1.0f : -1.0f, "
    "as_uint(direction.z) & 1u ? 1.0f : -1.0f))";

TEST_F(SlabRounding, ReciprocalsOffByTwoAndAHalfUlpMissNothing) {
    const ChangedTraversal wrong("1.0f / direction", WRONG_RECIPROCAL);
    EXPECT_EQ(false_answers(1'000'000), 0U);
    EXPECT_EQ(false_answers(1'000'000, "-D OBSCURA_PORTABLE"), 0U);
}

}  // namespace
}  // namespace obscura
