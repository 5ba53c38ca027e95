// SPDX-License-Identifier: Apache-2.0
// Closed forms of the colourless obscurance W for simple geometry, in units of d_max. Under cosine sampling the
// direction's projection (x, y) is uniform on the unit disc; with g(eta) = eta^2 + 2 int_eta^1 c rho(eta / c) dc
// a parallel plane at height h has W = g(h / d_max), and vertical walls have W = 1/(2 pi) int g(m(phi) / d_max) dphi,
// m = horizontal distance at azimuth phi.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "scene/settings.h"

namespace obscura::test {

inline const Falloff STEP{FalloffKind::step, 1};
inline const Falloff LINEAR{FalloffKind::linear, 1};
inline const Falloff SQRT{FalloffKind::sqrt, 1};
inline const Falloff EXP{FalloffKind::exp, 1};
inline const std::vector<Falloff> MAIN_FALLOFFS{STEP, LINEAR, SQRT, EXP};
inline const std::vector<Falloff> ALL_FALLOFFS{STEP,
                                               LINEAR,
                                               SQRT,
                                               EXP,
                                               {FalloffKind::exp, 5},
                                               {FalloffKind::cbrt, 1},
                                               {FalloffKind::expjump, 1},
                                               {FalloffKind::pow, 0.25}};

// E_3(x) = int_1^inf exp(-x t) / t^3 dt by recurrence from E_1.
inline double exponential_integral_3(double x) {
    if (x <= 0) return 0.5;
    const double e1 = -std::expint(-x);
    return 0.5 * (std::exp(-x) * (1 - x) + x * x * e1);
}

// W below an infinite parallel plane at height eta d_max.
inline double plane_obscurance(const Falloff& falloff, double eta) {
    if (eta >= 1) return 1;
    const double eta2 = eta * eta;
    const auto power = [&](double p) { return (2 * std::pow(eta, p) - p * eta2) / (2 - p); };
    switch (falloff.kind) {
        case FalloffKind::step:
            return eta2;
        case FalloffKind::linear:
            return power(1);
        case FalloffKind::sqrt:
            return power(0.5);
        case FalloffKind::cbrt:
            return power(1.0 / 3);
        case FalloffKind::pow:
            return power(falloff.parameter);
        case FalloffKind::exp:
        case FalloffKind::expjump: {
            const double lambda = falloff.kind == FalloffKind::exp ? falloff.parameter : 1;
            const double below = 1 - eta2 - 2 * exponential_integral_3(lambda * eta) +
                                 2 * eta2 * exponential_integral_3(lambda);
            // expjump lacks the normalisation.
            return eta2 + below / (falloff.kind == FalloffKind::exp ? -std::expm1(-lambda) : 1);
        }
    }
    return 1;
}

// W on the inside of a sphere, sigma = diameter / d_max.
inline double sphere_obscurance(const Falloff& falloff, double sigma) {
    const double inv2 = 1 / (sigma * sigma);
    const auto power = [&](double p) {
        return sigma <= 1 ? 2 * std::pow(sigma, p) / (p + 2) : 1 - p / (p + 2) * inv2;
    };
    switch (falloff.kind) {
        case FalloffKind::step:
            return sigma <= 1 ? 0 : 1 - inv2;
        case FalloffKind::linear:
            return power(1);
        case FalloffKind::sqrt:
            return power(0.5);
        case FalloffKind::cbrt:
            return power(1.0 / 3);
        case FalloffKind::pow:
            return power(falloff.parameter);
        case FalloffKind::exp:
        case FalloffKind::expjump: {
            const double lambda = falloff.kind == FalloffKind::exp ? falloff.parameter : 1;
            const double norm = falloff.kind == FalloffKind::exp ? -std::expm1(-lambda) : 1;
            const double k = lambda * std::min(sigma, 1.0);
            const double mean = (1 - 2 * (1 - (1 + k) * std::exp(-k)) / (k * k)) / norm;
            return sigma <= 1 ? mean : 1 - inv2 + inv2 * mean;
        }
    }
    return 1;
}

// A vertical wall: the half-plane at distance > 0 (units of d_max) from the point, its normal at azimuth `azimuth`.
struct Wall {
    double azimuth;
    double distance;
};

// W of a floor point among infinite vertical walls, by the midpoint rule over the azimuth.
inline double wall_obscurance(const Falloff& falloff, const std::vector<Wall>& walls) {
    constexpr int STEPS = 400000;
    double sum = 0;
    for (int i = 0; i < STEPS; ++i) {
        const double phi = 2 * std::numbers::pi * (i + 0.5) / STEPS;
        double nearest = std::numeric_limits<double>::infinity();
        for (const Wall& wall : walls) {
            const double cosine = std::cos(phi - wall.azimuth);
            if (cosine > 0) nearest = std::min(nearest, wall.distance / cosine);
        }
        sum += plane_obscurance(falloff, nearest);
    }
    return sum / STEPS;
}

}  // namespace obscura::test
