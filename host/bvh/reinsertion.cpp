// SPDX-License-Identifier: Apache-2.0
#include "bvh/reinsertion.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace obscura {
namespace {

// Smaller sets stay as they are: they were cut by trying every way. Moving single triangles too takes five times as long and
// makes the kitchen's rays visit as many nodes.
constexpr uint32_t LEAST_SPLIT = 2 * BLOCK_WIDTH;
// Places that are looked at for one subtree, 30 on average in furnished rooms; boxes that all overlap would have each subtree
// look at the whole tree.
constexpr uint32_t MOST_VISITS = 512;

constexpr uint32_t NOTHING = 0;  // the root, which is nobody's child

double united_area(Box3f a, const Box3f& b) {
    a.extendBy(b);
    return half_area(a);
}

// A node of the tree while it changes. Those of small sets are leaves here.
struct Node {
    Box3f bounds;
    double area = 0;
    uint32_t parent = NOTHING;
    std::array<uint32_t, 2> child{};  // NOTHING in a leaf
};

class Optimizer {
  public:
    explicit Optimizer(const BinaryTree& tree) : nodes_(tree.nodes.size()) {
        for (uint32_t i = 0; i < nodes_.size(); ++i) {
            const BinaryNode& source = tree.nodes[i];
            nodes_[i].bounds = source.bounds;
            nodes_[i].area = half_area(source.bounds);
            if (source.count < LEAST_SPLIT) continue;
            nodes_[i].child = {i + 1, source.second_child};
            for (const uint32_t child : nodes_[i].child)
                nodes_[child].parent = i;
        }
    }

    const Node& node(uint32_t i) const { return nodes_[i]; }

    // Moves each of the nodes that gains by it, the largest first. A second round would move a quarter as many, to little effect.
    void run() {
        std::vector<uint32_t> order;
        for (uint32_t i = 1; i < nodes_.size(); ++i)
            if (nodes_[i].parent != NOTHING) order.push_back(i);  // the root's children have no place to go
        std::ranges::stable_sort(order, std::ranges::greater(), [&](uint32_t i) { return nodes_[i].area; });
        for (const uint32_t i : order)
            move(i);
    }

  private:
    // A place beside which a node may go, and what all boxes together lose if it goes there, but for that place's own.
    struct Place {
        double gain;
        uint32_t node;
    };

    uint32_t sibling_of(uint32_t i) const {
        const Node& parent = nodes_[nodes_[i].parent];
        return parent.child[parent.child[0] == i ? 1 : 0];
    }

    void move(uint32_t i) {
        if (nodes_[i].parent == NOTHING) return;
        const uint32_t target = best_place(i);
        if (target == NOTHING) return;
        const uint32_t parent = nodes_[i].parent;
        const uint32_t sibling = sibling_of(i);
        // The sibling takes its parent's place, which becomes the target's and the node's.
        const uint32_t above = nodes_[parent].parent;
        replace_child(above, parent, sibling);
        refit(above);
        replace_child(nodes_[target].parent, target, parent);
        nodes_[parent].child = {target, i};
        nodes_[target].parent = parent;
        fit(parent);
        refit(nodes_[parent].parent);
    }

    // Where a node is better off; NOTHING: where it is.
    uint32_t best_place(uint32_t i) {
        const Node& node = nodes_[i];
        Place best{0, NOTHING};
        uint32_t visits = 0;
        // What is above the place it leaves shrinks, up to where both places are below.
        double gain = nodes_[node.parent].area;
        Box3f left;
        uint32_t pivot = i;
        while (true) {
            const uint32_t beside = sibling_of(pivot);
            search(node, {gain, beside}, best, visits);
            left.extendBy(nodes_[beside].bounds);
            const uint32_t above = nodes_[pivot].parent;
            if (pivot != i) gain += nodes_[above].area - half_area(left);
            pivot = above;
            if (pivot == 0 || visits >= MOST_VISITS) return best.node;
        }
    }

