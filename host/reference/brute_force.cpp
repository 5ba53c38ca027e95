// SPDX-License-Identifier: Apache-2.0
#include "reference/brute_force.h"

#include <tbb/parallel_for.h>

#include <map>

namespace obscura {
namespace {

// By coordinates, so that -0 and +0 are one position.
struct PositionLess {
    bool operator()(const V3f& a, const V3f& b) const {
        if (a.x != b.x) return a.x < b.x;
        if (a.y != b.y) return a.y < b.y;
        return a.z < b.z;
    }
};

}  // namespace

BruteHit intersect(const BruteRay& ray, const std::array<V3f, 3>& triangle, uint32_t primitive) {
    using V3l = Imath::Vec3<long double>;
    const V3l direction(ray.direction);
    std::array<V3l, 3> vertex;
    for (size_t i = 0; i < 3; ++i)
        vertex[i] = V3l(triangle[i]) - V3l(ray.origin);

    // Scaled by the edges' cross product, the distances are the edge functions of Woop's test.
    std::array<long double, 3> weight;
    std::array<long double, 3> sine;
    for (size_t i = 0; i < 3; ++i) {
        const V3l& from = vertex[(i + 1) % 3];
        const V3l edge = vertex[(i + 2) % 3] - from;
        const V3l across = direction.cross(edge);
        weight[i] = from.dot(across);
        sine[i] = across.length();
    }
    const V3l normal = (vertex[1] - vertex[0]).cross(vertex[2] - vertex[0]);
    const long double determinant = normal.dot(direction);  // = -(sum of the weights)
    BruteHit hit;
    hit.primitive = primitive;
    hit.cosine = static_cast<double>(std::abs(determinant) / (normal.length() * direction.length()));
    const long double sign = determinant > 0 ? -1 : 1;
    for (size_t i = 0; i < 3; ++i) {
        if (sine[i] == 0) continue;
        hit.edge_distance[i] = static_cast<double>(sign * weight[i] / sine[i]);
        hit.height[i] = static_cast<double>(std::abs(determinant) / sine[i]);
    }
    if (determinant != 0) {
        hit.t = static_cast<double>(normal.dot(vertex[0]) / determinant);
        hit.u = static_cast<double>(-weight[1] / determinant);
        hit.v = static_cast<double>(-weight[2] / determinant);
    }
    return hit;
}

BruteForce::BruteForce(const Scene& scene) : scene_(scene) {
    std::map<V3f, uint32_t, PositionLess> points;
    for (const Vertex& vertex : scene.vertices) {
        positions_.emplace_back(vertex.position);
        const auto next = static_cast<uint32_t>(points.size());
        point_of_vertex_.push_back(points.try_emplace(vertex.position, next).first->second);
    }
    first_around_.assign(points.size() + 1, 0);
    const auto count = static_cast<uint32_t>(scene.triangles.size());
    for (uint32_t triangle = 0; triangle < count; ++triangle)
        for (const uint32_t point : this->points(triangle))
            ++first_around_[point + 1];
    for (size_t point = 0; point < points.size(); ++point)
        first_around_[point + 1] += first_around_[point];
    around_.resize(first_around_.back());
    std::vector<uint32_t> next(first_around_.begin(), first_around_.end() - 1);
    for (uint32_t triangle = 0; triangle < count; ++triangle)
        for (const uint32_t point : this->points(triangle))
            around_[next[point]++] = triangle;
}

BruteHit BruteForce::examine(const TraceRay& ray, uint32_t primitive) const {
    return intersect(brute_ray(ray), corners(primitive), primitive);
}

std::vector<BruteHit> BruteForce::candidates(const TraceRay& ray, double tolerance) const {
    std::vector<BruteHit> result;
    for_each_near(brute_ray(ray), tolerance, [&](uint32_t primitive) {
        const BruteHit hit = examine(ray, primitive);
        if (hit.inside(tolerance) && hit.t > 0 && hit.t <= static_cast<double>(ray.t_max))
            result.push_back(hit);
    });
    std::sort(result.begin(), result.end(), nearer);
    return result;
}

BruteHit BruteForce::closest(const TraceRay& ray) const {
    const auto all = candidates(ray);
    if (!all.empty()) return all.front();
    BruteHit miss;
    miss.t = static_cast<double>(ray.t_max);
    return miss;
}

std::vector<BruteHit> BruteForce::closest(std::span<const TraceRay> rays) const {
    std::vector<BruteHit> hits(rays.size());
    tbb::parallel_for(size_t{0}, rays.size(), [&](size_t i) { hits[i] = closest(rays[i]); });
    return hits;
}

// Ericson 2005, "Real-Time Collision Detection", section 5.1.5, by the regions in which the nearest point lies.
double BruteForce::distance(const V3d& point, uint32_t primitive) const {
    const auto [i, j, k] = scene_.triangles[primitive].vertex;
    const V3d corner[3] = {positions_[i], positions_[j], positions_[k]};
    const V3d normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    bool above = normal.length2() > 0;
    double nearest = std::numeric_limits<double>::infinity();
    for (size_t from = 0; from < 3; ++from) {
        const V3d edge = corner[(from + 1) % 3] - corner[from];
        const V3d offset = point - corner[from];
        above = above && normal.dot(edge.cross(offset)) >= 0;
        const double along = edge.length2() > 0 ? std::clamp(offset.dot(edge) / edge.length2(), 0.0, 1.0) : 0;
        nearest = std::min(nearest, (offset - along * edge).length());
    }
    return above ? std::abs(normal.normalized().dot(point - corner[0])) : nearest;
}

bool BruteForce::may_end(const TraceRay& ray, uint32_t primitive, double tolerance) const {
    const BruteRay line = brute_ray(ray);
    std::vector<uint32_t> joined{primitive};  // those around the ray, found so far
    for (size_t next = 0; next < joined.size(); ++next) {
        const BruteHit hit = examine(ray, joined[next]);
        for (size_t corner = 0; corner < 3; ++corner) {
            if (std::abs(hit.edge_distance[corner]) > tolerance) continue;
            const std::vector<uint32_t> neighbours = across(line, joined[next], corner);
            if (neighbours.empty()) return true;
            for (const uint32_t neighbour : neighbours) {
                const bool known = std::find(joined.begin(), joined.end(), neighbour) != joined.end();
                if (!known && examine(ray, neighbour).inside(tolerance)) joined.push_back(neighbour);
            }
        }
    }
    return false;
}

std::vector<uint32_t> BruteForce::across(const BruteRay& ray, uint32_t triangle,
                                         size_t opposite_corner) const {
    const Points own = points(triangle);
    const uint32_t from = own[(opposite_corner + 1) % 3];
    const uint32_t to = own[(opposite_corner + 2) % 3];
    const auto vertex = scene_.triangles[triangle].vertex;
    const V3d& start = positions_[vertex[(opposite_corner + 1) % 3]];
    // Normal of the plane through the ray's direction and the edge: its side tells left from right.
    const V3d side = ray.direction.cross(positions_[vertex[(opposite_corner + 2) % 3]] - start);
    const double own_side = side.dot(positions_[vertex[opposite_corner]] - start);
    std::vector<uint32_t> result;
    for (uint32_t i = first_around_[from]; i < first_around_[from + 1]; ++i) {
        const Points other = points(around_[i]);
        if (std::find(other.begin(), other.end(), to) == other.end()) continue;
        for (size_t corner = 0; corner < 3; ++corner) {
            if (other[corner] == from || other[corner] == to) continue;
            const uint32_t apex = scene_.triangles[around_[i]].vertex[corner];
            if (own_side * side.dot(positions_[apex] - start) < 0) result.push_back(around_[i]);
        }
    }
    return result;
}

BruteForce::Points BruteForce::points(uint32_t triangle) const {
    const auto& [a, b, c] = scene_.triangles[triangle].vertex;
    return {point_of_vertex_[a], point_of_vertex_[b], point_of_vertex_[c]};
}

std::array<V3f, 3> BruteForce::corners(uint32_t triangle) const {
    return {scene_.corner(triangle, 0).position, scene_.corner(triangle, 1).position,
            scene_.corner(triangle, 2).position};
}

// Calls use(primitive) for every triangle whose projection along the ray has a bounding box around the ray, give or take
// the tolerance and the rounding of the projection.
template <typename Use>
void BruteForce::for_each_near(const BruteRay& ray, double tolerance, const Use& use) const {
    const V3d forward = ray.direction.normalized();
    const V3d axis = std::abs(forward.x) < 0.6 ? V3d(1, 0, 0) : V3d(0, 1, 0);
    const V3d right = forward.cross(axis).normalized();
    const V3d up = right.cross(forward);
    thread_local std::vector<double> x;
    thread_local std::vector<double> y;
    x.resize(positions_.size());
    y.resize(positions_.size());
    double extent = 0;
    for (size_t i = 0; i < positions_.size(); ++i) {
        const V3d offset = positions_[i] - ray.origin;
        x[i] = offset.dot(right);
        y[i] = offset.dot(up);
        extent = std::max(extent, std::abs(offset.x) + std::abs(offset.y) + std::abs(offset.z));
    }
    const double margin = tolerance + 1e-13 * extent;
    for (uint32_t primitive = 0; primitive < scene_.triangles.size(); ++primitive) {
        const auto [a, b, c] = scene_.triangles[primitive].vertex;
        if (std::min({x[a], x[b], x[c]}) <= margin && std::max({x[a], x[b], x[c]}) >= -margin &&
            std::min({y[a], y[b], y[c]}) <= margin && std::max({y[a], y[b], y[c]}) >= -margin)
            use(primitive);
    }
}

}  // namespace obscura
