// SPDX-License-Identifier: Apache-2.0
// Two passes. Plan computes, from the leaves up, the least cost of each subtree as at most 1..7 children of
// some wide node. Writer unfolds the choices from the root down, merges leaves of one node where that is
// cheaper still, and writes nodes and blocks depth first.
#include "bvh/collapse.h"

#include "bvh/layout.h"
#include "scene/material.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

namespace obscura {
namespace {

constexpr float INFINITE_COST = std::numeric_limits<float>::infinity();
constexpr uint32_t PARALLEL_THRESHOLD = 4096;  // references; smaller subtrees are not worth a task

Box3f united(Box3f a, const Box3f& b) {
    a.extendBy(b);
    return a;
}

// The triangles of a run of references, sorted, each once.
std::vector<uint32_t> triangles_of(const BinaryTree& tree, const BinaryNode& node) {
    std::vector<uint32_t> triangles;
    triangles.reserve(node.count);
    for (uint32_t i = 0; i < node.count; ++i)
        triangles.push_back(tree.references[node.first + i].triangle);
    std::sort(triangles.begin(), triangles.end());
    triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
    return triangles;
}

// The best way to hang one binary subtree into a wide node. Costs are relative to the root's area.
struct Choice {
    // [n]: the least cost as at most n children, n = 1..7.
    std::array<float, BVH_WIDTH> cost{};
    // [n]: how many of n children come from the first subtree, n = 2..8; 0 = n - 1 children are as good.
    std::array<uint8_t, BVH_WIDTH + 1> first{};
    bool leaf = false;  // as one child: a leaf, not a node
};

class Plan {
  public:
    Plan(const BinaryTree& tree, uint32_t width) : tree_(tree), width_(width), choices_(tree.nodes.size()) {
        inverse_root_area_ =
            1 / std::max(half_area(tree.nodes[0].bounds), std::numeric_limits<double>::min());
        choose(0);
    }

    const BinaryTree& tree() const { return tree_; }
    bool is_leaf(uint32_t node) const { return choices_[node].leaf; }

    // The binary nodes that become the children of a wide node made of this (inner) binary node.
    std::vector<uint32_t> children(uint32_t node) const {
        std::vector<uint32_t> result;
        split(node, width_, result);
        return result;
    }

  private:
    void choose(uint32_t index) {
        const BinaryNode& node = tree_.nodes[index];
        if (node.second_child != 0) {
            if (node.count > PARALLEL_THRESHOLD) {
                tbb::parallel_invoke([&] { choose(index + 1); }, [&] { choose(node.second_child); });
            } else {
                choose(index + 1);
                choose(node.second_child);
            }
        }
        const auto area = static_cast<float>(half_area(node.bounds) * inverse_root_area_);
        Choice& choice = choices_[index];
        const uint32_t blocks = leaf_blocks(node);
        const float leaf_cost = blocks > 0 ? area * BLOCK_COST * static_cast<float>(blocks) : INFINITE_COST;
        float node_cost = INFINITE_COST;
        if (node.second_child != 0) node_cost = area * NODE_COST + distribute(node, index, choice, width_);
        choice.leaf = leaf_cost <= node_cost;
        choice.cost[1] = std::min(leaf_cost, node_cost);
        for (uint32_t n = 2; n < width_; ++n) {
            choice.cost[n] = choice.cost[n - 1];
            if (node.second_child == 0) continue;
            const float cost = distribute(node, index, choice, n);
            if (cost < choice.cost[n])
                choice.cost[n] = cost;
            else
                choice.first[n] = 0;
        }
    }

    // The least cost of the node's two subtrees as n children together; notes how to share them out.
    float distribute(const BinaryNode& node, uint32_t index, Choice& choice, uint32_t n) const {
        const Choice& first = choices_[index + 1];
        const Choice& second = choices_[node.second_child];
        float best = INFINITE_COST;
        for (uint32_t k = 1; k < n; ++k) {
            const float cost = first.cost[k] + second.cost[n - k];
            if (cost < best) {
                best = cost;
                choice.first[n] = static_cast<uint8_t>(k);
            }
        }
        return best;
    }

    // Blocks of a leaf that holds the whole subtree, each triangle once; 0 if it is too large for a leaf.
    uint32_t leaf_blocks(const BinaryNode& node) const {
        if (node.count > MAX_LEAF_TRIANGLES) return 0;
        std::array<uint32_t, MAX_LEAF_TRIANGLES> triangles;
        for (uint32_t i = 0; i < node.count; ++i)
            triangles[i] = tree_.references[node.first + i].triangle;
        std::sort(triangles.begin(), triangles.begin() + node.count);
        const auto end = std::unique(triangles.begin(), triangles.begin() + node.count);
        return block_count(static_cast<size_t>(end - triangles.begin()));
    }

    void split(uint32_t node, uint32_t n, std::vector<uint32_t>& result) const {
        const uint32_t first = choices_[node].first[n];
        collect(node + 1, first, result);
        collect(tree_.nodes[node].second_child, n - first, result);
    }

    void collect(uint32_t node, uint32_t n, std::vector<uint32_t>& result) const {
        while (n > 1 && choices_[node].first[n] == 0)
            --n;
        if (n == 1)
            result.push_back(node);
        else
            split(node, n, result);
    }