    // The best place below one, if it is better than the best so far.
    void search(const Node& node, Place from, Place& best, uint32_t& visits) {
        stack_.assign(1, from);
        while (!stack_.empty()) {
            const Place place = stack_.back();
            stack_.pop_back();
            if (place.gain - node.area <= best.gain || ++visits > MOST_VISITS) continue;
            const Node& there = nodes_[place.node];
            const double united = united_area(there.bounds, node.bounds);
            if (place.gain - united > best.gain) best = {place.gain - united, place.node};
            if (there.child[0] == NOTHING) continue;
            for (const uint32_t child : there.child)
                stack_.push_back({place.gain - united + there.area, child});
        }
    }

    void replace_child(uint32_t parent, uint32_t child, uint32_t other) {
        std::array<uint32_t, 2>& children = nodes_[parent].child;
        children[children[0] == child ? 0 : 1] = other;
        nodes_[other].parent = parent;
    }

    // The box of a node around its children; false if it was that already.
    bool fit(uint32_t i) {
        Node& node = nodes_[i];
        Box3f bounds = nodes_[node.child[0]].bounds;
        bounds.extendBy(nodes_[node.child[1]].bounds);
        if (bounds == node.bounds) return false;
        node.bounds = bounds;
        node.area = half_area(bounds);
        return true;
    }

    // The boxes from a node on up to the root, as far as they change.
    void refit(uint32_t i) {
        while (fit(i) && i != 0)
            i = nodes_[i].parent;
    }

    std::vector<Node> nodes_;
    std::vector<Place> stack_;
};

// Lays the changed tree out depth first again; subtrees of small sets are copied as they are.
class Layout {
  public:
    Layout(const BinaryTree& source, const Optimizer& changed) : source_(source), changed_(changed) {
        tree_.nodes.reserve(source.nodes.size());
        tree_.references.reserve(source.references.size());
    }

    // False if the tree is deeper than that.
    bool lay_out(uint32_t max_depth) { return lay_out(0, max_depth); }

    BinaryTree take() { return std::move(tree_); }

  private:
    bool lay_out(uint32_t i, uint32_t room) {
        const Node& node = changed_.node(i);
        if (node.child[0] == NOTHING) return copy(i, room);
        if (room == 0) return false;
        const size_t place = tree_.nodes.size();
        const auto first = static_cast<uint32_t>(tree_.references.size());
        tree_.nodes.emplace_back();
        if (!lay_out(node.child[0], room - 1)) return false;
        const auto second_child = static_cast<uint32_t>(tree_.nodes.size());
        if (!lay_out(node.child[1], room - 1)) return false;
        const auto count = static_cast<uint32_t>(tree_.references.size()) - first;
        tree_.nodes[place] = {node.bounds, first, count, second_child};
        return true;
    }

    bool copy(uint32_t i, uint32_t room) {
        const BinaryNode& root = source_.nodes[i];
        if (root.count > room + 1) return false;  // it may be a chain
        const auto node_shift = static_cast<uint32_t>(tree_.nodes.size()) - i;
        const auto reference_shift = static_cast<uint32_t>(tree_.references.size()) - root.first;
        for (uint32_t k = i; k < i + node_count(root.count); ++k) {
            BinaryNode node = source_.nodes[k];
            node.first += reference_shift;
            if (node.second_child != 0) node.second_child += node_shift;
            tree_.nodes.push_back(node);
        }
        const auto first = source_.references.begin() + root.first;
        tree_.references.insert(tree_.references.end(), first, first + root.count);
        return true;
    }

    const BinaryTree& source_;
    const Optimizer& changed_;
    BinaryTree tree_;
};

}  // namespace

void reinsert_subtrees(BinaryTree& tree, uint32_t max_depth) {
    if (tree.nodes.empty()) return;
    Optimizer optimizer(tree);
    optimizer.run();
    Layout layout(tree, optimizer);
    if (layout.lay_out(max_depth)) tree = layout.take();
}

}  // namespace obscura
