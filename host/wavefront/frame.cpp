// SPDX-License-Identifier: Apache-2.0
#include "wavefront/frame.h"

#include "base/error.h"
#include "sampling/lattice.h"
#include "sampling/sample_order.h"
#include "sampling/seed.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>

namespace obscura {
namespace {

f32x4 lane(const V3d& v, float w = 0) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), w};
}

// Half of what the picture shows from top to bottom: metres, or the tangent of the angle.
double half_height_of(const Camera& camera) {
    return camera.orthographic ? camera.half_height : std::tan(camera.vertical_fov / 2);
}

void set_camera(Frame& frame, const Camera& camera, const RenderSettings& settings) {
    const M44d& m = camera.camera_to_world;
    const V3d right(m[0][0], m[0][1], m[0][2]);
    const V3d up(m[1][0], m[1][1], m[1][2]);
    const V3d back(m[2][0], m[2][1], m[2][2]);
    const V3d origin(m[3][0], m[3][1], m[3][2]);
    const double half_height = half_height_of(camera);
    const double half_width = half_height * settings.width / settings.height;
    frame.camera_origin =
        lane(origin, std::bit_cast<float>(camera.orthographic ? CAMERA_ORTHOGRAPHIC : CAMERA_PERSPECTIVE));
    frame.camera_right = lane(right * half_width);
    frame.camera_up = lane(up * half_height);
    frame.camera_forward = lane(-back);
}

uint32_t frame_flags(const RenderSettings& settings) {
    const bool ambient = settings.obscurance && settings.ambient != Ambient::none;
    const bool traced = ambient && settings.ambient == Ambient::obscurance;
    return (settings.roulette ? FRAME_ROULETTE : 0u) | (settings.direct ? FRAME_DIRECT : 0u) |
           (settings.specular ? FRAME_SPECULAR : 0u) | (ambient ? FRAME_AMBIENT : 0u) |
           (traced ? FRAME_OBSCURANCE : 0u) | (traced && settings.bleeding ? FRAME_BLEEDING : 0u) |
           (settings.filter != PixelFilter::box ? FRAME_TABLE_FILTER : 0u);
}

// The kernels compare with the host's numbers.
static_assert(static_cast<uint32_t>(SamplerKind::lattice) == SAMPLER_LATTICE &&
              static_cast<uint32_t>(SamplerKind::owen) == SAMPLER_OWEN &&
              static_cast<uint32_t>(SamplerKind::random) == SAMPLER_RANDOM);
static_assert(static_cast<uint32_t>(FalloffKind::step) == FALLOFF_STEP &&
              static_cast<uint32_t>(FalloffKind::linear) == FALLOFF_LINEAR &&
              static_cast<uint32_t>(FalloffKind::sqrt) == FALLOFF_SQRT &&
              static_cast<uint32_t>(FalloffKind::cbrt) == FALLOFF_CBRT &&
              static_cast<uint32_t>(FalloffKind::exp) == FALLOFF_EXP &&
              static_cast<uint32_t>(FalloffKind::expjump) == FALLOFF_EXPJUMP &&
              static_cast<uint32_t>(FalloffKind::pow) == FALLOFF_POW);

}  // namespace

LayerPlanes assign_planes(const Needs& needs, std::span<const uint32_t> wanted_layers) {
    LayerPlanes planes;
    planes.fill(NO_PLANE);
    uint32_t next = 0;
    const auto keep = [&](uint32_t layer, bool kept) {
        if (kept && planes[layer] == NO_PLANE) planes[layer] = next++;
    };
    keep(LAYER_EMISSION, true);  // carries the coverage
    keep(LAYER_DIRECT, needs.direct());
    keep(LAYER_AMBIENT, needs.ambient);
    keep(LAYER_SPECULAR_EMISSION, needs.specular_paths || needs.glossy);
    keep(LAYER_SPECULAR_DIRECT, needs.specular_paths && needs.direct());
    keep(LAYER_SPECULAR_AMBIENT, needs.specular_paths && needs.ambient);
    for (const uint32_t layer : wanted_layers)
        keep(layer, layer >= BEAUTY_LAYERS);
    return planes;
}

uint32_t plane_count(const LayerPlanes& planes) {
    return static_cast<uint32_t>(
        std::ranges::count_if(planes, [](uint32_t plane) { return plane != NO_PLANE; }));
}

