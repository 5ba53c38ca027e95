// SPDX-License-Identifier: Apache-2.0
// Everything that changes the pixels is here, so that merge can refuse parts that were made differently.
#include "wavefront/describe.h"

#include "base/error.h"
#include "film/attributes.h"
#include "sampling/filter.h"
#include "sampling/sample_order.h"
#include "scene/local_frame.h"
#include "wavefront/frame.h"

#include <limits>

namespace obscura {
namespace {

std::string on_off(bool on) {
    return on ? "on" : "off";
}

std::string ambient_text(Ambient ambient) {
    switch (ambient) {
        case Ambient::obscurance:
            return "obscurance";
        case Ambient::constant:
            return "constant";
        case Ambient::none:
            return "none";
    }
    OBSCURA_CHECK(false, "ambient light {}", static_cast<int>(ambient));
}

// An attribute's integer is signed: the upper half of the seeds becomes text.
Attribute seed_attribute(uint64_t seed) {
    if (seed <= static_cast<uint64_t>(std::numeric_limits<int64_t>::max())) return static_cast<int64_t>(seed);
    return fmt::format("{}", seed);
}

}  // namespace

void place_image(Image& image, const RenderSettings& settings, const PixelRect& rect) {
    image.full_width = static_cast<int32_t>(settings.width);
    image.full_height = static_cast<int32_t>(settings.height);
    image.x0 = static_cast<int32_t>(rect.x0);
    image.y0 = static_cast<int32_t>(rect.y0);
    image.x1 = static_cast<int32_t>(rect.x1);
    image.y1 = static_cast<int32_t>(rect.y1);
}

void describe(const RenderJob& job, const std::string& device_name, RenderResult& result) {
    const RenderSettings& settings = result.settings;
    const Camera camera = world_camera(job.scene, select_camera(job.scene, settings));
    auto& attributes = result.image.attributes;
    attributes[attribute::SOFTWARE] = std::string("obscura " OBSCURA_VERSION);
    attributes[attribute::SCENE] = job.scene.name;
    attributes[attribute::CAMERA] = camera.name;
    attributes[attribute::WORLD_TO_CAMERA] = camera.camera_to_world.inverse();
    attributes[attribute::WORLD_TO_NDC] = world_to_ndc(camera, settings.width, settings.height);
    attributes[attribute::REFLECTIVITY] = result.radiometry.average_reflectivity;
    attributes[attribute::AMBIENT_INTENSITY] = resolve_ambient(result.radiometry, settings);
    attributes[attribute::BACKGROUND] = V3d(settings.background.value_or(Rgb(0)));

    attributes[attribute::SPP] = int64_t{result.samples_per_pixel};
    attributes[attribute::PLANNED_SPP] = int64_t{settings.spp};
    attributes[attribute::OBSCURANCE_RAYS] = int64_t{settings.obscurance_rays};
    attributes[attribute::LIGHT_SAMPLES] = int64_t{settings.light_samples};
    attributes[attribute::MAX_DEPTH] = int64_t{settings.max_depth};
    attributes[attribute::SEED] = seed_attribute(settings.seed);
    attributes[attribute::SAMPLER] = std::string(sampler_name(settings.sampler));
    attributes[attribute::FILTER] = std::string(filter_name(settings.filter));
    attributes[attribute::FALLOFF] = falloff_text(settings.falloff);
    attributes[attribute::MAX_DISTANCE] = result.d_max;
    attributes[attribute::AMBIENT] = ambient_text(settings.ambient);
    attributes[attribute::BLEEDING] = on_off(settings.bleeding);
    attributes[attribute::OBSCURANCE] = on_off(settings.obscurance);
    attributes[attribute::DIRECT] = on_off(settings.direct);
    attributes[attribute::SPECULAR] = on_off(settings.specular);
    attributes[attribute::ROULETTE] = on_off(settings.roulette);
    attributes[attribute::COMPLETE] = std::string(result.complete ? "yes" : "no");

    attributes[attribute::DEVICE] = device_name;
    attributes[attribute::SECONDS] = result.seconds.render;
}

}  // namespace obscura
