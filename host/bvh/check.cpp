// SPDX-License-Identifier: Apache-2.0
// check_bvh walks the finished tree as a traversal would and trusts nothing the builder noted. A triangle
// whose parts lie in several leaves is covered if nothing is left of it once all their boxes are cut away.
#include "bvh/binary_tree.h"
#include "bvh/clip.h"
#include "bvh/layout.h"
#include "scene/material.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace obscura {
namespace {

// What rounding may leave over of a triangle between two parts: its extent times this share of its largest
// coordinate.
constexpr double COVER_TOLERANCE = 0x1p-46;

struct Part {
    uint32_t triangle;
    Box3f bounds;
};

bool contains(const Box3f& outer, const Box3f& inner) {
    return outer.intersects(inner.min) && outer.intersects(inner.max);
}

// Appends the part of the polygon beyond the plane; a polygon that only touches it has none.
void keep_beyond(const Polygon& polygon, int axis, double position, Side side, std::vector<Polygon>& rest) {
    const auto* const end = polygon.corner.begin() + polygon.count;
    if (std::any_of(polygon.corner.begin(), end, [&](const V3d& corner) {
            return side == Side::below ? corner[axis] < position : corner[axis] > position;
        }))
        rest.push_back(clip(polygon, axis, position, side));
}

// Appends what is left of the polygon outside the box.
void subtract(Polygon polygon, const Box3f& box, std::vector<Polygon>& rest) {
    for (int axis = 0; axis < 3; ++axis) {
        const auto lower = static_cast<double>(box.min[axis]);
        const auto upper = static_cast<double>(box.max[axis]);
        keep_beyond(polygon, axis, lower, Side::below, rest);
        keep_beyond(polygon, axis, upper, Side::above, rest);
        polygon = clip(clip(polygon, axis, lower, Side::above), axis, upper, Side::below);
    }
}

// Area of the triangle outside all the boxes, m^2.
double uncovered_area(const std::array<V3f, 3>& triangle, const Part* begin, const Part* end) {
    std::vector<Polygon> rest{Polygon(triangle)};
    for (const Part* part = begin; part != end; ++part) {
        std::vector<Polygon> remaining;
        for (const Polygon& polygon : rest)
            subtract(polygon, part->bounds, remaining);
        std::erase_if(remaining, [](const Polygon& polygon) { return polygon.area() == 0; });
        rest = std::move(remaining);
    }
    double area = 0;
    for (const Polygon& polygon : rest)
        area += polygon.area();
    return area;
}

class Checker {
  public:
    Checker(const Bvh& bvh, const Scene& scene)
        : bvh_(bvh), scene_(scene), node_seen_(bvh.nodes.size()), block_seen_(bvh.blocks.size()) {}

    std::string run() {
        if (bvh_.nodes.empty()) return "there is no root node";
        const uint32_t pending = visit_node(0, 1, Box3f(V3f(-MAX, -MAX, -MAX), V3f(MAX, MAX, MAX)));
        if (error_.empty()) check_totals(pending + 1);
        if (error_.empty()) check_cover();
        return error_;
    }

  private:
    static constexpr float MAX = std::numeric_limits<float>::max();

    template <typename... Args>
    void fail(fmt::format_string<Args...> format, Args&&... args) {
        if (error_.empty()) error_ = fmt::format(format, std::forward<Args>(args)...);
    }

    // Returns the most entries pending beside the one visited.
    uint32_t visit_node(uint32_t index, uint32_t depth, const Box3f& outer) {
        if (index >= bvh_.nodes.size())
            fail("node {} does not exist", index);
        else if (node_seen_[index])
            fail("node {} is reached twice", index);
        if (!error_.empty()) return 0;
        node_seen_[index] = true;
        depth_ = std::max(depth_, depth);
        uint32_t children = 0;
        uint32_t deepest = 0;
        for (size_t child = 0; child < BVH_WIDTH && error_.empty(); ++child) {
            const uint32_t reference = child_reference(bvh_.nodes[index], child);
            const Box3f bounds = child_bounds(bvh_.nodes[index], child);
            if (reference == BVH_EMPTY_CHILD) {
                check_empty(index, child, bounds);
                continue;
            }
            ++children;
            if (bounds.isEmpty() || !contains(outer, bounds))
                fail("the box of child {} of node {} is not inside its parent's", child, index);
            if (is_leaf_reference(reference))
                visit_leaf(reference, bounds);
            else
                deepest = std::max(deepest, visit_node(reference, depth + 1, bounds));
        }
        if (children == 0 && !scene_.triangles.empty()) fail("node {} has no children", index);
        return children == 0 ? 0 : children - 1 + deepest;
    }

    void check_empty(uint32_t index, size_t child, const Box3f& bounds) {
        constexpr float INFINITE = std::numeric_limits<float>::infinity();
        for (int axis = 0; axis < 3; ++axis)
            if (bounds.min[axis] != INFINITE || bounds.max[axis] != -INFINITE)
                fail("empty child {} of node {} has bounds that a ray can hit", child, index);
    }

