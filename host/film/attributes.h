// SPDX-License-Identifier: Apache-2.0
// The facts in an image's header, and what becomes of each when parts of a picture are merged. The names are
// OpenEXR's and pbrt's where they have one.
#pragma once

#include <string_view>

namespace obscura {
namespace attribute {

// Where the picture comes from.
inline constexpr const char* SOFTWARE = "software";              // string, with its version
inline constexpr const char* SCENE = "scene";                    // string
inline constexpr const char* CAMERA = "camera";                  // string, its name
inline constexpr const char* WORLD_TO_CAMERA = "worldToCamera";  // matrix; the camera looks along -z, y is up
inline constexpr const char* WORLD_TO_NDC = "worldToNDC";  // matrix; (0, 0) upper left, (1, 1) lower right
inline constexpr const char* REFLECTIVITY = "averageReflectivity";    // RGB: R_ave
inline constexpr const char* AMBIENT_INTENSITY = "ambientIntensity";  // RGB, W/(sr m^2): I_A, scaled
inline constexpr const char* BACKGROUND = "background";               // RGB, W/(sr m^2)

// What shapes it: parts that differ in one of these are not parts of one picture.
inline constexpr const char* SPP = "samplesPerPixel";  // int64: that every pixel has
inline constexpr const char* PLANNED_SPP =
    "plannedSamplesPerPixel";                                     // int64: more than those if stopped early
inline constexpr const char* OBSCURANCE_RAYS = "obscuranceRays";  // int64: at each diffuse hit
inline constexpr const char* LIGHT_SAMPLES = "lightSamples";      // int64: for each group of lights
inline constexpr const char* MAX_DEPTH = "maxDepth";              // int64
inline constexpr const char* SEED = "seed";                       // int64, or decimal text from 2^63 on
inline constexpr const char* SAMPLER = "sampler";                 // string
inline constexpr const char* FILTER = "filter";                   // string
inline constexpr const char* FALLOFF = "falloff";                 // string
inline constexpr const char* MAX_DISTANCE = "maxDistance";        // double, m
inline constexpr const char* AMBIENT = "ambient";                 // "obscurance", "constant", "none"
inline constexpr const char* BLEEDING = "bleeding";               // "on", "off", as the next four
inline constexpr const char* OBSCURANCE = "obscurance";
inline constexpr const char* DIRECT = "direct";
inline constexpr const char* SPECULAR = "specular";
inline constexpr const char* ROULETTE = "roulette";
inline constexpr const char* COMPLETE = "complete";  // "yes", "no": stopped early

// Of a reference picture.
inline constexpr const char* INTEGRATOR = "integrator";  // "obscurance", "path"
inline constexpr const char* SET_SPP = "samplesPerSet";  // int64: of each independent set
inline constexpr const char* SETS = "independentSets";   // int64: finished, the ones behind its variance
inline constexpr const char* SCENE_DIGEST =
    "sceneDigest";  // string: of triangles, materials, lights, textures

// How it was made.
inline constexpr const char* DEVICE = "device";              // string
inline constexpr const char* SECONDS = "renderTimeSeconds";  // double

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
