// SPDX-License-Identifier: Apache-2.0
#include "reference/check.h"

#include "bvh/bvh.h"
#include "wavefront/features.h"

namespace obscura {
namespace {

enum QueueIndex : size_t { CAMERA, SHADOW, GLOSSY, OBSCURANCE };

}  // namespace

bool QueueCheck::passes() const {
    const auto doubtful = static_cast<double>(rays.ties + rays.edges);
    return rays.device_wrong == 0 &&
           (aimed || doubtful <= MAX_DOUBTFUL_SHARE * static_cast<double>(rays.rays));
}

SceneCheck check_scene(Device& device, ProgramLibrary& library, RenderJob job,
                       const RenderCallback& after_wave) {
    const HitComparison hits(job.scene);
    const ResultComparison results(job.scene, job.settings, hits);
    RayCapture capture(device, library, build_bvh(job.scene),
                       stage_options(Stage::trace, {}, false, job.portable));
    // The oracle tries every triangle: as many tests as a few for every ray.
    const size_t every = 1 + job.scene.triangles.size() / 4;

    SceneCheck check;
    job.observer = [&](const DepthView& view, const Frame& frame, const Queues& queues) {
        const auto compare_hits = [&](const CapturedRays& captured, QueueIndex queue) {
            std::vector<TraceHit> embree(captured.rays.size());
            hits.embree().closest(captured.rays, embree);
            check.queues[queue].rays.add(hits.compare(captured.rays, captured.hits, embree, every));
        };
        compare_hits(capture.traced(view, frame, queues), view.depth == 0 ? CAMERA : GLOSSY);

        QueueCheck& shadow = check.queues[SHADOW];
        shadow.results.add(results.shadow(capture.shadow(view, frame, queues), every, shadow.rays));

        const CapturedRays rays = capture.obscurance(view, frame, queues);
        compare_hits(rays, OBSCURANCE);
        QueueCheck& obscurance = check.queues[OBSCURANCE];
        obscurance.results.add(results.obscurance(rays, frame, every, obscurance.rays));
    };
    check.rendered = render_scene(device, library, job, after_wave).rays;
    return check;
}

}  // namespace obscura
