// SPDX-License-Identifier: Apache-2.0
// A tessellated sphere seen from one of its own facets. The facet's foot is the point nearest to the centre, where
// the facet's normal points at the centre; the mesh lies between the spheres through its nearest facet and through
// its vertices, which brackets every distance from the foot, and so W.
#pragma once

#include <algorithm>
#include <cmath>

#include "scene/scene.h"
#include "scene/settings.h"

namespace obscura::test {

struct SphereFacet {
    V3d foot;             // m, from the centre at the origin
    double distance = 0;  // of the foot from the centre
    double inner = 0;     // radius of the sphere that touches the nearest facet
    double outer = 0;     // radius of the sphere through the vertices
};

struct Bracket {
    double low = 0, high = 0;
};

// The facet that faces `direction`, of the scene's first object: a sphere about the origin.
inline SphereFacet find_facet(const Scene& scene, const V3d& direction) {
    SphereFacet facet;
    facet.inner = 1e300;
    double best = -2;
    for (uint32_t i = 0; i < scene.objects.front().triangle_count; ++i) {
        const V3d corner(scene.corner(i, 0).position);
        V3d normal = geometric_normal(scene, i);
        if (normal.dot(corner) < 0) normal = -normal;
        const double distance = normal.dot(corner);
        facet.inner = std::min(facet.inner, distance);
        facet.outer = std::max(facet.outer, corner.length());
        const double facing = normal.dot(direction.normalized());
        if (facing <= best) continue;
        best = facing;
        facet.foot = distance * normal;
        facet.distance = distance;
    }
    return facet;
}

// Colourless W at the foot: W = 2 int_0^1 c rho(d(c)) dc, c the cosine to the normal, for the inner and for the
// outer sphere; d_max in metres.
inline Bracket facet_obscurance(const SphereFacet& facet, const Falloff& falloff, double d_max) {
    constexpr int STEPS = 200000;
    const auto obscurance = [&](double radius) {
        double sum = 0;
        for (int i = 0; i < STEPS; ++i) {
            const double c = (i + 0.5) / STEPS;
            const double along = facet.distance * c;
            const double root2 = along * along + radius * radius - facet.distance * facet.distance;
            const double d = along + std::sqrt(std::max(0.0, root2));
            sum += 2 * c * (d < d_max ? falloff_value(falloff, d / d_max) : 1.0);
        }
        return sum / STEPS;
    };
    return {obscurance(facet.inner), obscurance(facet.outer)};
}

}  // namespace obscura::test
