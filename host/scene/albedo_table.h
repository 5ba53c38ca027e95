// SPDX-License-Identifier: Apache-2.0
// Directional albedo of a GGX lobe with Schlick's Fresnel: a(mu) = F0 A(mu, alpha) + F90 B(mu, alpha), the
// share of light from the cosine mu that a single bounce between microfacets reflects (split sum; Karis
// 2013). A + B <= 1; what is missing is light that would leave after more bounces.
//
// The table is bilinear in mu and sqrt(alpha) (which is glTF's roughness): column i holds mu = i / (SIZE -
// 1), row j holds sqrt(alpha) = j / (SIZE - 1), entries interleaved A, B at 2 (j SIZE + i). Row 0 is Schlick
// itself. Host and kernels read the same floats in the same way.
#pragma once

#include <array>
#include <cstddef>

namespace obscura {

struct AlbedoTable {
    static constexpr size_t SIZE = 32;
    std::array<float, 2 * SIZE * SIZE> values;
};

struct AlbedoTerms {
    double a = 0;  // times F0
    double b = 0;  // times F90
};

// Computed at first use, in a few milliseconds.
const AlbedoTable& albedo_table();

// A, B at one cosine: Schlick for alpha = 0, else from the table.
AlbedoTerms directional_albedo(double mu, double alpha);

// 2 int A mu dmu and 2 int B mu dmu, exactly for what directional_albedo returns.
AlbedoTerms mean_albedo(double alpha);

// A, B by quadrature for alpha > 0; longest: length of the quadrature's intervals, the smaller the more
// accurate. For the table and its tests.
AlbedoTerms integrate_albedo(double mu, double alpha, double longest);

}  // namespace obscura