const Camera& select_camera(const Scene& scene, const RenderSettings& settings) {
    OBSCURA_CHECK(!scene.cameras.empty(), "scene {} has no camera", scene.name);
    if (settings.camera.empty()) return scene.cameras.front();
    const auto named = std::ranges::find(scene.cameras, settings.camera, &Camera::name);
    if (named != scene.cameras.end()) return *named;
    size_t index = 0;
    const char* end = settings.camera.data() + settings.camera.size();
    const auto parsed = std::from_chars(settings.camera.data(), end, index);
    if (parsed.ec == std::errc{} && parsed.ptr == end && index < scene.cameras.size())
        return scene.cameras[index];
    std::string names;
    for (size_t i = 0; i < scene.cameras.size(); ++i)
        names += fmt::format("{}{} '{}'", i == 0 ? "" : ", ", i, scene.cameras[i].name);
    throw InputError("{}: there is no camera '{}'; the scene has {}", scene.name, settings.camera, names);
}

M44d world_to_ndc(const Camera& camera, uint32_t width, uint32_t height) {
    const double half_height = half_height_of(camera);
    const double half_width = half_height * width / height;
    const double sx = 0.5 / half_width, sy = -0.5 / half_height;  // y points down
    // The camera looks along -z. Perspective divides by the depth w = -z; 1 / depth keeps the matrix invertible.
    const M44d to_ndc = camera.orthographic ? M44d(sx, 0, 0, 0, 0, sy, 0, 0, 0, 0, 1, 0, 0.5, 0.5, 0, 1)
                                            : M44d(sx, 0, 0, 0, 0, sy, 0, 0, -0.5, -0.5, 0, -1, 0, 0, 1, 0);
    return camera.camera_to_world.inverse() * to_ndc;
}

Frame make_frame(const FrameInput& input, const PixelRect& rect, uint32_t capacity) {
    const RenderSettings& settings = input.settings;
    const uint32_t spp = settings.spp;
    const uint32_t k_count = settings.obscurance_rays;
    const uint32_t l_count = settings.light_samples;
    OBSCURA_CHECK(uint64_t{spp} * std::max(k_count, l_count) <= MAX_SET_POINTS,
                  "{} samples x {} or {} points", spp, k_count, l_count);
    Frame frame{};
    set_camera(frame, select_camera(input.scene, settings), settings);
    frame.image = {settings.width, settings.height, rect.x0, rect.y0};
    frame.crop = {rect.width(), rect.height(), static_cast<uint32_t>(rect.pixel_count()), capacity};
    frame.sampling = {spp, k_count, l_count, static_cast<uint32_t>(settings.sampler)};
    frame.seed = {fold_seed(settings.seed), static_cast<uint32_t>(std::bit_width(spp - 1)),
                  settings.max_depth, frame_flags(settings)};
    const LatticeSteps pixel = lattice_steps(spp, spp);
    const LatticeSteps light = lattice_steps(spp * l_count, spp);
    const LatticeSteps points = lattice_steps(spp * k_count, spp);
    frame.lattice = {pixel.x, pixel.y, light.x, light.y};
    frame.lattice_points = {points.x, points.y, 0, 0};

    // What no float holds is as good as nothing or all: the scene measures about one of its units.
    const bool unlimited = std::isinf(input.d_max);
    const double d_max = unlimited ? input.d_max
                                   : std::clamp(input.d_max / input.scene.unit,
                                                static_cast<double>(std::numeric_limits<float>::min()),
                                                static_cast<double>(std::numeric_limits<float>::max()));
    const Falloff& falloff = settings.falloff;
    const double norm = falloff.kind == FalloffKind::exp ? -std::expm1(-falloff.parameter) : 1;
    frame.obscurance = {static_cast<float>(d_max), unlimited ? 0.0f : static_cast<float>(1 / d_max),
                        static_cast<float>(falloff.parameter), static_cast<float>(1 / norm)};
    const bool bleeding = (frame.seed.w & FRAME_BLEEDING) != 0;
    frame.miss = lane(bleeding ? input.radiometry.average_reflectivity : V3d(1), static_cast<float>(k_count));
    // A constant ambient light is the colourless model with W = 1.
    RenderSettings ambient_settings = settings;
    ambient_settings.bleeding = bleeding;
    frame.ambient = lane(resolve_ambient(input.radiometry, ambient_settings));
    frame.background = lane(V3d(settings.background.value_or(Rgb(0))));
    frame.lights = {input.area_light_count, input.point_light_count, static_cast<uint32_t>(falloff.kind), 0};
    frame.world_origin = lane(input.scene.origin, static_cast<float>(input.scene.unit));
    for (uint32_t layer = 0; layer < LAYER_COUNT; ++layer) {
        reinterpret_cast<uint32_t*>(frame.plane)[layer] = input.planes[layer];
    }
    reinterpret_cast<uint32_t*>(frame.plane)[LAYER_COUNT] = plane_count(input.planes);
    return frame;
}

}  // namespace obscura
