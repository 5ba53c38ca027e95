// SPDX-License-Identifier: Apache-2.0
// Rank-1 lattices for a pixel's sample set: point j of n is (j / n, g j / n) mod 1.
#pragma once

#include <cstdint>

namespace obscura {

// Points of a pixel's whole set, at most: indices have 32 bits, and squares of distances must fit into 64.
inline constexpr uint64_t MAX_SET_POINTS = uint64_t{1} << 31;

// The generator g for `total` points of which every subset j = s, s + stride, s + 2 stride ... is used by one camera
// sample: the g whose full lattice and whose subsets both have the longest shortest vector (spectral
// test). 40 points in subsets of 5 give 7.
uint32_t lattice_generator(uint32_t total, uint32_t stride);

// Steps of point j in units of 2^-32: the kernels add j * step to a random shift and let it wrap.
struct LatticeSteps {
    uint32_t x = 0, y = 0;
};
LatticeSteps lattice_steps(uint32_t total, uint32_t stride);

}  // namespace obscura
