// SPDX-License-Identifier: Apache-2.0
#include "reference/sampler.h"

#include "sampling/seed.h"

#include <algorithm>
#include <bit>

namespace obscura::reference {
namespace {

constexpr uint32_t PIXEL_DIMENSION = 0;
constexpr uint32_t FIRST_PATH_DIMENSION = 1;
constexpr uint32_t DIMENSIONS_PER_DEPTH = 8;

// "lowbias32" (Wellons 2018).
uint32_t hash(uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ x >> 16;
}

uint32_t hash(uint32_t a, uint32_t b) {
    return hash(a ^ hash(b + 0x9e3779b9u));
}

// A keyed permutation of 0 .. count - 1, by steps that permute the next power of two until the result is in range.
uint32_t permute(uint32_t i, uint32_t count, uint32_t key) {
    const auto bits = static_cast<uint32_t>(std::bit_width(count - 1));
    const uint32_t mask = (uint32_t{1} << bits) - 1;
    const uint32_t shift = std::max(1u, bits / 2);
    do {
        uint32_t round_key = key;
        for (int round = 0; round < 4; ++round) {
            i = (i * (round_key | 1u) + (round_key >> 16)) & mask;
            i ^= i >> shift;
            round_key = round_key * 0x2c1b3c6du + 0x9e3779b9u;
            round_key ^= round_key >> 15;
        }
    } while (i >= count);
    return i;
}

uint32_t reverse_bits(uint32_t x) {
    uint32_t reversed = 0;
    for (int bit = 0; bit < 32; ++bit)
        reversed |= (x >> bit & 1u) << (31 - bit);
    return reversed;
}

// Nested uniform scramble (Laine, Karras 2011; constants of Burley 2020): each bit is flipped by a hash of those below.
uint32_t scramble(uint32_t reversed, uint32_t seed) {
    uint32_t x = reversed + seed;
    for (const uint32_t factor : {0x6c50b47cu, 0xb82f1e52u, 0xc7afe638u, 0x8d22f6e6u})
        x ^= x * factor;
    return x;
}

// Second Sobol dimension, from its direction numbers: v_0 is the highest bit, v_k = v_(k-1) ^ (v_(k-1) >> 1).
uint32_t sobol(uint32_t index) {
    uint32_t result = 0;
    for (uint32_t v = 0x80000000u; index != 0; index >>= 1, v ^= v >> 1)
        if ((index & 1u) != 0) result ^= v;
    return result;
}

// 24 bits of a code, in [0, 1 - 2^-24].
double unit(uint32_t code) {
    return static_cast<double>(code >> 8) * 0x1p-24;
}

}  // namespace

SamplePlan::SamplePlan(const RenderSettings& settings, uint64_t set_seed)
    : kind(settings.sampler),
      spp(settings.spp),
      obscurance_rays(settings.obscurance_rays),
      light_samples(settings.light_samples),
      seed(fold_seed(set_seed)),
      pixel(lattice_steps(spp, spp)),
      light(lattice_steps(spp * light_samples, spp)),
      obscurance(lattice_steps(spp * obscurance_rays, spp)) {}

V2d SampleSet::operator[](uint32_t j) const {
    const auto [x, y] = codes(j);
    return {unit(x), unit(y)};
}

V2d SampleSet::exact(uint32_t j) const {
    const auto [x, y] = codes(j);
    return V2d(x, y) * 0x1p-32;
}

SampleSet::Codes SampleSet::codes(uint32_t j) const {
    if (permuted_ && count_ > 1) j = permute(j, count_, hash(seed_y_, sample_));
    if (kind_ == SamplerKind::lattice) {
        const uint32_t i = sample_ + stride_ * j;
        return {i * steps_.x + seed_x_, i * steps_.y + seed_y_};
    }
    const uint32_t i = sample_ * count_ + j;
    if (kind_ == SamplerKind::random) return {hash(seed_x_, i), hash(seed_y_, i)};
    return {reverse_bits(scramble(i, seed_x_)), reverse_bits(scramble(reverse_bits(sobol(i)), seed_y_))};
}

PathSampler::PathSampler(const SamplePlan& plan, uint32_t x, uint32_t y, uint32_t sample)
    : plan_(plan), pixel_seed_(hash(hash(plan.seed, x), y)), sample_(sample) {}

SampleSet PathSampler::make_set(uint32_t dimension, uint32_t count, LatticeSteps steps, bool permuted) const {
    SampleSet set;
    set.seed_x_ = hash(pixel_seed_, 2 * dimension);
    set.seed_y_ = hash(pixel_seed_, 2 * dimension + 1);
    set.stride_ = plan_.spp;
    set.count_ = count;
    set.steps_ = steps;
    set.kind_ = plan_.kind;
    set.permuted_ = permuted && plan_.kind != SamplerKind::random;
    set.sample_ = set.permuted_ ? permute(sample_, plan_.spp, hash(set.seed_x_ + 0x68bc21ebu)) : sample_;
    return set;
}

V2d PathSampler::pixel() const {
    return make_set(PIXEL_DIMENSION, 1, plan_.pixel, false)[0];
}

V2d PathSampler::point(uint32_t depth, Dimension dimension) const {
    const uint32_t index =
        FIRST_PATH_DIMENSION + depth * DIMENSIONS_PER_DEPTH + static_cast<uint32_t>(dimension);
    return make_set(index, 1, plan_.pixel, true)[0];
}

SampleSet PathSampler::light_points(uint32_t depth, Dimension dimension) const {
    const uint32_t index =
        FIRST_PATH_DIMENSION + depth * DIMENSIONS_PER_DEPTH + static_cast<uint32_t>(dimension);
    return make_set(index, plan_.light_samples, plan_.light, true);
}

SampleSet PathSampler::obscurance_directions(uint32_t depth) const {
    const uint32_t index =
        FIRST_PATH_DIMENSION + depth * DIMENSIONS_PER_DEPTH + static_cast<uint32_t>(Dimension::obscurance);
    SampleSet set = make_set(index, plan_.obscurance_rays, plan_.obscurance, true);
    set.permuted_ = false;  // all of them are summed: only the samples' order matters
    return set;
}

}  // namespace obscura::reference
