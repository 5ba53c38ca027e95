// SPDX-License-Identifier: Apache-2.0
// The distance setting of obscurance rays: text to value, and value to metres in a given scene. The picture's shape.
#include "scene/settings.h"

#include "base/error.h"
#include "base/log.h"
#include "scene/scene.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace obscura {

namespace {

// Outside this share of the scene's diagonal the setting is most often a mistake of units: obscurances then
// see next to nothing, or nearly all of the scene.
constexpr double SMALLEST_USUAL_SHARE = 0.005;
constexpr double LARGEST_USUAL_SHARE = 1;

// A picture is whole pixels wide and high: less than this is no other shape.
constexpr double ASPECT_TOLERANCE = 0.01;

// Rays start above a surface by the rounding of its coordinates. Below this share of them d_max feels it where surfaces
// touch: W by the square root is off by up to 0.003 here (tests/image/contact_test.cpp), that of a corner by 0.0014 at a
// hundredth of it (tests/image/hard_scenes_test.cpp).
constexpr double SMALLEST_EXACT_SHARE = 0.01;

// m
double farthest_coordinate(const Scene& scene) {
    const Box3f& bounds = scene.bounds;
    double farthest = 0;
    for (int axis = 0; axis < 3 && !bounds.isEmpty(); ++axis)
        for (const float coordinate : {bounds.min[axis], bounds.max[axis]})
            farthest = std::max(farthest, std::abs(static_cast<double>(coordinate)));
    return scene.unit * farthest;
}

}  // namespace

MaxDistance parse_max_distance(const std::string& text) {
    if (text == "inf") return {std::numeric_limits<double>::infinity(), MaxDistance::Unit::infinite};
    const bool percent = text.ends_with('%');
    const char* end = text.data() + text.size() - (percent ? 1 : 0);
    double value = 0;
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stop != end || !std::isfinite(value) || value <= 0)
        throw InputError(
            "--dmax {}: expected a positive length in metres (1), a share of the scene's diagonal (50%) or "
            "inf.",
            text);
    return {value, percent ? MaxDistance::Unit::percent : MaxDistance::Unit::metres};
}

std::string max_distance_text(const MaxDistance& distance) {
    switch (distance.unit) {
        case MaxDistance::Unit::metres:
            return fmt::format("{}", distance.value);
        case MaxDistance::Unit::percent:
            return fmt::format("{}%", distance.value);
        case MaxDistance::Unit::infinite:
            return "inf";
    }
    OBSCURA_CHECK(false, "unit {}", static_cast<int>(distance.unit));
}

double resolve_max_distance(const MaxDistance& distance, const Scene& scene) {
    if (distance.unit == MaxDistance::Unit::infinite) return std::numeric_limits<double>::infinity();
    const double size = diagonal(scene);
    if (distance.unit == MaxDistance::Unit::percent && size == 0)
        throw InputError("--dmax {}: the scene has no extent to take a share of.",
                         max_distance_text(distance));
    const double metres =
        distance.unit == MaxDistance::Unit::percent ? distance.value / 100 * size : distance.value;
    const double share = size > 0 ? metres / size : 0;
    if (size > 0 && (share < SMALLEST_USUAL_SHARE || share > LARGEST_USUAL_SHARE))
        log_warning("--dmax {} is {:.3g} % of the scene's diagonal of {:.4g} m; 0.5 % to 100 % is usual.",
                    max_distance_text(distance), 100 * share, size);
    const double farthest = farthest_coordinate(scene);
    if (metres < SMALLEST_EXACT_SHARE * farthest)
        log_warning(
            "--dmax {} is less than 1 % of the scene's farthest coordinate, {:.4g} m: rounding may shift "
            "obscurance by more than 1/512 where surfaces touch.",
            max_distance_text(distance), farthest);
    return metres;
}

void check_aspect(const RenderSettings& settings, double aspect_ratio) {
    const double aspect = static_cast<double>(settings.width) / settings.height;
    if (aspect_ratio > 0 && std::abs(aspect / aspect_ratio - 1) > ASPECT_TOLERANCE)
        log_warning(
            "the camera was made for pictures of aspect ratio {:.4g}; this one has {:.4g} and shows more or "
            "less at its sides.",
            aspect_ratio, aspect);
}

}  // namespace obscura
