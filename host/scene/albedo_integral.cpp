// SPDX-License-Identifier: Apache-2.0
// A and B are integrals over the directions i of D(h) G2(o, i) / (4 mu_o) times 1 - (1 - o.h)^5 and (1 -
// o.h)^5. For small alpha the lobe is a sharp peak with long tails around the mirror direction: theta_i =
// theta_o, azimuth 0 if counted from there. Both integrals are taken over x with a sinh(x), a the width of
// the peak, in place of the angle, where peak and tails have the same scale, so few points are enough.
// Differences of nearly equal cosines are written as products of half-angle terms.
#include "scene/albedo_integral.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace obscura {

namespace {

double square(double x) {
    return x * x;
}

double fifth_power(double x) {
    return square(square(x)) * x;
}

// Smith masking of both directions over 4 mu_o: G2 / (4 mu_o) = mu_i / (2 (mu_o s_i + mu_i s_o)).
double masking(double mu_o, double mu_i, double alpha) {
    const auto slope = [alpha](double mu) {
        return std::sqrt(square(mu) + square(alpha) * (1 - square(mu)));
    };
    return mu_i / (2 * (mu_o * slope(mu_i) + mu_i * slope(mu_o)));
}

// Sums f(x, weight) over Gauss-Legendre points of [0, end], eight on each interval of at most the given
// length.
template <typename F>
void quadrature(double end, double longest, const F& f) {
    constexpr std::array<double, 4> NODES{0.18343464249564978, 0.525532409916329, 0.7966664774136267,
                                          0.9602898564975362};
    constexpr std::array<double, 4> WEIGHTS{0.36268378337836177, 0.31370664587788705, 0.22238103445337434,
                                            0.10122853629037669};
    const int intervals = static_cast<int>(std::ceil(std::abs(end) / longest));
    const double half = end / intervals / 2;
    for (int interval = 0; interval < intervals; ++interval) {
        for (size_t n = 0; n < NODES.size(); ++n) {
            for (const double node : {-NODES[n], NODES[n]})
                f(half * (2 * interval + 1 + node), std::abs(half) * WEIGHTS[n]);
        }
    }
}

// int D(h) (terms of Schlick) dphi over the full turn, at one pair of polar angles.
AlbedoTerms azimuth_integral(double theta_o, double theta_i, double alpha, double longest) {
    const double cos_sum = std::cos((theta_o + theta_i) / 2), sin_sum = std::sin((theta_o + theta_i) / 2);
    const double cos_difference = std::cos((theta_o - theta_i) / 2);
    const double sin_difference = std::sin((theta_o - theta_i) / 2);
    // With t = tan(phi / 2): h_z and o.h follow from top, D from top / bottom; both are linear in t^2.
    const double near = square(cos_sum) * (square(alpha * cos_difference) + square(sin_difference));
    const double far = square(cos_difference) * (square(sin_sum) + square(alpha * cos_sum));
    AlbedoTerms sum;
    const auto add = [&](double t, double weight) {
        const double top = square(cos_sum) + square(cos_difference * t);
        const double bottom = near + far * square(t);
        const double o_dot_h = std::min(1.0, std::sqrt(top / (1 + square(t))));
        const double density = weight / (1 + square(t)) * square(top / bottom);
        const double grazing = fifth_power(1 - o_dot_h);
        sum.a += density * (1 - grazing);
        sum.b += density * grazing;
    };
    const double width = std::sqrt(near / far);
    quadrature(std::asinh(1 / width), longest,
               [&](double x, double weight) { add(width * std::sinh(x), weight * width * std::cosh(x)); });
    quadrature(1, longest, [&](double x, double weight) { add(1 / x, weight / square(x)); });  // t > 1
    // dphi = 2 dt / (1 + t^2), twice the half turn; D = alpha^2 / pi (top / bottom)^2.
    const double scale = 4 * square(alpha) / std::numbers::pi;
    return {sum.a * scale, sum.b * scale};
}

}  // namespace

AlbedoTerms schlick_albedo(double mu) {
    return {1 - fifth_power(1 - mu), fifth_power(1 - mu)};
}

AlbedoTerms integrate_albedo(double mu, double alpha, double longest) {
    const double theta_o = std::acos(mu);
    // Near the horizon masking changes over angles of about mu.
    const double width = mu > 0 ? 2 * std::min(alpha, mu) : 2 * alpha;
    AlbedoTerms sum;
    for (const double end : {0.0, std::numbers::pi / 2}) {
        quadrature(std::asinh((end - theta_o) / width), longest, [&](double x, double weight) {
            const double theta_i = theta_o + width * std::sinh(x);
            const double jacobian = width * std::cosh(x) * std::sin(theta_i);
            const double factor = weight * jacobian * masking(mu, std::cos(theta_i), alpha);
            const AlbedoTerms ring = azimuth_integral(theta_o, theta_i, alpha, longest);
            sum.a += factor * ring.a;
            sum.b += factor * ring.b;
        });
    }
    return sum;
}

}  // namespace obscura
