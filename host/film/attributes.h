// SPDX-License-Identifier: Apache-2.0
// The facts in an image's header that mean something to film and to comparisons, and what becomes of each fact
// when parts of a picture are merged. The names are OpenEXR's and pbrt's where they have one.
#pragma once

#include <string_view>

namespace obscura {
namespace attribute {

inline constexpr const char* SPP = "samplesPerPixel";        // int64
inline constexpr const char* SEED = "seed";                  // int64
inline constexpr const char* DEVICE = "device";              // string
inline constexpr const char* SECONDS = "renderTimeSeconds";  // double
inline constexpr const char* WORLD_TO_CAMERA = "worldToCamera";
inline constexpr const char* WORLD_TO_NDC = "worldToNDC";

}  // namespace attribute

enum class MergeRule {
    agree,  // the parts must agree, or they aren't parts of one picture
    sum,
    list,  // the distinct texts, in the order of the parts
};

constexpr MergeRule merge_rule(std::string_view name) {
    if (name == attribute::SECONDS) return MergeRule::sum;
    if (name == attribute::DEVICE) return MergeRule::list;
    return MergeRule::agree;
}

}  // namespace obscura
