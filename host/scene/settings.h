// SPDX-License-Identifier: Apache-2.0
// Every choice a user makes about a render, with the paper's values as defaults. Filled by the command line,
// read by everything after it.
#pragma once

#include "base/math.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

namespace obscura {

struct Scene;

// The falloff rho(t), t = d / d_max in [0, 1). Values are shared with the kernels (shared/frame.h).
enum class FalloffKind : uint32_t { step = 0, linear, sqrt, cbrt, exp, expjump, pow };

struct Falloff {
    FalloffKind kind = FalloffKind::exp;
    double parameter = 1;  // exp: lambda > 0; pow: exponent p > 0; else unused
};

enum class Ambient { obscurance, constant, none };
enum class SamplerKind : uint32_t { lattice = 1, owen, random };
enum class PixelFilter : uint32_t { box = 0, tent, gauss, blackman_harris };
enum class NeedsMode { automatic, all };

// Distance of obscurance queries: absolute, per cent of the scene's bounding-box diagonal, or unlimited.
struct MaxDistance {
    enum class Unit { metres, percent, infinite };
    double value = 1;
    Unit unit = Unit::metres;
};

// Part of the image to render, as fractions of width and height; pixel x is inside when
// ceil(width * x0) <= x < ceil(width * x1), as in pbrt.
struct CropWindow {
    double x0 = 0, x1 = 1, y0 = 0, y1 = 1;
};

struct RenderSettings {
    uint32_t width = 800;
    uint32_t height = 600;
    uint32_t spp = 8;              // camera rays per pixel
    uint32_t obscurance_rays = 5;  // K: per camera ray and diffuse hit
    Falloff falloff;
    MaxDistance d_max;
    Ambient ambient = Ambient::obscurance;
    bool bleeding = true;
    bool direct = true;      // --no-direct
    bool specular = true;    // --no-specular
    bool obscurance = true;  // --no-obscurance: no ambient term at all
    uint32_t light_samples = 1;
    bool roulette = true;
    PixelFilter filter = PixelFilter::box;
    std::optional<Rgb> background;     // radiance of camera and specular rays that leave the scene
    std::optional<Rgb> ambient_light;  // replaces I_A: incoming radiance at an open point
    double ambient_scale = 1;
    uint32_t max_depth = 5;  // glossy continuations of a camera path
    uint64_t seed = 0;
    SamplerKind sampler = SamplerKind::lattice;
    std::string camera;  // name or index; empty: the first
    CropWindow crop;
    NeedsMode needs = NeedsMode::automatic;
};

// rho(t) for t in [0, 1], in double: the definition that the kernels and the tests are checked against.
double falloff_value(const Falloff& falloff, double t);
// "exp", "exp:2", "pow:0.3" ... and back. Throws InputError that lists the known names.
Falloff parse_falloff(const std::string& text);
std::string falloff_text(const Falloff& falloff);
// "1", "50%", "inf". Throws InputError for 0, negative and NaN.
MaxDistance parse_max_distance(const std::string& text);
std::string max_distance_text(const MaxDistance& distance);
// In metres; infinity when unlimited. Warns outside 0.5..100 % of the scene's diagonal.
double resolve_max_distance(const MaxDistance& distance, const Scene& scene);
// Warns if the picture is wider or higher than the camera was made for; aspect_ratio: width / height, 0 = any.
void check_aspect(const RenderSettings& settings, double aspect_ratio);

}  // namespace obscura
