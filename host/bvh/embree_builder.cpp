// SPDX-License-Identifier: Apache-2.0
// The binary tree through rtcBuildBVH, down to small sets, which are cut exactly. Embree's SAH counts whole
// blocks of four, so that it prefers cuts that leave multiples of four on both sides; with spatial splits it
// cuts long triangles at planes, through split_part(). Its nodes are then laid out depth first.
#include "bvh/binary_tree.h"

#include "base/error.h"
#include "bvh/clip.h"
#include "bvh/parts.h"
#include "bvh/reinsertion.h"
#include "bvh/split_bounds.h"

#include <embree3/rtcore.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <memory>
#include <new>
#include <type_traits>

namespace obscura {
namespace {

// Room for the parts that spatial splits add, as a fraction of the number of triangles. A furnished room
// uses a twentieth of it; soups of long thin triangles use most, and their SAH cost falls by a third.
constexpr double SPLIT_ROOM = 1.0;

// Embree stops at this many references (its limit) and fill_swept_subtree() goes on: trying every cut of so
// few is quicker than binning them, and the tree is better.
constexpr uint32_t SMALL_SET = RTC_BUILD_MAX_PRIMITIVES_PER_LEAF;

// What the callbacks build, in Embree's memory.
struct BuildNode {
    std::array<BuildNode*, 2> child{};        // of an inner node
    RTCBuildPrimitive* primitives = nullptr;  // of a leaf
    uint32_t count = 0;
};

void* create_node(RTCThreadLocalAllocator allocator, unsigned int child_count, void*) {
    OBSCURA_CHECK(child_count == 2, "Embree made a node of {} children", child_count);
    return new (rtcThreadLocalAlloc(allocator, sizeof(BuildNode), alignof(BuildNode))) BuildNode;
}

void set_children(void* node, void** children, unsigned int child_count, void*) {
    for (unsigned int i = 0; i < child_count; ++i)
        static_cast<BuildNode*>(node)->child[i] = static_cast<BuildNode*>(children[i]);
}

void ignore_bounds(void*, const RTCBounds**, unsigned int, void*) {}  // computed by flatten()

void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, size_t count,
                  void*) {
    auto* const leaf = new (rtcThreadLocalAlloc(allocator, sizeof(BuildNode), alignof(BuildNode))) BuildNode;
    leaf->primitives = static_cast<RTCBuildPrimitive*>(
        rtcThreadLocalAlloc(allocator, count * sizeof(RTCBuildPrimitive), alignof(RTCBuildPrimitive)));
    leaf->count = static_cast<uint32_t>(count);
    std::uninitialized_copy_n(primitives, count, leaf->primitives);
    return leaf;
}

Box3f box_of(const RTCBuildPrimitive& primitive) {
    return {V3f(primitive.lower_x, primitive.lower_y, primitive.lower_z),
            V3f(primitive.upper_x, primitive.upper_y, primitive.upper_z)};
}

void store(const Box3f& box, RTCBounds& bounds) {
    bounds = {box.min.x, box.min.y, box.min.z, 0, box.max.x, box.max.y, box.max.z, 0};
}

// The innermost function of a build with spatial splits: user points to the vertices of all triangles, which
// lie closer together than the scene's.
void split_part(const RTCBuildPrimitive* primitive, unsigned int axis, float position, RTCBounds* left,
                RTCBounds* right, void* user) {
    const Vertices& vertices = static_cast<const Vertices*>(user)[primitive->primID];
    const SplitBounds parts = split_bounds(vertices, box_of(*primitive), static_cast<int>(axis), position);
    store(parts.below, *left);
    store(parts.above, *right);
}

std::vector<RTCBuildPrimitive> build_primitives(const std::vector<Vertices>& vertices) {
    std::vector<RTCBuildPrimitive> primitives(vertices.size());
    for (uint32_t i = 0; i < vertices.size(); ++i) {
        const Box3f box = bounds_of(vertices[i]);
        primitives[i] = {box.min.x, box.min.y, box.min.z, 0, box.max.x, box.max.y, box.max.z, i};
    }
    return primitives;
}

RTCBuildQuality embree_quality(BvhQuality quality) {
    switch (quality) {
        case BvhQuality::low:
            return RTC_BUILD_QUALITY_LOW;
        case BvhQuality::medium:
            return RTC_BUILD_QUALITY_MEDIUM;
        case BvhQuality::high:
            return RTC_BUILD_QUALITY_HIGH;
    }
    return RTC_BUILD_QUALITY_HIGH;
}

// A leaf of Embree's tree and where its subtree goes.
struct Leaf {
    const BuildNode* source;
    uint32_t node, first;
};

// Lays Embree's nodes and leaves out depth first, from the next node and reference on. Returns the number of references.
uint32_t lay_out(const BuildNode& source, uint32_t first, BinaryTree& tree, std::vector<Leaf>& leaves) {
    const auto node = static_cast<uint32_t>(tree.nodes.size());
    if (source.primitives != nullptr) {
        leaves.push_back({&source, node, first});
        tree.nodes.resize(node + node_count(source.count));
        return source.count;
    }
    tree.nodes.emplace_back();
    uint32_t count = lay_out(*source.child[0], first, tree, leaves);
    const auto second_child = static_cast<uint32_t>(tree.nodes.size());
    count += lay_out(*source.child[1], first + count, tree, leaves);
    tree.nodes[node] = {Box3f(), first, count, second_child};
    return count;
}

// The boxes of parts that were split several times are cut closer, now that they are final; where nothing of the triangle
// is in its box, the box stays.
void fill(const Leaf& leaf, const std::vector<Vertices>& vertices, BinaryTree& tree) {
    for (uint32_t i = 0; i < leaf.source->count; ++i) {
        const RTCBuildPrimitive& primitive = leaf.source->primitives[i];
        const Vertices& triangle = vertices[primitive.primID];
        Box3f bounds = box_of(primitive);
        if (bounds != bounds_of(triangle)) {
            const Box3f tight = clipped_bounds(triangle, bounds);
            if (!tight.isEmpty()) bounds = tight;
        }
        tree.references[leaf.first + i] = {bounds, primitive.primID};
    }
    fill_swept_subtree(tree, leaf.node, leaf.first, leaf.source->count);
}

BinaryTree flatten(const BuildNode& root, const std::vector<Vertices>& vertices) {
    BinaryTree tree;
    std::vector<Leaf> leaves;
    tree.references.resize(lay_out(root, 0, tree, leaves));
    tbb::parallel_for(size_t{0}, leaves.size(), [&](size_t i) { fill(leaves[i], vertices, tree); });
    compute_bounds(tree);
    return tree;
}

using DeviceHandle = std::unique_ptr<std::remove_pointer_t<RTCDevice>, decltype(&rtcReleaseDevice)>;
using BvhHandle = std::unique_ptr<std::remove_pointer_t<RTCBVH>, decltype(&rtcReleaseBVH)>;

// The tree of one part, at most max_depth nodes deep; empty where it would have to be deeper.
BinaryTree build_part(const DeviceHandle& device, std::span<const RTCBuildPrimitive> part,
                      std::vector<Vertices>& vertices, BvhQuality quality, uint32_t max_depth) {
    const bool split = quality == BvhQuality::high;
    std::vector<RTCBuildPrimitive> primitives(part.begin(), part.end());
    primitives.resize(part.size() +
                      (split ? static_cast<size_t>(SPLIT_ROOM * static_cast<double>(part.size())) : 0));
    const BvhHandle bvh(rtcNewBVH(device.get()), rtcReleaseBVH);

    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.buildQuality = embree_quality(quality);
    arguments.maxBranchingFactor = 2;
    arguments.maxDepth = max_depth - (SMALL_SET - 1);  // a swept set may be a chain
    arguments.sahBlockSize = BLOCK_WIDTH;
    arguments.minLeafSize = SMALL_SET;
    arguments.maxLeafSize = SMALL_SET;
    arguments.bvh = bvh.get();
    arguments.primitives = primitives.data();
    arguments.primitiveCount = part.size();
    arguments.primitiveArrayCapacity = primitives.size();
    arguments.createNode = create_node;
    arguments.setNodeChildren = set_children;
    arguments.setNodeBounds = ignore_bounds;
    arguments.createLeaf = create_leaf;
    arguments.splitPrimitive = split ? split_part : nullptr;
    arguments.userPtr = vertices.data();

    // Embree's parallel sums and the order of split parts depend on the number of threads and on timing: one
    // thread makes the tree a function of the scene alone.
    tbb::task_arena one_thread(1);
    const void* root = one_thread.execute([&] { return rtcBuildBVH(&arguments); });
    return root == nullptr ? BinaryTree() : flatten(*static_cast<const BuildNode*>(root), vertices);
}

}  // namespace

