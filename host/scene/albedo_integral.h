// SPDX-License-Identifier: Apache-2.0
// Directional albedo of a GGX lobe with Schlick's Fresnel: a(mu) = F0 A(mu, alpha) + F90 B(mu, alpha), the
// share of light from the cosine mu that a single bounce between microfacets reflects (split sum; Karis
// 2013). A + B <= 1; what is missing is light that would leave after more bounces.
#pragma once

namespace obscura {

struct AlbedoTerms {
    double a = 0;  // times F0
    double b = 0;  // times F90
};

// A, B of a mirror, alpha = 0.
AlbedoTerms schlick_albedo(double mu);

// A, B by quadrature for alpha > 0; longest: length of the quadrature's intervals, the smaller the more
// accurate. For the table and its tests.
AlbedoTerms integrate_albedo(double mu, double alpha, double longest);

}  // namespace obscura
