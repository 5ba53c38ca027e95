// SPDX-License-Identifier: Apache-2.0
#include "wavefront/render.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <future>
#include <limits>

#include "base/error.h"
#include "base/memory.h"
#include "base/stopwatch.h"
#include "base/units.h"
#include "bvh/bvh.h"
#include "film/develop.h"
#include "sampling/pixel_order.h"
#include "wavefront/describe.h"
#include "wavefront/frame.h"
#include "wavefront/team.h"

namespace obscura {
namespace {

std::vector<uint32_t> wanted_layers(const std::vector<std::string>& names) {
    std::vector<uint32_t> layers;
    layers.reserve(names.size());
    for (const std::string& name : names)
        layers.push_back(layer_info(name).layer);
    return layers;
}

// The layers in host memory and the film's sums on their way to them; what Blender's names add to the layers takes less
// than the sums, which are gone by then. A system that overcommits its memory would end the program half-way.
void check_picture_memory(const PixelRect& rect, const std::vector<std::string>& names,
                          uint32_t film_planes) {
    uint64_t channels = 4;  // of beauty
    for (const std::string& name : names)
        channels += layer_info(name).channels.size();
    const uint64_t bytes = rect.pixel_count() * (channels * sizeof(float) + film_planes * sizeof(FilmSum));
    if (bytes <= physical_memory_bytes()) return;
    throw InputError(
        "{} x {} pixels with {} take {} of memory, and this machine has {}; render fewer pixels "
        "(--cropwindow) or layers (--layers)",
        rect.width(), rect.height(), counted(names.size() + 1, "layer"), bytes_text(bytes),
        bytes_text(physical_memory_bytes()));
}

// Rows of the picture that the film holds at once.
struct Band {
    PixelRect rect;
    std::vector<uint32_t> pixel_order;
};

std::vector<Band> plan_bands(const PixelRect& rect, uint32_t layer_planes, uint64_t max_film_bytes) {
    std::vector<Band> bands;
    for (const PixelRect& band : film_bands(rect, layer_planes, max_film_bytes))
        bands.push_back({band, tiled_pixel_order(band.width(), band.height())});
    return bands;
}

// Renders a band of rect into the image. Once the render is stopped, the remaining bands stay black.
void render_band(Team& team, const FrameInput& input, const Band& band, const PixelRect& rect,
                 const PieceSize& piece, TraceRecord* trace, RenderResult& result) {
    const std::span<const uint32_t> pixel_order = band.pixel_order;
    const auto pixels = static_cast<uint32_t>(pixel_order.size());
    const uint32_t spp = input.settings.spp;
    const size_t first_pixel = uint64_t{band.rect.y0 - rect.y0} * rect.width();
    PixelNodes pixel_nodes(result.nodes_per_sample.empty() ? 0 : pixels);
    WorkList list(pixels, spp, piece);
    std::vector<FilmRange> film(list.range_count());
    if (result.complete) team.render(make_frame(input, band.rect, 0), pixel_order, list, film, pixel_nodes);

    const TraceStep step(trace, TraceCategory::host, "develop");
    size_t place = 0;
    for (const FilmRange& range : film) {
        const size_t count = std::min<size_t>(piece.pixel_count, pixels - place);
        const auto order = pixel_order.subspan(place, count);
        place += count;
        result.samples_per_pixel =
            std::min(result.samples_per_pixel, static_cast<uint32_t>(range.samples.passes));
        if (range.samples.at(0) == 0) continue;
        team.read_sums(range, static_cast<uint32_t>(count), [&](std::span<const FilmSum> sums) {
            develop({input.planes, sums, order, range.samples, first_pixel}, result.image);
        });
        if (!pixel_nodes.empty())
            average_nodes(pixel_nodes, order, range.samples,
                          std::span(result.nodes_per_sample).subspan(first_pixel));
    }
    result.complete = result.complete && result.samples_per_pixel == spp;
}

void add(DeviceWork& sum, const DeviceWork& work) {
    sum.rays += work.rays;
    sum.wave_capacity += work.wave_capacity;
    for (const auto& [name, row] : work.profile)
        sum.profile[name] += row;
    for (const auto& [name, bytes] : work.bytes)
        sum.bytes[name] += bytes;
    if (!work.visits) return;
    for (size_t i = 0; i < RAY_QUEUES.size(); ++i)
        sum.visits->queues[i].add(work.visits->queues[i]);
    sum.visits->seconds += work.visits->seconds;
}

// The devices' work, and its sum.
void collect_work(const Team& team, const LayerPlanes& planes, RenderResult& result) {
    result.devices = team.work();
    for (DeviceWork& device : result.devices)
        device.planes = planes;
    DeviceWork& sum = result;
    sum = result.devices.front();
    for (size_t i = 1; i < result.devices.size(); ++i)
        add(sum, result.devices[i]);
    // They count side by side.
    if (sum.visits) sum.visits->seconds /= static_cast<double>(result.devices.size());
}

uint64_t smallest_allocation(std::span<const RenderDevice> devices) {
    uint64_t bytes = std::numeric_limits<uint64_t>::max();
    for (const RenderDevice& device : devices)
        bytes = std::min(bytes, device.device.info().max_allocation_bytes);
    return bytes;
}

}  // namespace

std::string device_names(std::span<const RenderDevice> devices) {
    std::vector<std::string> names;
    names.reserve(devices.size());
    for (const RenderDevice& device : devices)
        names.push_back(device.device.name());
    return fmt::format("{}", fmt::join(names, ", "));
}

RenderSetup set_up_render(const RenderJob& job) {
    RenderSetup setup;
    setup.settings = with_default_sky(job.scene, job.settings);
    check_aspect(setup.settings, select_camera(job.scene, setup.settings).aspect_ratio);
    setup.needs = analyse_needs(job.scene, setup.settings);
    setup.planes = assign_planes(setup.needs, wanted_layers(job.layers));
    setup.rect = crop_pixels(setup.settings.crop, setup.settings.width, setup.settings.height);
    check_picture_memory(setup.rect, job.layers, plane_count(setup.planes));
    return setup;
}

std::shared_future<Bvh> start_building(const RenderJob& job, TraceRecord* trace) {
    return std::async(std::launch::async, [&scene = job.scene, quality = job.bvh_quality, trace] {
        const TraceStep step(trace, TraceCategory::host, "build BVH");
        return build_bvh(scene, quality);
    });
}

RenderResult render_scene(Device& device, ProgramLibrary& library, const RenderJob& job,
                          const RenderCallback& after_wave) {
    const RenderDevice only{device, library};
    return render_scene(std::span(&only, 1), job, after_wave);
}

RenderResult render_scene(std::span<const RenderDevice> devices, const RenderJob& job,
                          const RenderCallback& after_wave) {
    return render_scene(devices, job, set_up_render(job), after_wave);
}

RenderResult render_scene(std::span<const RenderDevice> devices, const RenderJob& job,
                          const RenderSetup& setup, const RenderCallback& after_wave) {
    OBSCURA_CHECK(!devices.empty() && (devices.size() == 1 || !job.observer), "an observer of {}",
                  counted(devices.size(), "device"));
    for (const RenderDevice& device : devices)
        device.device.memory().reset_peaks();
    TraceRecord* const trace = devices.front().device.trace();
    RenderResult result;
    const RenderSettings& settings = setup.settings;
    const LayerPlanes& planes = setup.planes;
    const PixelRect& rect = setup.rect;
    result.settings = settings;
    result.needs = setup.needs;

    // The builder works on one core, everything up to the upload on another, also what only the end of the render needs.
    const std::shared_future<Bvh> building = job.bvh.valid() ? job.bvh : start_building(job, trace);
    result.d_max = resolve_max_distance(settings.d_max, job.scene);
    result.radiometry = compute_radiometry(job.scene);
    check_ambient(job.scene, result.radiometry, settings);
    const Stopwatch compile_watch;
    Team team(devices, job, result.needs, rect.pixel_count() * settings.spp, after_wave);
    result.seconds.compile = compile_watch.seconds();
    const SceneArrays arrays = make_scene_arrays(job.scene, settings.filter);
    const QueueShape shape = queue_shape(result.needs, settings, plane_count(planes));
    const std::vector<Band> bands = plan_bands(rect, shape.layer_planes, smallest_allocation(devices));
    const PieceSize piece = piece_size(static_cast<uint32_t>(bands.front().pixel_order.size()), settings.spp,
                                       job.wave_size, devices.size());
    place_image(result.image, settings, rect);
    add_layers(job.layers, result.image);
    if (job.count_visits) result.nodes_per_sample.resize(rect.pixel_count());
    const Bvh& bvh = building.get();
    result.seconds.build = bvh.build_seconds;

    const Stopwatch upload_watch;
    team.upload(arrays, bvh, shape, piece);
    result.seconds.upload = upload_watch.seconds();

    const Stopwatch render_watch;
    const FrameInput input{job.scene,
                           settings,
                           result.radiometry,
                           result.needs,
                           planes,
                           static_cast<uint32_t>(arrays.area_lights.size()),
                           static_cast<uint32_t>(arrays.point_lights.size()),
                           result.d_max};
    result.samples_per_pixel = settings.spp;
    result.complete = after_wave(0, {});
    for (const Band& band : bands)
        render_band(team, input, band, rect, piece, trace, result);
    result.seconds.render = render_watch.seconds();
    collect_work(team, planes, result);
    if (result.visits) result.seconds.render -= result.visits->seconds;
    describe(job, device_names(devices), result);
    return result;
}

}  // namespace obscura
