// SPDX-License-Identifier: Apache-2.0
#include "bvh/parts.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <limits>

namespace obscura {
namespace {

constexpr uint32_t BIN_COUNT = 32;
// Deeper than this the halves have equal numbers, so that the depth stays logarithmic whatever the scene.
constexpr uint32_t MAX_UNEVEN_DEPTH = 12;
// A triangle is large if its box has more than this share of its part's surface; those of an evenly tessellated part have
// about 2 / MAX_PART_TRIANGLES.
constexpr double LARGE = 1.0 / 256;
constexpr double LARGE_SHARE = 0.1;  // of the area of all boxes

Box3f box_of(const RTCBuildPrimitive& p) {
    return {V3f(p.lower_x, p.lower_y, p.lower_z), V3f(p.upper_x, p.upper_y, p.upper_z)};
}

float center(const RTCBuildPrimitive& p, int axis) {
    const float* const lower = &p.lower_x;
    const float* const upper = &p.upper_x;
    return lower[axis] * 0.5F + upper[axis] * 0.5F;
}

// Equal slices of the centers' range along an axis.
struct Slices {
    int axis = 0;
    float low = 0, scale = 0;

    Slices(int along, const Box3f& centers)
        : axis(along),
          low(centers.min[along]),
          scale(BIN_COUNT / (centers.max[along] - centers.min[along])) {}
    uint32_t bin(const RTCBuildPrimitive& p) const {
        return std::min(static_cast<uint32_t>((center(p, axis) - low) * scale), BIN_COUNT - 1);
    }
};

struct Cut {
    int axis = 0;
    uint32_t bin = 0;  // the first of the second side; 0: there is no cut
    double cost = std::numeric_limits<double>::infinity();
};

// The cheapest cut between two bins of an axis: half areas times numbers of triangles.
Cut best_cut(std::span<const RTCBuildPrimitive> primitives, const Slices& slices) {
    std::array<Box3f, BIN_COUNT> box;
    std::array<uint64_t, BIN_COUNT> count{};
    for (const RTCBuildPrimitive& primitive : primitives) {
        const uint32_t bin = slices.bin(primitive);
        box[bin].extendBy(box_of(primitive));
        ++count[bin];
    }
    std::array<double, BIN_COUNT> above_cost{};
    Box3f above;
    uint64_t above_count = 0;
    for (uint32_t i = BIN_COUNT; i-- > 1;) {
        above.extendBy(box[i]);
        above_count += count[i];
        above_cost[i] = above_count == 0 ? 0 : half_area(above) * static_cast<double>(above_count);
    }
    Cut best{.axis = slices.axis};
    Box3f below;
    uint64_t below_count = 0;
    for (uint32_t i = 1; i < BIN_COUNT; ++i) {
        below.extendBy(box[i - 1]);
        below_count += count[i - 1];
        if (below_count == 0 || below_count == primitives.size()) continue;
        const double cost = half_area(below) * static_cast<double>(below_count) + above_cost[i];
        if (cost < best.cost) {
            best.cost = cost;
            best.bin = i;
        }
    }
    return best;
}

// Orders the primitives into two sides; the number of the first.
size_t halve(std::span<RTCBuildPrimitive> primitives, uint32_t depth) {
    Box3f centers;
    for (const RTCBuildPrimitive& p : primitives)
        centers.extendBy(V3f(center(p, 0), center(p, 1), center(p, 2)));
    Cut best;
    for (int axis = 0; axis < 3 && depth < MAX_UNEVEN_DEPTH; ++axis) {
        if (!(centers.max[axis] > centers.min[axis])) continue;
        const Cut cut = best_cut(primitives, Slices(axis, centers));
        if (cut.cost < best.cost) best = cut;
    }
    if (best.bin > 0) {
        const Slices slices(best.axis, centers);
        const auto middle =
            std::partition(primitives.begin(), primitives.end(),
                           [&](const RTCBuildPrimitive& p) { return slices.bin(p) < best.bin; });
        return static_cast<size_t>(middle - primitives.begin());
    }
    const auto middle = primitives.begin() + static_cast<std::ptrdiff_t>(primitives.size() / 2);
    const int axis = static_cast<int>(centers.majorAxis());
    std::nth_element(primitives.begin(), middle, primitives.end(),
                     [&](const RTCBuildPrimitive& a, const RTCBuildPrimitive& b) {
                         const float center_a = center(a, axis), center_b = center(b, axis);
                         return center_a < center_b || (center_a == center_b && a.primID < b.primID);
                     });
    return primitives.size() / 2;
}

std::vector<TopNode> cut(std::span<RTCBuildPrimitive> all, const TopNode& node) {
    if (node.count <= MAX_PART_TRIANGLES) return {node};
    const auto first_count = static_cast<uint32_t>(halve(all.subspan(node.first, node.count), node.depth));
    std::vector<TopNode> first, second;
    tbb::parallel_invoke(
        [&] {
            first = cut(all, {node.first, first_count, node.depth + 1});
        },
        [&] {
            second = cut(all, {node.first + first_count, node.count - first_count, node.depth + 1});
        });
    std::vector<TopNode> nodes{node};
    const auto append = [&](const std::vector<TopNode>& subtree) {
        const auto start = static_cast<uint32_t>(nodes.size());
        for (TopNode child : subtree) {
            if (child.second_child != 0) child.second_child += start;
            nodes.push_back(child);
        }
    };
    append(first);
    nodes.front().second_child = static_cast<uint32_t>(nodes.size());
    append(second);
    return nodes;
}

}  // namespace

std::vector<TopNode> cut_into_parts(std::span<RTCBuildPrimitive> primitives) {
    return cut(primitives, {0, static_cast<uint32_t>(primitives.size())});
}

bool has_large_triangles(std::span<const RTCBuildPrimitive> part) {
    Box3f bounds;
    for (const RTCBuildPrimitive& primitive : part)
        bounds.extendBy(box_of(primitive));
    const double large = LARGE * half_area(bounds);
    double all_area = 0, large_area = 0;
    for (const RTCBuildPrimitive& primitive : part) {
        const double area = half_area(box_of(primitive));
        all_area += area;
        if (area > large) large_area += area;
    }
    return large_area > LARGE_SHARE * all_area;
}

BinaryTree join(const std::vector<TopNode>& top, std::span<const BinaryTree> parts) {
    // Where the nodes and references of each top node begin, and, last, their numbers.
    std::vector<uint32_t> node_start(top.size() + 1), reference_start(top.size() + 1);
    std::vector<size_t> part_of(top.size());
    size_t next_part = 0;
    for (size_t i = 0; i < top.size(); ++i) {
        const bool inner = top[i].second_child != 0;
        part_of[i] = next_part;
        const BinaryTree* const part = inner ? nullptr : &parts[next_part++];
        node_start[i + 1] = node_start[i] + (inner ? 1 : static_cast<uint32_t>(part->nodes.size()));
        reference_start[i + 1] =
            reference_start[i] + (inner ? 0 : static_cast<uint32_t>(part->references.size()));
    }
    BinaryTree tree;
    tree.nodes.resize(node_start.back());
    tree.references.resize(reference_start.back());
    tbb::parallel_for(size_t{0}, top.size(), [&](size_t i) {
        if (top[i].second_child != 0) return;
        const BinaryTree& part = parts[part_of[i]];
        std::copy(part.references.begin(), part.references.end(),
                  tree.references.begin() + reference_start[i]);
        for (size_t k = 0; k < part.nodes.size(); ++k) {
            BinaryNode node = part.nodes[k];
            node.first += reference_start[i];
            if (node.second_child != 0) node.second_child += node_start[i];
            tree.nodes[node_start[i] + k] = node;
        }
    });
    for (size_t i = top.size(); i-- > 0;) {
        if (top[i].second_child == 0) continue;
        const uint32_t second = node_start[top[i].second_child];
        const BinaryNode& a = tree.nodes[node_start[i] + 1];
        const BinaryNode& b = tree.nodes[second];
        Box3f bounds = a.bounds;
        bounds.extendBy(b.bounds);
        tree.nodes[node_start[i]] = {bounds, reference_start[i], a.count + b.count, second};
    }
    return tree;
}

}  // namespace obscura
