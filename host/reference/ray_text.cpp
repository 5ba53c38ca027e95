// SPDX-License-Identifier: Apache-2.0
#include "reference/ray_text.h"

#include "base/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace obscura {
namespace {

// Origins and directions within this are within Embree's limit, and squares of a direction's length, up to three of
// its components, neither overflow nor become denormal; nor do distances in units of it.
constexpr double LARGEST = 1e18;
constexpr double SHORTEST_DIRECTION = 1e-18;

// Nine digits tell floats apart, also scaled by a power of two; a sum of two takes all that there are.
std::string world_coordinate(const Scene& scene, const V3f& position, int axis) {
    if (scene.origin[axis] == 0)
        return fmt::format("{:.9g}", scene.unit * static_cast<double>(position[axis]));
    using Wide = long double;
    const Wide sum = static_cast<Wide>(scene.unit) * static_cast<Wide>(position[axis]) +
                     static_cast<Wide>(scene.origin[axis]);
    return fmt::format("{:.{}g}", sum, std::numeric_limits<Wide>::max_digits10);
}

bool is_within_reach(const V3d& position) {
    return std::abs(position.x) <= LARGEST && std::abs(position.y) <= LARGEST &&
           std::abs(position.z) <= LARGEST;
}

}  // namespace

std::string ray_text(const Scene& scene, const GivenRay& given) {
    const TraceRay& ray = given.ray;
    std::string text = fmt::format(
        "{},{},{},{:.9g},{:.9g},{:.9g},{:.9g}", world_coordinate(scene, ray.origin, 0),
        world_coordinate(scene, ray.origin, 1), world_coordinate(scene, ray.origin, 2), ray.direction.x,
        ray.direction.y, ray.direction.z, scene.unit * static_cast<double>(ray.t_max));
    if (given.start) {
        const V3d start = scene.unit * V3d(*given.start);
        text += fmt::format(",{:.9g},{:.9g},{:.9g}", start.x, start.y, start.z);
    }
    return text;
}

GivenRay ray_of_numbers(const Scene& scene, std::span<const long double> numbers) {
    if (numbers.size() != 7 && numbers.size() != 10)
        throw InputError("--ray: {} numbers; a ray has 7, an obscurance ray 10", numbers.size());
    const auto unit = static_cast<long double>(scene.unit);
    TraceRay ray{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto i = static_cast<size_t>(axis);
        ray.origin[axis] =
            static_cast<float>((numbers[i] - static_cast<long double>(scene.origin[axis])) / unit);
        ray.direction[axis] = static_cast<float>(numbers[3 + i]);
    }
    ray.t_max = static_cast<float>(numbers[6] / unit);
    const double length = V3d(ray.direction).length();
    if (!is_within_reach(V3d(ray.origin))) {
        throw InputError("--ray: coordinates of the origin must be numbers of at most {:.6g} m here",
                         LARGEST * scene.unit);
    }
    if (!(length >= SHORTEST_DIRECTION && length <= LARGEST)) {
        throw InputError("--ray: the direction has the length {:.6g}; it must be between {:g} and {:g}",
                         length, SHORTEST_DIRECTION, LARGEST);
    }
    if (!(ray.t_max > 0)) throw InputError("--ray: the reach must be above 0, as a float too");
    if (numbers.size() == 7) return {ray};
    V3f start;
    for (int axis = 0; axis < 3; ++axis)
        start[axis] = static_cast<float>(numbers[7 + static_cast<size_t>(axis)] / unit);
    if (!is_within_reach(V3d(start)))
        throw InputError(
            "--ray: the origin's place beside its point must be numbers of at most {:.6g} m here",
            LARGEST * scene.unit);
    return {ray, start};
}

std::string hit_text(const Scene& scene, const TraceHit& hit) {
    if (hit.primitive == NO_PRIMITIVE) return "no hit";
    return fmt::format("triangle {} at {:.9g}, u {:.9g}, v {:.9g}", hit.primitive,
                       scene.unit * static_cast<double>(hit.t), hit.u, hit.v);
}

std::string hit_text(const Scene& scene, const BruteHit& hit) {
    if (!hit.hit()) return "no hit";
    return fmt::format("triangle {} at {:.17g}, u {:.17g}, v {:.17g}, {:.3g} inside its nearest edge",
                       hit.primitive, scene.unit * hit.t, hit.u, hit.v, scene.unit * hit.inside_by());
}

}  // namespace obscura
