// SPDX-License-Identifier: Apache-2.0
// The renders of `obscura sweep`: each method with each budget and seed, on one device and with kernels that are compiled
// once. Two seeds at a time, so that two independent pictures are there to tell noise from bias; in rounds over all
// methods, so that whatever else the machine does in a bad minute weighs on all of them.
#pragma once

#include "bvh/bvh.h"
#include "device/program.h"
#include "reference/reference_render.h"
#include "reference/sweep_errors.h"
#include "reference/sweep_methods.h"
#include "wavefront/render.h"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace obscura {

// One method with one budget and two seeds; one where their number is odd.
struct SweepTask {
    SweepMethod method;
    uint32_t budget = 0;
    uint64_t first_seed = 0;  // counted from 0
    uint32_t runs = 2;

    double cost() const;  // expected, for the time that is left; unit: a ray of the device
};

// The order in which they are done.
std::vector<SweepTask> plan_sweep(const std::vector<SweepMethod>& methods, uint32_t budget_count,
                                  uint32_t seed_count);

struct SweepRun {
    double seconds = 0;  // of rendering: without scene, kernels, BVH
    uint64_t rays = 0;
    std::map<std::string, LayerErrors> errors;  // by layer
};

struct SweepResult {
    std::string method;
    uint32_t budget = 0;
    uint64_t first_seed = 0;
    std::vector<SweepRun> runs;                  // with the seeds from first_seed on
    std::map<std::string, CommonErrors> common;  // of two runs, by layer
};

// A reference with what its own noise adds to the errors, by layer.
struct SweepReference {
    Image image;
    std::map<std::string, ReferenceNoise> noise;
};
using SweepReferences = std::map<reference::IntegratorKind, SweepReference>;

// The settings of seed 0; the references have others, so that they are independent.
inline constexpr uint64_t REFERENCE_SEED_DISTANCE = uint64_t{1} << 32;

class SweepRenderer {
  public:
    // base: what settings.seed the seeds are counted from, and all of the job that isn't a method's.
    SweepRenderer(Device& device, ProgramLibrary& library, const RenderJob& base,
                  const SweepReferences& references);

    // False from go_on stops the render in hand, and nothing is returned. on_picture takes every picture.
    using GoOn = std::function<bool()>;
    using OnPicture = std::function<void(uint64_t seed, const Image& picture)>;
    std::optional<SweepResult> run(const SweepTask& task, const GoOn& go_on, const OnPicture& on_picture);

  private:
    struct Picture {
        Image image;
        double seconds;
        uint64_t rays;
    };
    std::optional<Picture> render(const SweepTask& task, uint64_t seed, const GoOn& go_on);

    Device& device_;
    ProgramLibrary& library_;
    RenderJob base_;
    const SweepReferences& references_;
};

}  // namespace obscura