    const BinaryTree& tree_;
    uint32_t width_;
    double inverse_root_area_;
    std::vector<Choice> choices_;
};

// A child of a wide node while it is being written: a leaf if it has triangles.
struct Child {
    Box3f bounds;
    uint32_t node = 0;                // the binary node to write, for an inner child
    std::vector<uint32_t> triangles;  // sorted, each once

    bool is_leaf() const { return !triangles.empty(); }
    double cost() const {
        return half_area(bounds) * static_cast<double>(BLOCK_COST) * block_count(triangles.size());
    }
};

Child merged(const Child& a, const Child& b) {
    Child result{united(a.bounds, b.bounds), 0, {}};
    std::set_union(a.triangles.begin(), a.triangles.end(), b.triangles.begin(), b.triangles.end(),
                   std::back_inserter(result.triangles));
    return result;
}

// Merges the pair of leaves that saves most until no pair saves anything: half-empty blocks that lie in
// different subtrees of the binary tree become full ones.
void merge_leaves(std::vector<Child>& children) {
    while (true) {
        double most = 0;
        std::pair<size_t, size_t> best;
        for (size_t i = 0; i < children.size(); ++i) {
            for (size_t j = i + 1; j < children.size(); ++j) {
                const Child& a = children[i];
                const Child& b = children[j];
                if (!a.is_leaf() || !b.is_leaf()) continue;
                const Child both = merged(a, b);
                if (both.triangles.size() > MAX_LEAF_TRIANGLES) continue;
                const double saved = a.cost() + b.cost() - both.cost();
                if (saved > most) {
                    most = saved;
                    best = {i, j};
                }
            }
        }
        if (most <= 0) return;
        children[best.first] = merged(children[best.first], children[best.second]);
        children.erase(children.begin() + static_cast<std::ptrdiff_t>(best.second));
    }
}

class Writer {
  public:
    Writer(const Plan& plan, const Scene& scene, Bvh& bvh) : plan_(plan), scene_(scene), bvh_(bvh) {}

    // The root is a node even where one leaf would be cheaper.
    void write_root() {
        const bool single = plan_.is_leaf(0);
        const uint32_t pending = write_node(single ? std::vector<uint32_t>{0} : plan_.children(0), 1);
        bvh_.stack_entries = pending + 1;
    }

  private:
    // Returns the most entries that a traversal of this subtree can have pending beside the one it visits.
    uint32_t write_node(const std::vector<uint32_t>& binary_nodes, uint32_t depth) {
        const auto index = static_cast<uint32_t>(bvh_.nodes.size());
        bvh_.nodes.push_back(empty_node());
        bvh_.depth = std::max(bvh_.depth, depth);
        std::vector<Child> children;
        children.reserve(binary_nodes.size());
        for (const uint32_t node : binary_nodes)
            children.push_back(make_child(node));
        merge_leaves(children);

        // Leaves first: the blocks of one node's leaves lie together in memory.
        std::array<uint32_t, BVH_WIDTH> references;
        for (size_t i = 0; i < children.size(); ++i)
            if (children[i].is_leaf()) references[i] = write_leaf(children[i].triangles);
        uint32_t deepest = 0;
        for (size_t i = 0; i < children.size(); ++i) {
            if (children[i].is_leaf()) continue;
            references[i] = static_cast<uint32_t>(bvh_.nodes.size());
            deepest = std::max(deepest, write_node(plan_.children(children[i].node), depth + 1));
        }
        for (size_t i = 0; i < children.size(); ++i)
            set_child(bvh_.nodes[index], i, children[i].bounds, references[i]);
        return static_cast<uint32_t>(children.size()) - 1 + deepest;
    }

    Child make_child(uint32_t index) const {
        const BinaryNode& node = plan_.tree().nodes[index];
        if (!plan_.is_leaf(index)) return {node.bounds, index, {}};
        return {node.bounds, 0, triangles_of(plan_.tree(), node)};
    }

    uint32_t write_leaf(const std::vector<uint32_t>& triangles) {
        const auto first = static_cast<uint32_t>(bvh_.blocks.size());
        for (size_t i = 0; i < triangles.size(); ++i) {
            if (i % BLOCK_WIDTH == 0) bvh_.blocks.push_back(empty_block());
            const Material& material = scene_.materials[scene_.triangles[triangles[i]].material];
            set_triangle(bvh_.blocks.back(), i % BLOCK_WIDTH, triangles[i],
                         triangle_vertices(scene_, triangles[i]), is_pane(material));
        }
        return leaf_reference(first, static_cast<uint32_t>(bvh_.blocks.size()) - first);
    }

    const Plan& plan_;
    const Scene& scene_;
    Bvh& bvh_;
};

}  // namespace

Bvh collapse(const BinaryTree& tree, const Scene& scene, uint32_t width) {
    Bvh bvh;
    if (tree.nodes.empty()) {
        bvh.nodes.push_back(empty_node());
        bvh.depth = 1;
        bvh.stack_entries = 1;
        return bvh;
    }
    const Plan plan(tree, width);
    Writer(plan, scene, bvh).write_root();
    return bvh;
}

}  // namespace obscura
