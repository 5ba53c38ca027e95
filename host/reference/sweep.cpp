// SPDX-License-Identifier: Apache-2.0
#include "reference/sweep.h"

#include "reference/accumulator.h"

#include <algorithm>
#include <array>
#include <functional>

namespace obscura {

using reference::IntegratorKind;

namespace {

// As PathLight::diffuse().
constexpr std::array DIFFUSE_PARTS = {"direct", "ambient", "specular.direct", "specular.ambient"};

Layer diffuse_layer(const Image& image) {
    Layer sum = *image.find_layer(DIFFUSE_PARTS.front());
    sum.name = reference::DIFFUSE_LAYER;
    for (size_t part = 1; part < DIFFUSE_PARTS.size(); ++part)
        std::ranges::transform(sum.pixels, image.find_layer(DIFFUSE_PARTS[part])->pixels, sum.pixels.begin(),
                               std::plus<>());
    return sum;
}

}  // namespace

double SweepTask::cost() const {
    // Of a sample beside its obscurance rays: camera and shadow ray, shading. A path on the host has several rays, each
    // many times as slow.
    constexpr double SAMPLE = 3, PATH = 40;
    const double samples = method.samples(budget);
    const bool traces = !method.path_traced && method.settings.ambient == Ambient::obscurance;
    return runs * (method.path_traced ? PATH * samples : SAMPLE * samples + (traces ? budget : 0));
}

std::vector<SweepTask> plan_sweep(const std::vector<SweepMethod>& methods, uint32_t budget_count,
                                  uint32_t seed_count) {
    std::vector<SweepTask> tasks;
    for (uint32_t seed = 0; seed < seed_count; seed += 2) {
        for (uint32_t step = 0; step < budget_count; ++step) {
            for (const SweepMethod& method : methods)
                tasks.push_back(
                    {method, method.budgets(budget_count)[step], seed, std::min(2u, seed_count - seed)});
        }
    }
    return tasks;
}

SweepRenderer::SweepRenderer(Device& device, ProgramLibrary& library, const RenderJob& base,
                             const SweepReferences& references)
    : device_(device), library_(library), base_(base), references_(references) {
    if (!base_.bvh.valid()) base_.bvh = start_building(base_, device.trace());
}

std::optional<SweepRenderer::Picture> SweepRenderer::render(const SweepTask& task, uint64_t seed,
                                                            const GoOn& go_on) {
    RenderSettings settings = task.method.settings;
    settings.spp = task.method.samples(task.budget);
    settings.seed = base_.settings.seed + seed;
    if (task.method.path_traced) {
        const reference::ReferenceJob job{base_.scene, settings, IntegratorKind::path};
        reference::ReferenceResult result = render_reference(job, [&](double, uint64_t) { return go_on(); });
        if (!result.complete) return std::nullopt;
        return Picture{std::move(result.image), result.seconds, result.rays};
    }
    RenderJob job = base_;
    job.settings = settings;
    job.portable = base_.portable || task.method.portable;
    job.layers.assign(DIFFUSE_PARTS.begin(), DIFFUSE_PARTS.end());
    if (task.method.reference == IntegratorKind::obscurance) job.layers.emplace_back("obscurance");
    RenderResult result =
        render_scene(device_, library_, job, [&](double, const RayCounts&) { return go_on(); });
    if (!result.complete) return std::nullopt;
    result.image.layers.push_back(diffuse_layer(result.image));
    return Picture{std::move(result.image), result.seconds.render, result.rays.total()};
}

std::optional<SweepResult> SweepRenderer::run(const SweepTask& task, const GoOn& go_on,
                                              const OnPicture& on_picture) {
    const Image& reference = references_.at(task.method.reference).image;
    SweepResult result{task.method.name, task.budget, task.first_seed, {}, {}};
    std::vector<Image> pictures;
    for (uint64_t seed = task.first_seed; seed < task.first_seed + task.runs; ++seed) {
        std::optional<Picture> picture = render(task, seed, go_on);
        if (!picture) return std::nullopt;
        on_picture(seed, picture->image);
        SweepRun run{picture->seconds, picture->rays, {}};
        for (const std::string& layer : task.method.layers())
            run.errors[layer] =
                measure_errors(*picture->image.find_layer(layer), *reference.find_layer(layer));
        result.runs.push_back(std::move(run));
        pictures.push_back(std::move(picture->image));
    }
    if (pictures.size() < 2) return result;
    for (const std::string& layer : task.method.layers()) {
        result.common[layer] = measure_common_errors(
            *pictures[0].find_layer(layer), *pictures[1].find_layer(layer), *reference.find_layer(layer));
    }
    return result;
}

}  // namespace obscura
