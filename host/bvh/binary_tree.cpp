// SPDX-License-Identifier: Apache-2.0
// What needs no builder: cutting small sets by trying every split, large ones by the median, and the bounds
// of a finished tree.
#include "bvh/binary_tree.h"

#include <algorithm>
#include <limits>

namespace obscura {
namespace {

V3f center(const Box3f& box) {
    return box.min * 0.5F + box.max * 0.5F;
}

void sort_by_center(Reference* references, uint32_t count, int axis) {
    std::sort(references, references + count, [axis](const Reference& a, const Reference& b) {
        const float center_a = center(a.bounds)[axis];
        const float center_b = center(b.bounds)[axis];
        return center_a < center_b || (center_a == center_b && a.triangle < b.triangle);
    });
}

// Appends nodes for references[first .. first + count). cut(references, count) orders them and says how many
// go to the first child.
template <typename Cut>
void append_subtree(BinaryTree& tree, uint32_t first, uint32_t count, const Cut& cut) {
    const size_t index = tree.nodes.size();
    tree.nodes.push_back({Box3f(), first, count, 0});
    if (count == 1) return;
    const uint32_t first_count = cut(tree.references.data() + first, count);
    append_subtree(tree, first, first_count, cut);
    tree.nodes[index].second_child = static_cast<uint32_t>(tree.nodes.size());
    append_subtree(tree, first + first_count, count - first_count, cut);
}

// The cut with the least SAH cost in blocks among all cuts of the centers' order along an axis.
uint32_t best_cut(Reference* references, uint32_t count) {
    double least = std::numeric_limits<double>::infinity();
    uint32_t best = count / 2;
    int best_axis = 0;
    std::vector<double> second_area(count);
    for (int axis = 0; axis < 3; ++axis) {
        sort_by_center(references, count, axis);
        Box3f second;
        for (uint32_t i = count; i-- > 1;) {
            second.extendBy(references[i].bounds);
            second_area[i] = half_area(second);
        }
        Box3f first;
        for (uint32_t i = 1; i < count; ++i) {
            first.extendBy(references[i - 1].bounds);
            const double cost = half_area(first) * block_count(i) + second_area[i] * block_count(count - i);
            if (cost < least) {
                least = cost;
                best = i;
                best_axis = axis;
            }
        }
    }
    sort_by_center(references, count, best_axis);
    return best;
}

uint32_t median_cut(Reference* references, uint32_t count) {
    Box3f centers;
    for (uint32_t i = 0; i < count; ++i)
        centers.extendBy(center(references[i].bounds));
    sort_by_center(references, count, static_cast<int>(centers.majorAxis()));
    return count / 2;
}

}  // namespace

Vertices triangle_vertices(const Scene& scene, uint32_t triangle) {
    return {scene.corner(triangle, 0).position, scene.corner(triangle, 1).position,
            scene.corner(triangle, 2).position};
}

std::vector<Vertices> all_vertices(const Scene& scene) {
    std::vector<Vertices> vertices(scene.triangles.size());
    for (uint32_t i = 0; i < vertices.size(); ++i)
        vertices[i] = triangle_vertices(scene, i);
    return vertices;
}

Box3f bounds_of(const Vertices& vertices) {
    Box3f box;
    for (const V3f& vertex : vertices)
        box.extendBy(vertex);
    return box;
}

void append_swept_subtree(BinaryTree& tree, uint32_t first, uint32_t count) {
    append_subtree(tree, first, count, best_cut);
}

// Children come after their parents, so backwards is from the leaves up.
void compute_bounds(BinaryTree& tree) {
    for (size_t i = tree.nodes.size(); i-- > 0;) {
        BinaryNode& node = tree.nodes[i];
        if (node.second_child == 0) {
            node.bounds = tree.references[node.first].bounds;
        } else {
            node.bounds = tree.nodes[i + 1].bounds;
            node.bounds.extendBy(tree.nodes[node.second_child].bounds);
        }
    }
}

BinaryTree build_median_tree(const Scene& scene) {
    BinaryTree tree;
    if (scene.triangles.empty()) return tree;
    const std::vector<Vertices> vertices = all_vertices(scene);
    for (uint32_t i = 0; i < vertices.size(); ++i)
        tree.references.push_back({bounds_of(vertices[i]), i});
    append_subtree(tree, 0, static_cast<uint32_t>(vertices.size()), median_cut);
    compute_bounds(tree);
    return tree;
}

}  // namespace obscura