BinaryTree build_binary_tree(const Scene& scene, BvhQuality quality) {
    if (scene.triangles.empty()) return {};
    std::vector<Vertices> vertices = all_vertices(scene);
    std::vector<RTCBuildPrimitive> primitives = build_primitives(vertices);
    const std::vector<TopNode> top = cut_into_parts(primitives);
    std::vector<TopNode> parts;
    std::ranges::copy_if(top, std::back_inserter(parts),
                         [](const TopNode& n) { return n.second_child == 0; });

    const DeviceHandle device(rtcNewDevice(nullptr), rtcReleaseDevice);
    OBSCURA_CHECK(device != nullptr, "Embree has no device, error {}",
                  static_cast<int>(rtcGetDeviceError(nullptr)));
    std::vector<BinaryTree> trees(parts.size());
    tbb::parallel_for(size_t{0}, parts.size(), [&](size_t i) {
        const std::span part = std::span(primitives).subspan(parts[i].first, parts[i].count);
        // Spatial splits make a build three times as long. A scene of one part is built quickly anyway.
        const bool plain = quality == BvhQuality::high && parts.size() > 1 && !has_large_triangles(part);
        const uint32_t max_depth = MAX_BINARY_DEPTH - parts[i].depth;
        trees[i] = build_part(device, part, vertices, plain ? BvhQuality::medium : quality, max_depth);
        if (quality == BvhQuality::high) reinsert_subtrees(trees[i], max_depth);
    });
    if (std::ranges::any_of(trees, [](const BinaryTree& tree) { return tree.nodes.empty(); })) return {};
    return trees.size() == 1 ? std::move(trees.front()) : join(top, trees);
}

}  // namespace obscura