    void visit_leaf(uint32_t reference, const Box3f& bounds) {
        const uint32_t first = leaf_first_block(reference);
        const uint32_t count = leaf_block_count(reference);
        if (count == 0 || first + count > bvh_.blocks.size())
            return fail("a leaf refers to blocks {} .. {} of {}", first, first + count, bvh_.blocks.size());
        std::vector<uint32_t> triangles;
        for (uint32_t index = first; index < first + count; ++index) {
            if (block_seen_[index]) return fail("block {} is reached twice", index);
            block_seen_[index] = true;
            for (size_t slot = 0; slot < BLOCK_WIDTH; ++slot) {
                const uint32_t triangle = block_primitive(bvh_.blocks[index], slot);
                if (triangle == NO_PRIMITIVE) {
                    check_empty_slot(index, slot, index + 1 == first + count);
                } else {
                    check_triangle(index, slot, triangle);
                    triangles.push_back(triangle);
                    parts_.push_back({triangle, bounds});
                }
            }
        }
        std::sort(triangles.begin(), triangles.end());
        if (std::adjacent_find(triangles.begin(), triangles.end()) != triangles.end())
            fail("the leaf at block {} holds a triangle twice", first);
    }

    void check_empty_slot(uint32_t index, size_t slot, bool last) {
        for (const V3f& vertex : block_triangle(bvh_.blocks[index], slot))
            if (vertex != V3f(0, 0, 0)) fail("empty slot {} of block {} has vertices", slot, index);
        if (slot == 0 || !last) fail("slot {} of block {} is empty before the leaf's end", slot, index);
    }

    void check_triangle(uint32_t index, size_t slot, uint32_t triangle) {
        if (triangle >= scene_.triangles.size())
            fail("block {} holds triangle {} of {}", index, triangle, scene_.triangles.size());
        else if (block_triangle(bvh_.blocks[index], slot) != triangle_vertices(scene_, triangle))
            fail("the vertices of triangle {} in block {} are not the scene's", triangle, index);
        else if (is_pane_slot(bvh_.blocks[index], slot) !=
                 is_pane(scene_.materials[scene_.triangles[triangle].material]))
            fail("triangle {} in block {} is marked wrongly as a pane or as none", triangle, index);
        if (slot > 0 && block_primitive(bvh_.blocks[index], slot - 1) == NO_PRIMITIVE)
            fail("slot {} of block {} is filled after an empty one", slot, index);
    }

    void check_totals(uint32_t stack_entries) {
        const auto lost_node = std::find(node_seen_.begin(), node_seen_.end(), false);
        if (lost_node != node_seen_.end()) fail("node {} is never reached", lost_node - node_seen_.begin());
        const auto lost_block = std::find(block_seen_.begin(), block_seen_.end(), false);
        if (lost_block != block_seen_.end())
            fail("block {} is never reached", lost_block - block_seen_.begin());
        if (depth_ != bvh_.depth) fail("the depth is {}, noted is {}", depth_, bvh_.depth);
        if (stack_entries != bvh_.stack_entries)
            fail("a traversal needs {} stack entries, noted is {}", stack_entries, bvh_.stack_entries);
        if (stack_entries > BVH_STACK_SIZE)
            fail("a traversal needs {} stack entries, the device has {}", stack_entries, BVH_STACK_SIZE);
    }

    void check_cover() {
        std::sort(parts_.begin(), parts_.end(),
                  [](const Part& a, const Part& b) { return a.triangle < b.triangle; });
        const Part* part = parts_.data();
        const Part* const end = part + parts_.size();
        for (uint32_t triangle = 0; triangle < scene_.triangles.size(); ++triangle) {
            const Part* const first = part;
            while (part != end && part->triangle == triangle)
                ++part;
            if (first == part) return fail("triangle {} is in no block", triangle);
            const auto vertices = triangle_vertices(scene_, triangle);
            Box3f whole;
            for (const V3f& vertex : vertices)
                whole.extendBy(vertex);
            if (std::any_of(first, part, [&](const Part& p) { return contains(p.bounds, whole); })) continue;

            double largest = 0;
            for (int axis = 0; axis < 3; ++axis)
                largest = std::max({largest, std::abs(static_cast<double>(whole.min[axis])),
                                    std::abs(static_cast<double>(whole.max[axis]))});
            const auto extent = static_cast<double>(whole.size().length());
            if (uncovered_area(vertices, first, part) > COVER_TOLERANCE * largest * extent)
                return fail("the leaf boxes of triangle {} do not cover it", triangle);
        }
    }

    const Bvh& bvh_;
    const Scene& scene_;
    std::vector<bool> node_seen_;
    std::vector<bool> block_seen_;
    std::vector<Part> parts_;
    uint32_t depth_ = 0;
    std::string error_;
};

}  // namespace

std::string check_bvh(const Bvh& bvh, const Scene& scene) {
    return Checker(bvh, scene).run();
}

}  // namespace obscura
