// SPDX-License-Identifier: Apache-2.0
#include "reference/describe_reference.h"

#include "base/error.h"
#include "device/scene_buffers.h"
#include "film/attributes.h"
#include "reference/precise_tracer.h"
#include "wavefront/describe.h"

#include <algorithm>
#include <array>
#include <span>
#include <string>

namespace obscura::reference {
namespace {

// Facts of obscurances that a path tracer ignores.
constexpr std::array NOT_OF_PATHS = {
    attribute::AMBIENT_INTENSITY, attribute::OBSCURANCE_RAYS, attribute::MAX_DEPTH,
    attribute::FALLOFF,           attribute::MAX_DISTANCE,    attribute::AMBIENT,
    attribute::BLEEDING,          attribute::OBSCURANCE,      attribute::DIRECT,
    attribute::SPECULAR,          attribute::ROULETTE};

// What shapes a picture, and what to say where it differs: in this order, so that a cause comes before what follows from
// it.
struct Shaper {
    const char* attribute;
    const char* difference;
};
constexpr std::array SHAPERS = {
    Shaper{attribute::SCENE_DIGEST, "from another scene"},
    Shaper{attribute::SCENE, "from another scene"},
    Shaper{attribute::REFLECTIVITY, "from another scene"},
    Shaper{attribute::INTEGRATOR, "with another --integrator"},
    Shaper{attribute::CAMERA, "with another --camera"},
    Shaper{attribute::WORLD_TO_CAMERA, "with another --camera"},
    Shaper{attribute::WORLD_TO_NDC, "with another --camera"},
    Shaper{attribute::SET_SPP, "with another --spp"},
    Shaper{attribute::SEED, "with another --seed"},
    Shaper{attribute::SAMPLER, "with another --sampler"},
    Shaper{attribute::FILTER, "with another --filter"},
    Shaper{attribute::BACKGROUND, "with another --background"},
    Shaper{attribute::OBSCURANCE_RAYS, "with another --obscurance-rays"},
    Shaper{attribute::LIGHT_SAMPLES, "with another --light-samples"},
    Shaper{attribute::MAX_DEPTH, "with another --max-depth"},
    Shaper{attribute::FALLOFF, "with another --rho"},
    Shaper{attribute::MAX_DISTANCE, "with another --dmax"},
    Shaper{attribute::AMBIENT, "with another --ambient"},
    Shaper{attribute::BLEEDING, "with another --bleeding"},
    Shaper{attribute::OBSCURANCE, "with another --no-obscurance"},
    Shaper{attribute::DIRECT, "with another --no-direct"},
    Shaper{attribute::SPECULAR, "with another --no-specular"},
    Shaper{attribute::ROULETTE, "with another --roulette"},
    Shaper{attribute::AMBIENT_INTENSITY, "with another --ambient-light or --ambient-scale"},
    Shaper{attribute::SOFTWARE, "by another version"},
    Shaper{attribute::DEVICE, "by another tracer"}};

// How far a picture is, which changes when it is continued.
constexpr std::array PROGRESS = {attribute::SPP, attribute::PLANNED_SPP, attribute::SETS, attribute::COMPLETE,
                                 attribute::SECONDS};

// FNV-1a (Fowler, Noll, Vo), 64 bits.
template <typename T>
void add_bytes(uint64_t& hash, const std::vector<T>& values) {
    for (const std::byte byte : std::as_bytes(std::span(values))) {
        hash ^= std::to_integer<uint64_t>(byte);
        hash *= 0x100000001b3u;
    }
}

// Of all that shading and tracing read, in the layout that has no padding.
std::string scene_digest(const Scene& scene, PixelFilter filter) {
    const SceneArrays arrays = make_scene_arrays(scene, filter);
    uint64_t hash = 0xcbf29ce484222325u;
    add_bytes(hash, arrays.triangles);
    add_bytes(hash, arrays.materials);
    add_bytes(hash, arrays.area_lights);
    add_bytes(hash, arrays.point_lights);
    add_bytes(hash, arrays.texels);
    return fmt::format("fnv1a-{:016x}", hash);
}

// As a file gives it back: matrices are single precision there.
Attribute stored(const Attribute& value) {
    const M44d* const matrix = std::get_if<M44d>(&value);
    return matrix == nullptr ? value : Attribute(M44d(Imath::M44f(*matrix)));
}

}  // namespace

ReferenceFacts find_facts(const ReferenceJob& job, const RenderSettings& settings) {
    ReferenceFacts facts{compute_radiometry(job.scene), 0};
    if (job.integrator == IntegratorKind::path) return facts;
    facts.d_max = resolve_max_distance(settings.d_max, job.scene);
    check_ambient(job.scene, facts.radiometry, settings);
    return facts;
}

void describe_reference(const ReferenceJob& job, const RenderSettings& settings, const ReferenceFacts& facts,
                        Image& image) {
    RenderResult described;
    described.settings = settings;
    described.radiometry = facts.radiometry;
    described.d_max = facts.d_max;
    describe({job.scene, settings, {}}, tracer_name() + ", double precision", described);
    image.attributes = std::move(described.image.attributes);
    const bool path = job.integrator == IntegratorKind::path;
    for (const char* name : NOT_OF_PATHS)
        if (path) image.attributes.erase(name);
    image.attributes[attribute::INTEGRATOR] = std::string(path ? "path" : "obscurance");
    image.attributes[attribute::SET_SPP] = int64_t{settings.spp};
    image.attributes[attribute::SCENE_DIGEST] = scene_digest(job.scene, settings.filter);
    image.attributes[attribute::PLANNED_SPP] = int64_t{settings.spp} * job.sets;
}

void describe_progress(uint64_t passes, uint64_t finished_sets, ReferenceResult& result,
                       const Image* previous) {
    auto& attributes = result.image.attributes;
    attributes[attribute::SPP] = static_cast<int64_t>(passes);
    attributes[attribute::SETS] = static_cast<int64_t>(finished_sets);
    attributes[attribute::COMPLETE] = std::string(result.complete ? "yes" : "no");
    double seconds = result.seconds;
    if (previous != nullptr) seconds += std::get<double>(previous->attributes.at(attribute::SECONDS));
    attributes[attribute::SECONDS] = seconds;
}

uint64_t passes_to_continue(const Image& previous, std::string_view file, const Image& image) {
    if (!previous.attributes.contains(attribute::INTEGRATOR)) {
        const bool rendered = previous.attributes.contains(attribute::OBSCURANCE_RAYS);
        throw InputError("{} was not made by obscura reference{}", file,
                         rendered ? ", but by obscura render" : "");
    }
    const auto check = [&](const Shaper& shaper) {
        const auto wanted = image.attributes.find(shaper.attribute);
        if (wanted == image.attributes.end()) return;  // a path tracer ignores it
        const auto found = previous.attributes.find(shaper.attribute);
        if (found == previous.attributes.end())
            throw InputError("{}: its header has no {}", file, shaper.attribute);
        if (stored(found->second) == stored(wanted->second)) return;
        throw InputError("{} was made {} ({}: {}, not {})", file, shaper.difference, shaper.attribute,
                         attribute_text(found->second), attribute_text(wanted->second));
    };
    check(SHAPERS.front());
    const auto window = [](const Image& i) {
        return fmt::format("{} x {}, columns {} to {}, rows {} to {}", i.full_width, i.full_height, i.x0,
                           i.x1, i.y0, i.y1);
    };
    if (window(previous) != window(image))
        throw InputError("{} was made with another --width, --height or --cropwindow (pixels: {}, not {})",
                         file, window(previous), window(image));
    std::ranges::for_each(SHAPERS, check);
    // And whatever else the header tells of, now or one day.
    for (const auto& [name, value] : image.attributes)
        if (std::ranges::find(PROGRESS, name) == PROGRESS.end()) check({name.c_str(), "otherwise"});
    const auto passes = previous.attributes.find(attribute::SPP);
    const auto seconds = previous.attributes.find(attribute::SECONDS);
    const auto end = previous.attributes.end();
    if (passes == end || !std::holds_alternative<int64_t>(passes->second) || seconds == end ||
        !std::holds_alternative<double>(seconds->second) || std::get<int64_t>(passes->second) < 1) {
        throw InputError("{}: its header doesn't tell how far it is", file);
    }
    return static_cast<uint64_t>(std::get<int64_t>(passes->second));
}

}  // namespace obscura::reference
