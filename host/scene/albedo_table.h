// SPDX-License-Identifier: Apache-2.0
// Table of the directional albedo, bilinear in mu and sqrt(alpha) (which is glTF's roughness): column i holds mu = i / (SIZE
// - 1), row j holds sqrt(alpha) = j / (SIZE - 1), entries interleaved A, B at 2 (j SIZE + i). Row 0 is Schlick
// itself. Host and kernels read the same floats in the same way.
#pragma once

#include "scene/albedo_integral.h"

#include <array>
#include <cstddef>

namespace obscura {

struct AlbedoTable {
    static constexpr size_t SIZE = 32;
    std::array<float, 2 * SIZE * SIZE> values;
};

extern const AlbedoTable ALBEDO_TABLE;  // written when the program is built, by tabulate_albedo.cpp

// A, B at one cosine: Schlick for alpha = 0, else from the table.
AlbedoTerms directional_albedo(double mu, double alpha);

// 2 int A mu dmu and 2 int B mu dmu, exactly for what directional_albedo returns.
AlbedoTerms mean_albedo(double alpha);

}  // namespace obscura
