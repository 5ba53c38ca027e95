// SPDX-License-Identifier: Apache-2.0
// The functions that error bounds of kernels and of `obscura check` rest on, in units in the last place: those of the
// device as exact as OpenCL C 1.2 asks (table 7.4 of its specification), our own as exact as they say.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "device/launch.h"
#include "device/program.h"
#include "support/device.h"

namespace obscura {
namespace {

constexpr const char* SOURCE = R"(
#include "lib/falloff.clh"

kernel void probe(global const float* x, global const float* y, global float* out, uint function, uint count) {
    const uint i = (uint)get_global_id(0);
    if (i >= count) return;
    const float a = x[i], b = y[i];
    switch (function) {
        case 0: out[i] = 1.0f / a; break;
        case 1: out[i] = a / b; break;
        case 2: out[i] = sqrt(a); break;
        case 3: out[i] = rsqrt(a); break;
        case 4: out[i] = cbrt(a); break;
        case 5: out[i] = pow(a, b); break;
        case 6: out[i] = fma(a, b, -a * b); break;
        case 7: out[i] = one_minus_exp(a); break;
        case 8: out[i] = difference_of_products((float4)(a), (float4)(b), (float4)(b), (float4)(a + b)).x; break;
    }
})";

double difference_of_products(double a, double b) {
    const float sum = static_cast<float>(a) + static_cast<float>(b);
    return a * b - b * static_cast<double>(sum);
}

double rounding_of_product(double a, double b) {
    const float product = static_cast<float>(a) * static_cast<float>(b);
    return a * b - static_cast<double>(product);
}

struct Function {
    const char* name;
    double (*exact)(double, double);  // of floats
    double most;                      // ulp
};

// In the order of the kernel's cases.
const std::array FUNCTIONS{
    Function{"1 / a", [](double a, double) { return 1 / a; }, 2.5},
    Function{"a / b", [](double a, double b) { return a / b; }, 2.5},
    Function{"sqrt", [](double a, double) { return std::sqrt(a); }, 3},
    Function{"rsqrt", [](double a, double) { return 1 / std::sqrt(a); }, 2},
    Function{"cbrt", [](double a, double) { return std::cbrt(a); }, 2},
    Function{"pow", [](double a, double b) { return std::pow(a, b); }, 16},
    Function{"fma", rounding_of_product, 0},
    Function{"one_minus_exp", [](double a, double) { return -std::expm1(-a); }, 1},
    Function{"difference_of_products", difference_of_products, 1.5},
};

double error_in_ulps(float found, double exact) {
    const auto nearest = std::abs(static_cast<float>(exact));
    const double ulp = static_cast<double>(std::nextafter(nearest, std::numeric_limits<float>::infinity())) -
                       static_cast<double>(nearest);
    return std::abs(static_cast<double>(found) - exact) / ulp;
}

using Arithmetic = test::DeviceTest;

TEST_F(Arithmetic, FunctionsAreWithinTheirUlps) {
    constexpr uint32_t COUNT = 1 << 13;
    std::mt19937 random(1);
    std::uniform_real_distribution<float> exponent(-12, 3), power(0.1f, 4);
    std::vector<float> x, y;
    for (uint32_t i = 0; i < COUNT; ++i) {
        x.push_back(std::exp2(exponent(random)));
        y.push_back(power(random));
    }
    ProgramLibrary library(device());
    const cl::Kernel kernel = library.kernel_from_text("arithmetic", SOURCE, "probe");
    const Buffer a = Buffer::holding(device(), "x", "test", x);
    const Buffer b = Buffer::holding(device(), "y", "test", y);
    const Buffer out(device(), "out", "test", COUNT * sizeof(float));
    for (uint32_t function = 0; function < FUNCTIONS.size(); ++function) {
        const auto& [name, exact, most] = FUNCTIONS[function];
        launch(device(), kernel, "arithmetic", COUNT, library.local_size(), a, b, out, function, COUNT);
        const std::vector<float> found = out.contents<float>();
        double worst = 0;
        for (uint32_t i = 0; i < COUNT; ++i)
            worst = std::max(
                worst, error_in_ulps(found[i], exact(static_cast<double>(x[i]), static_cast<double>(y[i]))));
        EXPECT_LE(worst, most) << name;
    }
}

// OpenCL's full profile asks for these two; the rest differs from device to device.
TEST_F(Arithmetic, FloatFeaturesAreListed) {
    const std::vector<std::string>& features = device().info().float_features;
    for (const char* name : {"infinity and NaN", "round to nearest"})
        EXPECT_EQ(std::ranges::count(features, name), 1) << name;
}

}  // namespace
}  // namespace obscura
