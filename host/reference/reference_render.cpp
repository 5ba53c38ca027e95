// SPDX-License-Identifier: Apache-2.0
#include "reference/reference_render.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/stopwatch.h"
#include "base/units.h"
#include "reference/accumulator.h"
#include "reference/camera_rays.h"
#include "reference/describe_reference.h"
#include "sampling/sample_order.h"
#include "wavefront/describe.h"
#include "wavefront/frame.h"
#include "wavefront/plan.h"

#include <tbb/parallel_for.h>

#include <atomic>
#include <mutex>

namespace obscura::reference {
namespace {

// What every pass needs.
struct Renderer {
    const CameraRays& camera;
    const Integrator& integrator;
    PixelRect rect;

    // One sample of each pixel; report returns false to stop, and then so does this.
    template <typename Report>
    bool render_pass(const SamplePlan& plan, uint32_t sample, std::vector<PathLight>& pixels,
                     const Report& report) const;
};

template <typename Report>
bool Renderer::render_pass(const SamplePlan& plan, uint32_t sample, std::vector<PathLight>& pixels,
                           const Report& report) const {
    std::atomic<bool> stopped{false};
    std::mutex reporting;
    tbb::parallel_for(rect.y0, rect.y1, [&](uint32_t y) {
        if (stopped) return;
        for (uint32_t x = rect.x0; x < rect.x1; ++x) {
            const PathSampler sampler(plan, x, y, sample);
            pixels[size_t{y - rect.y0} * rect.width() + (x - rect.x0)] =
                integrator.estimate(camera.ray(x, y, sampler), sampler);
        }
        const std::lock_guard lock(reporting);
        if (!stopped && !report(rect.width())) stopped = true;
    });
    return !stopped;
}

std::unique_ptr<Integrator> make_integrator(const ReferenceJob& job, const RenderSettings& settings,
                                            const World& world, const ReferenceFacts& facts) {
    if (job.integrator == IntegratorKind::path) return make_path_integrator(world, settings);
    return make_obscurance_integrator(world, settings, facts.radiometry, facts.d_max / job.scene.unit);
}

void check_memory(const PixelRect& rect) {
    const uint64_t bytes = rect.pixel_count() * (Accumulator::bytes_per_pixel() + sizeof(PathLight));
    if (bytes <= physical_memory_bytes()) return;
    throw InputError(
        "{} x {} pixels take {} of memory, and this machine has {}; compute fewer (--cropwindow)",
        rect.width(), rect.height(), bytes_text(bytes), bytes_text(physical_memory_bytes()));
}

}  // namespace

ReferenceResult render_reference(const ReferenceJob& job, const ReferenceCallback& report) {
    const RenderSettings settings = with_default_sky(job.scene, job.settings);
    const ReferenceFacts facts = find_facts(job, settings);
    const Camera& camera = select_camera(job.scene, settings);
    check_aspect(settings, camera.aspect_ratio);
    const PixelRect rect = crop_pixels(settings.crop, settings.width, settings.height);
    check_memory(rect);
    ReferenceResult result;
    place_image(result.image, settings, rect);
    describe_reference(job, settings, facts, result.image);
    const uint64_t planned = uint64_t{settings.spp} * job.sets;
    Accumulator accumulator(rect.pixel_count(), settings.spp);
    if (job.previous != nullptr) {
        const uint64_t passes = passes_to_continue(*job.previous, job.previous_file, result.image);
        if (!accumulator.restore(*job.previous, passes))
            throw InputError("{} holds no sums to go on with", job.previous_file);
        if (passes > planned) {
            throw InputError("{} has {} samples per pixel already, more than the {} of --sets {} of --spp {}",
                             job.previous_file, passes, planned, job.sets, settings.spp);
        }
    }

    const World world(job.scene, settings);
    const std::unique_ptr<Integrator> integrator = make_integrator(job, settings, world, facts);
    const CameraRays rays(camera, settings);
    const Renderer renderer{rays, *integrator, rect};
    const std::vector<uint32_t> order = bit_reversed_order(settings.spp);
    const auto all = static_cast<double>(planned * rect.pixel_count());
    std::vector<PathLight> pixels(rect.pixel_count());
    const uint64_t samples_before = accumulator.passes() * rect.pixel_count();
    const auto report_samples = [&](uint64_t samples) {
        result.samples += samples;
        return report(static_cast<double>(samples_before + result.samples) / all, result.samples);
    };
    const Stopwatch watch;
    while (result.complete && accumulator.passes() < planned) {
        const SamplePlan plan(settings, settings.seed + accumulator.finished_sets());
        const auto sample = static_cast<size_t>(accumulator.passes() % settings.spp);
        result.complete = renderer.render_pass(plan, order[sample], pixels, report_samples);
        if (!result.complete) break;
        accumulator.add_pass(pixels);
        for (const PathLight& pixel : pixels)
            result.rays += pixel.rays;
    }
    result.seconds = watch.seconds();
    if (accumulator.passes() == 0) return result;
    accumulator.develop(result.image, job.integrator == IntegratorKind::obscurance);
    describe_progress(accumulator.passes(), accumulator.finished_sets(), result, job.previous);
    return result;
}

}  // namespace obscura::reference
