// SPDX-License-Identifier: Apache-2.0
// Sample points of several dimensions together: each is even by itself, but what a pixel averages depends on where in it
// a camera ray starts and on where the obscurance rays of that ray go.
#include <gtest/gtest.h>

#include <map>

#include "reference/sweep_errors.h"
#include "scene/gltf.h"
#include "support/render.h"

namespace obscura::test {
namespace {

using SamplePoints = DeviceTest;

// Mean variance of the obscurances, from two seeds.
double variance(const Scene& scene, RenderSettings settings) {
    const Image first = render(scene, settings, {"obscurance"}).image;
    ++settings.seed;
    const Image second = render(scene, settings, {"obscurance"}).image;
    return measure_errors(*first.find_layer("obscurance"), *second.find_layer("obscurance")).mse / 2;
}

// With one order of the camera samples for the pixel and for the directions, pixels at edges kept their error however
// many samples they had: at 64 x 1 lattice and owen were no better than random points.
TEST_F(SamplePoints, OfPixelAndDirectionsAreNotPaired) {
    const Scene scene = load_gltf(std::string(OBSCURA_SOURCE_DIR) + "/scenes/cornell/cornell.gltf");
    for (const auto& [spp, rays, gain] : {std::tuple{64u, 1u, 4.0}, {32u, 4u, 12.0}}) {
        RenderSettings settings = picture(80, 60, spp, rays);
        std::map<SamplerKind, double> found;
        for (const SamplerKind kind : {SamplerKind::lattice, SamplerKind::owen, SamplerKind::random}) {
            settings.sampler = kind;
            found[kind] = variance(scene, settings);
        }
        EXPECT_LT(found[SamplerKind::lattice], found[SamplerKind::random] / gain) << spp << " x " << rays;
        EXPECT_LT(found[SamplerKind::owen], found[SamplerKind::random] / gain) << spp << " x " << rays;
        RecordProperty("lattice_gain_" + std::to_string(rays),
                       std::to_string(found[SamplerKind::random] / found[SamplerKind::lattice]));
        RecordProperty("owen_gain_" + std::to_string(rays),
                       std::to_string(found[SamplerKind::random] / found[SamplerKind::owen]));
    }
}

}  // namespace
}  // namespace obscura::test
