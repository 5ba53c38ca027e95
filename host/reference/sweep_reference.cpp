// SPDX-License-Identifier: Apache-2.0
#include "reference/sweep_reference.h"

#include "base/error.h"
#include "reference/accumulator.h"

namespace obscura {

namespace fs = std::filesystem;
using reference::IntegratorKind;

const char* integrator_name(IntegratorKind integrator) {
    return integrator == IntegratorKind::path ? "path" : "obscurance";
}

std::optional<SweepReference> make_reference(const SweepReferenceJob& job,
                                             const reference::ReferenceCallback& go_on) {
    const fs::path file = job.folder / (std::string(integrator_name(job.integrator)) + ".exr");
    const std::string name = "the reference " + file.string();
    std::optional<Image> previous;
    if (fs::exists(file)) previous = read_exr(file);
    reference::ReferenceJob reference{
        job.scene, job.settings, job.integrator, REFERENCE_SETS, previous ? &*previous : nullptr, name};
    reference.settings.obscurance_rays = PAPER_OBSCURANCE_RAYS;
    reference.settings.spp = 2u << (job.budget_count - 1);
    reference.settings.seed += REFERENCE_SEED_DISTANCE;
    reference::ReferenceResult result = render_reference(reference, go_on);
    if (result.samples > 0 && !result.image.layers.empty()) write_exr(result.image, file);
    if (!result.complete) return std::nullopt;

    SweepReference made{std::move(result.image), {}};
    for (const auto& [layer, variance] : {std::pair{"", reference::VARIANCE_LAYER},
                                          {reference::DIFFUSE_LAYER, reference::DIFFUSE_VARIANCE_LAYER},
                                          {"obscurance", reference::OBSCURANCE_VARIANCE_LAYER}}) {
        const Layer* const mean = made.image.find_layer(layer);
        if (mean != nullptr) made.noise[layer] = measure_noise(*mean, *made.image.find_layer(variance));
    }
    return made;
}

}  // namespace obscura
