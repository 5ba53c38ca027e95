// SPDX-License-Identifier: Apache-2.0
// What needs no builder: cutting small sets by trying every split, large ones by the median, and the bounds
// of a finished tree.
#include "bvh/binary_tree.h"

#include <algorithm>
#include <limits>

namespace obscura {
namespace {

float center(const Box3f& box, int axis) {
    return box.min[axis] * 0.5F + box.max[axis] * 0.5F;
}

// What stands for a reference while a set is cut: quicker to sort.
struct Key {
    float center;  // along the axis in hand
    uint32_t triangle;
    uint32_t index;  // of the reference within the set

    bool operator<(const Key& other) const {
        return center < other.center || (center == other.center && triangle < other.triangle);
    }
};

// A set of references that is being cut, and its keys, in the order of the last sort.
class Set {
  public:
    Set(Reference* references, uint32_t count) : references_(references), keys_(count) {
        for (uint32_t i = 0; i < count; ++i)
            keys_[i] = {0, references[i].triangle, i};
    }

    uint32_t count() const { return static_cast<uint32_t>(keys_.size()); }
    const Box3f& bounds(uint32_t i) const { return references_[keys_[i].index].bounds; }

    void sort_by_center(int axis) {
        for (Key& key : keys_)
            key.center = center(references_[key.index].bounds, axis);
        std::sort(keys_.begin(), keys_.end());
    }

    // Brings the references themselves into the order of the keys.
    void reorder() {
        const std::vector<Reference> before(references_, references_ + keys_.size());
        for (size_t i = 0; i < keys_.size(); ++i)
            references_[i] = before[keys_[i].index];
    }

  private:
    Reference* references_;
    std::vector<Key> keys_;
};

// Fills the nodes of a set from an index on. cut(set) sorts it and says how many go to the first child.
template <typename Cut>
void fill_subtree(BinaryTree& tree, uint32_t node, uint32_t first, uint32_t count, const Cut& cut) {
    tree.nodes[node] = {Box3f(), first, count, 0};
    if (count == 1) return;
    Set set(tree.references.data() + first, count);
    const uint32_t first_count = cut(set);
    set.reorder();
    const uint32_t second_child = node + 1 + node_count(first_count);
    tree.nodes[node].second_child = second_child;
    fill_subtree(tree, node + 1, first, first_count, cut);
    fill_subtree(tree, second_child, first + first_count, count - first_count, cut);
}

// The cut with the least SAH cost in blocks among all cuts of the centers' order along an axis.
uint32_t best_cut(Set& set) {
    const uint32_t count = set.count();
    double least = std::numeric_limits<double>::infinity();
    uint32_t best = count / 2;
    int best_axis = 0;
    std::vector<double> second_area(count);
    for (int axis = 0; axis < 3; ++axis) {
        set.sort_by_center(axis);
        Box3f second;
        for (uint32_t i = count; i-- > 1;) {
            second.extendBy(set.bounds(i));
            second_area[i] = half_area(second);
        }
        Box3f first;
        for (uint32_t i = 1; i < count; ++i) {
            first.extendBy(set.bounds(i - 1));
            const double cost = half_area(first) * block_count(i) + second_area[i] * block_count(count - i);
            if (cost < least) {
                least = cost;
                best = i;
                best_axis = axis;
            }
        }
    }
    set.sort_by_center(best_axis);
    return best;
}

uint32_t median_cut(Set& set) {
    Box3f centers;
    for (uint32_t i = 0; i < set.count(); ++i) {
        const Box3f& box = set.bounds(i);
        centers.extendBy(V3f(center(box, 0), center(box, 1), center(box, 2)));
    }
    set.sort_by_center(static_cast<int>(centers.majorAxis()));
    return set.count() / 2;
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

void fill_swept_subtree(BinaryTree& tree, uint32_t node, uint32_t first, uint32_t count) {
    fill_subtree(tree, node, first, count, best_cut);
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
    const auto count = static_cast<uint32_t>(vertices.size());
    tree.nodes.resize(node_count(count));
    fill_subtree(tree, 0, 0, count, median_cut);
    compute_bounds(tree);
    return tree;
}

}  // namespace obscura
