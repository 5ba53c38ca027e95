// SPDX-License-Identifier: Apache-2.0
// A whole reference picture: independent sets of samples, each a render of its own with its own seed, and from their
// differences the variance of their mean. Scene and settings in, picture out; the same on any number of threads.
#pragma once

#include "film/image.h"
#include "reference/integrator.h"
#include "scene/scene.h"
#include "scene/settings.h"

#include <functional>
#include <string_view>

namespace obscura::reference {

struct ReferenceJob {
    const Scene& scene;
    RenderSettings settings;  // spp samples of each pixel make a set; set i has the seed settings.seed + i
    IntegratorKind integrator = IntegratorKind::obscurance;
    uint32_t sets = 1;
    const Image* previous = nullptr;      // a picture to go on with, or none
    std::string_view previous_file = {};  // for messages: option and name
};

struct ReferenceResult {
    Image
        image;  // its attributes are filled; without layers if it was stopped before every pixel had a sample
    uint64_t samples = 0;  // camera samples of this run
    uint64_t rays = 0;     // of this run
    bool complete = true;  // false: stopped early
    double seconds = 0;    // of sampling, without what comes before it
};

// Called now and then, by one thread at a time; false stops the render there. What is not yet a sample of every pixel is
// lost then. samples: of this run.
using ReferenceCallback = std::function<bool(double fraction, uint64_t samples)>;

// Throws InputError if the previous picture was made differently, or is no reference picture.
ReferenceResult render_reference(const ReferenceJob& job, const ReferenceCallback& report);

}  // namespace obscura::reference
