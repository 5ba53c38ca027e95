// SPDX-License-Identifier: Apache-2.0
// Under cosine sampling the direction's projection onto the floor is uniform on the unit disc: with polar coordinates
// s, phi there, W = 1 / (2 pi) int dphi int 2 s rho(d) ds. One cylinder of radius eta about the normal gives the inner
// integral g(eta) = eta^2 + 2 int_eta^1 s rho(eta / s) ds, and a plane at height eta the same, as the cosine has the
// density of s. Everything with flat faces is built from g.
#include "reference/oracles.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"

namespace obscura {
namespace {

constexpr double PI = std::numbers::pi;

// E_3(x) = int_1^inf exp(-x t) / t^3 dt by recurrence from E_1.
double exponential_integral_3(double x) {
    if (x <= 0) return 0.5;
    const double e1 = -std::expint(-x);
    return 0.5 * (std::exp(-x) * (1 - x) + x * x * e1);
}

bool is_exponential(const Falloff& falloff) {
    return falloff.kind == FalloffKind::exp || falloff.kind == FalloffKind::expjump;
}

// lambda of exp and expjump, the exponent of the powers of t.
double parameter_of(const Falloff& falloff) {
    switch (falloff.kind) {
        case FalloffKind::linear:
        case FalloffKind::expjump:
            return 1;
        case FalloffKind::sqrt:
            return 0.5;
        case FalloffKind::cbrt:
            return 1.0 / 3;
        case FalloffKind::exp:
        case FalloffKind::pow:
            return falloff.parameter;
        case FalloffKind::step:
            break;
    }
    OBSCURA_CHECK(false, "falloff kind {} has no parameter", static_cast<uint32_t>(falloff.kind));
}

// 1 - exp(-lambda), by which exp is divided so that it reaches 1 at d_max; expjump is not.
double norm_of(const Falloff& falloff) {
    return falloff.kind == FalloffKind::exp ? -std::expm1(-falloff.parameter) : 1;
}

// int_0^1 2 c (1 - exp(-k c)) dc
double mean_one_minus_exp(double k) {
    if (k > 1) return 1 - 2 * (1 - (1 + k) * std::exp(-k)) / (k * k);
    // For small k that would cancel: the same as a power series.
    double sum = 0;
    double term = -1;  // -(-k)^n / n!
    for (int n = 1; n <= 20; ++n) {
        term *= -k / n;
        sum += 2 * term / (n + 2);
    }
    return sum;
}

// W within a sphere whose diameter is at most d_max.
double near_sphere_obscurance(const Falloff& falloff, double diameter) {
    if (falloff.kind == FalloffKind::step) return 0;
    const double parameter = parameter_of(falloff);
    if (is_exponential(falloff)) return mean_one_minus_exp(parameter * diameter) / norm_of(falloff);
    return 2 * std::pow(diameter, parameter) / (parameter + 2);
}

// By the double exponential rule (Takahasi, Mori 1974), which needs f to be analytic inside (a, b) and leaves its ends
// alone, so that a nearby pole costs no digits.
template <typename Function>
double integrate(double a, double b, const Function& f) {
    constexpr double STEP = 1.0 / 16;
    constexpr int STEPS = 52;  // to either side: beyond, the weights are below 1e-17
    const double middle = 0.5 * (a + b), half = 0.5 * (b - a);
    double sum = 0;
    for (int i = -STEPS; i <= STEPS; ++i) {
        const double t = i * STEP;
        const double u = PI / 2 * std::sinh(t);
        const double weight = PI / 2 * std::cosh(t) / (std::cosh(u) * std::cosh(u));
        sum += weight * f(middle + half * std::tanh(u));
    }
    return half * STEP * sum;
}

// Horizontal distance to the nearest wall at an azimuth.
double wall_distance(const std::vector<Wall>& walls, double azimuth) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Wall& wall : walls) {
        const double cosine = std::cos(azimuth - wall.azimuth);
        if (cosine > 0) nearest = std::min(nearest, wall.distance / cosine);
    }
    return nearest;
}

// Where the distance to the walls, as a function of the azimuth, passes `reach`.
void add_crossings(const std::vector<Wall>& walls, double reach, std::vector<double>& azimuths) {
    for (const Wall& wall : walls) {
        if (!(wall.distance < reach)) continue;
        const double half_angle = std::acos(wall.distance / reach);
        azimuths.push_back(wall.azimuth - half_angle);
        azimuths.push_back(wall.azimuth + half_angle);
    }
}

