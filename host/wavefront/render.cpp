// SPDX-License-Identifier: Apache-2.0
#include "wavefront/render.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <future>

#include "base/error.h"
#include "base/memory.h"
#include "base/stopwatch.h"
#include "base/units.h"
#include "bvh/bvh.h"
#include "film/develop.h"
#include "sampling/pixel_order.h"
#include "sampling/sample_order.h"
#include "wavefront/describe.h"
#include "wavefront/features.h"
#include "wavefront/frame.h"

namespace obscura {
namespace {

StageKernels prepare_kernels(ProgramLibrary& library, const RenderSetup& setup, bool portable) {
    const bool all = setup.settings.needs == NeedsMode::all;
    std::vector<KernelRequest> requests;
    const std::vector<Stage> stages = needed_stages(setup.needs);
    requests.reserve(stages.size());
    for (const Stage stage : stages) {
        requests.push_back(
            {std::string(stage_info(stage).name), stage_options(stage, setup.needs, all, portable)});
    }
    const std::vector<cl::Kernel> built = library.kernels(requests);
    StageKernels kernels;
    for (size_t i = 0; i < stages.size(); ++i)
        kernels[static_cast<uint32_t>(stages[i])] = built[i];
    return kernels;
}

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

std::map<std::string, uint64_t> peak_bytes(const Device& device) {
    std::map<std::string, uint64_t> bytes;
    for (const char* category : {"scene", "bvh", "queues", "film"}) {
        bytes[category] = device.memory().peak_bytes(category);
    }
    bytes["peak_device"] = device.memory().peak_bytes();
    return bytes;
}

}  // namespace

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
    return render_scene(device, library, job, set_up_render(job), after_wave);
}

RenderResult render_scene(Device& device, ProgramLibrary& library, const RenderJob& job,
                          const RenderSetup& setup, const RenderCallback& after_wave) {
    device.memory().reset_peaks();
    RenderResult result;
    const RenderSettings& settings = setup.settings;
    const LayerPlanes& planes = setup.planes;
    const PixelRect& rect = setup.rect;
    result.settings = settings;
    result.needs = setup.needs;
    result.planes = planes;
    // The builder works on one core, everything up to the upload on another.
    const std::shared_future<Bvh> building = job.bvh.valid() ? job.bvh : start_building(job, device.trace());
    result.d_max = resolve_max_distance(settings.d_max, job.scene);
    result.radiometry = compute_radiometry(job.scene);
    check_ambient(job.scene, result.radiometry, settings);
    const Stopwatch compile_watch;
    const StageKernels kernels = prepare_kernels(library, setup, job.portable);
    result.seconds.compile = compile_watch.seconds();
    const SceneArrays arrays = make_scene_arrays(job.scene, settings.filter);
    const Bvh& bvh = building.get();
    result.seconds.build = bvh.build_seconds;

    const Stopwatch upload_watch;
    const SceneBuffers scene = upload_scene(device, arrays, bvh);
    const uint64_t max_allocation = device.info().max_allocation_bytes;
    const QueueShape shape = queue_shape(result.needs, settings, plane_count(planes));
    result.shape = shape;
    const std::vector<PixelRect> bands = film_bands(rect, shape.layer_planes, max_allocation);
    const uint64_t sample_count = bands.front().pixel_count() * settings.spp;
    result.wave_capacity = wave_capacity(shape, job.wave_size, job.queue_bytes, max_allocation, sample_count);
    const auto largest_band = static_cast<uint32_t>(bands.front().pixel_count());
    Queues queues =
        allocate_queues(device, shape, result.wave_capacity, largest_band, bit_reversed_order(settings.spp));
    result.seconds.upload = upload_watch.seconds();

    std::optional<VisitRecorder> visits;
    if (job.count_visits)
        visits.emplace(device, library, result.needs, settings.needs == NeedsMode::all, job.portable, scene);

    place_image(result.image, settings, rect);
    const Stopwatch render_watch;
    Profiler profiler(device.name());
    Scheduler scheduler(device, kernels, scene, queues, library.local_size(), profiler);
    scheduler.observe(job.observer);
    if (visits) scheduler.observe(std::bind_front(&VisitRecorder::observe, &*visits));
    const FrameInput input{job.scene,
                           settings,
                           result.radiometry,
                           result.needs,
                           planes,
                           static_cast<uint32_t>(arrays.area_lights.size()),
                           static_cast<uint32_t>(arrays.point_lights.size()),
                           result.d_max};
    const uint64_t all = rect.pixel_count() * settings.spp;
    uint64_t samples_before = 0;
    result.samples_per_pixel = settings.spp;
    result.complete = after_wave(0, {});
    for (const PixelRect& band : bands) {
        const uint64_t band_samples = band.pixel_count() * settings.spp;
        const auto report = [&](uint64_t done, const RayCounts& rays) {
            const uint64_t finished = samples_before + done;
            return after_wave(static_cast<double>(finished) / static_cast<double>(all), rays) ||
                   finished == all;
        };
        const Frame frame = make_frame(input, band, result.wave_capacity);
        const std::vector<uint32_t> pixel_order = tiled_pixel_order(band.width(), band.height());
        queues.pixel_order.upload(pixel_order);
        // Once stopped, the remaining bands stay black.
        const uint64_t done = result.complete ? scheduler.render(frame, report) : 0;
        result.complete = result.complete && done == band_samples;
        const uint64_t passes = done / band.pixel_count();
        result.samples_per_pixel = std::min(result.samples_per_pixel, static_cast<uint32_t>(passes));
        std::vector<FilmSum> sums(band.pixel_count() * shape.layer_planes);
        if (done > 0) queues.film.download(sums);
        const TraceStep step(device.trace(), TraceCategory::host, "develop");
        develop_band({planes, sums, pixel_order, passes, done % band.pixel_count()}, job.layers,
                     result.image);
        if (visits) visits->finish_band(pixel_order, passes, done % band.pixel_count());
        samples_before += band_samples;
    }
    result.seconds.render = render_watch.seconds();
    if (visits) {
        result.visits = visits->visits();
        result.seconds.render -= result.visits->seconds;
    }
    result.rays = scheduler.rays();
    result.profile = profiler.rows();
    result.bytes = peak_bytes(device);
    describe(job, device.name(), result);
    return result;
}

}  // namespace obscura
