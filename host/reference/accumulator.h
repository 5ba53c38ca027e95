// SPDX-License-Identifier: Apache-2.0
// What the samples of a reference picture add up to: sums, and the variance between independent sets of samples. A
// picture carries its accumulator along as two layers of floats, so that a later run goes on exactly where it ended.
#pragma once

#include "film/image.h"
#include "reference/integrator.h"

#include <cstdint>
#include <span>
#include <vector>

namespace obscura::reference {

// What some diffuse surface has reflected: beauty without lights and sky, seen as they are or mirrored.
inline constexpr const char* DIFFUSE_LAYER = "diffuse";
// The variance of the means of beauty, of that, and of the obscurance.
inline constexpr const char* VARIANCE_LAYER = "Variance";
inline constexpr const char* DIFFUSE_VARIANCE_LAYER = "Variance.diffuse";
inline constexpr const char* OBSCURANCE_VARIANCE_LAYER = "Variance.obscurance";

class Accumulator {
  public:
    // passes_per_set: samples of a pixel in a set.
    Accumulator(size_t pixel_count, uint32_t passes_per_set);

    // Memory of a pixel here and in its picture.
    static uint64_t bytes_per_pixel();

    // One more sample of every pixel.
    void add_pass(std::span<const PathLight> pixels);

    uint64_t passes() const { return passes_; }
    uint64_t finished_sets() const { return passes_ / passes_per_set_; }

    // Appends beauty and diffuse, with parts the layers it consists of and the obscurance, the variance of these means once
    // two sets are finished, and the state.
    void develop(Image& image, bool parts) const;
    // Takes the state of a picture of `passes` passes; false if it holds none.
    bool restore(const Image& image, uint64_t passes);

  private:
    void close_set(double* sets) const;

    uint32_t passes_per_set_;
    uint64_t passes_ = 0;
    std::vector<double> values_;  // of each pixel VALUE_COUNT numbers
};

}  // namespace obscura::reference