// The corners between walls: a.distance cos(phi - b.azimuth) = b.distance cos(phi - a.azimuth), on either side. Only
// those where nothing is nearer count.
void add_corners(const std::vector<Wall>& walls, std::vector<double>& azimuths) {
    for (size_t i = 0; i < walls.size(); ++i) {
        for (size_t j = 0; j < i; ++j) {
            const Wall &a = walls[i], &b = walls[j];
            const double x = a.distance * std::cos(b.azimuth) - b.distance * std::cos(a.azimuth);
            const double y = a.distance * std::sin(b.azimuth) - b.distance * std::sin(a.azimuth);
            for (const double azimuth : {std::atan2(-x, y), std::atan2(x, -y)}) {
                const double cosine = std::cos(azimuth - a.azimuth);
                const double nearest = wall_distance(walls, azimuth);
                if (cosine > 0 && a.distance / cosine <= nearest * (1 + 1e-9)) azimuths.push_back(azimuth);
            }
        }
    }
}

}  // namespace

double plane_obscurance(const Falloff& falloff, double height) {
    if (height >= 1) return 1;
    const double h2 = height * height;
    if (falloff.kind == FalloffKind::step) return h2;
    const double parameter = parameter_of(falloff);
    if (is_exponential(falloff)) {
        const double below = 1 - h2 - 2 * exponential_integral_3(parameter * height) +
                             2 * h2 * exponential_integral_3(parameter);
        return h2 + below / norm_of(falloff);
    }
    // (2 h^p - p h^2) / (2 - p), written so that p = 2 is no exception.
    const double q = 2 - parameter;
    const double log_h = std::log(height);
    return h2 * (1 + 2 * (q == 0 ? -log_h : std::expm1(-q * log_h) / q));
}

std::vector<Wall> square_well(double half_side) {
    return {{0, half_side}, {0.5 * PI, half_side}, {PI, half_side}, {1.5 * PI, half_side}};
}

// At one azimuth: the wall at m takes s from s0 on, the ceiling at H the cosines from c0 on, where s0 / m = c0 / H
// = 1 / r, r = sqrt(m^2 + H^2) the distance of their common edge. int_s0^1 2 s rho(m / s) ds = g(m) - s0^2 g(r), the
// same for the ceiling, and s0^2 + c0^2 = 1: together g(m) + g(H) - g(r).
double floor_obscurance(const Falloff& falloff, const std::vector<Wall>& walls, double ceiling) {
    const double g_ceiling = plane_obscurance(falloff, ceiling);
    const auto inner = [&](double azimuth) {
        const double m = wall_distance(walls, azimuth);
        return plane_obscurance(falloff, m) + g_ceiling - plane_obscurance(falloff, std::hypot(m, ceiling));
    };
    // Between these azimuths everything is analytic.
    std::vector<double> azimuths;
    add_corners(walls, azimuths);
    add_crossings(walls, 1, azimuths);
    if (ceiling < 1) add_crossings(walls, std::sqrt(1 - ceiling * ceiling), azimuths);
    if (azimuths.empty()) return inner(0);
    for (double& azimuth : azimuths)
        azimuth -= 2 * PI * std::floor(azimuth / (2 * PI));
    std::ranges::sort(azimuths);
    azimuths.push_back(azimuths.front() + 2 * PI);
    double sum = 0;
    for (size_t i = 1; i < azimuths.size(); ++i)
        sum += integrate(azimuths[i - 1], azimuths[i], inner);
    return sum / (2 * PI);
}

double sphere_obscurance(const Falloff& falloff, double diameter) {
    if (diameter <= 1) return near_sphere_obscurance(falloff, diameter);
    // The nearer part, c < 1 / diameter, is a sphere of diameter d_max in small; the rest is open.
    return 1 - (1 - near_sphere_obscurance(falloff, 1)) / (diameter * diameter);
}

double dome_obscurance(const Falloff& falloff, double radius) {
    return falloff_value(falloff, radius);
}

RgbD bleeding_obscurance(double w, double w_step, const RgbD& reflectivity,
                         const RgbD& average_reflectivity) {
    return (w - w_step) * reflectivity + w_step * average_reflectivity;
}

}  // namespace obscura
