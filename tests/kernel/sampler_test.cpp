// SPDX-License-Identifier: Apache-2.0
// The samplers as the device computes them: nets, lattices and permutations are what they claim to be, directions are
// unit vectors with the right density, and pixels, seeds and dimensions don't share points.
#include "device/launch.h"
#include "device/program.h"
#include "sampling/lattice.h"
#include "scene/settings.h"
#include "shared/frame.h"
#include "support/device.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <set>

namespace obscura {
namespace {

using Code = std::pair<uint32_t, uint32_t>;  // a point in units of 2^-32

// Which point: pixel seed, camera sample, dimension, index within the camera sample.
struct Query {
    uint32_t seed, sample, dimension, j;
};

constexpr const char* SOURCE = R"(
#include "lib/math.clh"
#include "lib/sampler.clh"

kernel void codes(global const Frame* frame, global const uint4* queries, global uint2* out, uint n, uint2 steps,
                  uint permuted, uint count) {
    const uint i = (uint)get_global_id(0);
    if (i >= count) return;
    Sampler s;
    s.seed = queries[i].x;
    s.sample = queries[i].y;
    out[i] = sample_codes(frame, s, queries[i].z, queries[i].w, n, steps, permuted != 0u);
}

kernel void permutation(global uint* out, uint bits, uint key, uint count) {
    const uint i = (uint)get_global_id(0);
    if (i < count) out[i] = permute_index(i, count, bits, key);
}

kernel void seeds(global uint* out, uint width, uint seed, uint count) {
    const uint i = (uint)get_global_id(0);
    if (i < count) out[i] = pixel_seed(i % width, i / width, seed);
}

// unit_float of the codes first, first + step, ...
kernel void units(global float* out, uint first, uint step, uint count) {
    const uint i = (uint)get_global_id(0);
    if (i < count) out[i] = unit_float(first + i * step);
}

kernel void directions(global const uint2* points, global float4* out, uint count) {
    const uint i = (uint)get_global_id(0);
    if (i >= count) return;
    const float2 u = unit_float2(points[i]);
    float8 x, y, z;
    cosine_hemisphere8((float8)(u.x), (float8)(u.y), &x, &y, &z);
    out[i] = (float4)(x.s0, y.s0, z.s0, 0.0f);
}
)";

class SamplerOnDevice : public test::DeviceTest {
  protected:
    static Frame frame_of(SamplerKind kind, uint32_t spp) {
        Frame frame{};
        frame.sampling = {spp, 0, 0, static_cast<uint32_t>(kind)};
        frame.seed.y = static_cast<uint32_t>(std::bit_width(spp - 1));
        return frame;
    }

    template <typename T, typename... Args>
    std::vector<T> run(const char* name, uint32_t count, const Args&... args) {
        const cl::Kernel kernel = library().kernel_from_text("sampler probe", SOURCE, name);
        const Buffer out(device(), "out", "test", count * sizeof(T));
        launch(device(), kernel, name, count, library().local_size(), out, args..., count);
        return out.contents<T>();
    }

    std::vector<Code> codes(SamplerKind kind, uint32_t spp, uint32_t n, const std::vector<Query>& queries,
                            bool permuted = false) {
        const cl::Kernel kernel = library().kernel_from_text("sampler probe", SOURCE, "codes");
        const Frame frame = frame_of(kind, spp);
        const auto count = static_cast<uint32_t>(queries.size());
        const Buffer out(device(), "out", "test", count * sizeof(Code));
        launch(device(), kernel, "codes", count, library().local_size(),
               Buffer::holding(device(), "frame", "test", std::span(&frame, 1)),
               Buffer::holding(device(), "queries", "test", queries), out, n, lattice_steps(spp * n, spp),
               permuted ? 1u : 0u, count);
        std::vector<std::array<uint32_t, 2>> words(count);
        out.download(words);
        std::vector<Code> result;
        for (const auto& [x, y] : words)
            result.emplace_back(x, y);
        return result;
    }

    // The n points of each camera sample in turn.
    std::vector<Code> pixel_set(SamplerKind kind, uint32_t spp, uint32_t n, uint32_t seed,
                                uint32_t dimension = 3, bool permuted = false) {
        std::vector<Query> queries;
        for (uint32_t s = 0; s < spp; ++s)
            for (uint32_t j = 0; j < n; ++j)
                queries.push_back({seed, s, dimension, j});
        return codes(kind, spp, n, queries, permuted);
    }

    std::vector<f32x4> directions(const std::vector<std::array<uint32_t, 2>>& points) {
        const cl::Kernel kernel = library().kernel_from_text("sampler probe", SOURCE, "directions");
        const auto count = static_cast<uint32_t>(points.size());
        const Buffer out(device(), "out", "test", count * sizeof(f32x4));
        launch(device(), kernel, "directions", count, library().local_size(),
               Buffer::holding(device(), "points", "test", points), out, count);
        return out.contents<f32x4>();
    }

  private:
    ProgramLibrary& library() {
        if (!library_) library_.emplace(device());
        return *library_;
    }

    std::optional<ProgramLibrary> library_;
};

// 2^m points of which every elementary interval of area 2^-m holds exactly one.
bool is_net(std::span<const Code> points) {
    const auto m = static_cast<uint32_t>(std::countr_zero(points.size()));
    for (uint32_t a = 0; a <= m; ++a) {
        std::set<Code> intervals;
        for (const auto& [x, y] : points)
            intervals.emplace(static_cast<uint32_t>(uint64_t{x} >> (32 - a)),
                              static_cast<uint32_t>(uint64_t{y} >> (32 - (m - a))));
        if (intervals.size() != points.size()) return false;
    }
    return true;
}

TEST_F(SamplerOnDevice, OwenSetsAreNetsForEachCameraSampleAndTogether) {
    constexpr uint32_t SPP = 8, K = 16;
    for (const uint32_t seed : {0u, 1u, 0xdeadbeefu, 0xffffffffu}) {
        const std::vector<Code> points = pixel_set(SamplerKind::owen, SPP, K, seed);
        const std::span<const Code> all(points);
        for (uint32_t s = 0; s < SPP; ++s)
            EXPECT_TRUE(is_net(all.subspan(s * K, K))) << "camera sample " << s;
        for (size_t count = 1; count <= points.size(); count *= 2)
            EXPECT_TRUE(is_net(all.first(count))) << "the first " << count;
    }
}

TEST_F(SamplerOnDevice, NetTestNoticesRandomPoints) {
    EXPECT_FALSE(is_net(pixel_set(SamplerKind::random, 1, 16, 1)));
}

TEST_F(SamplerOnDevice, LatticeIsTheShiftedLattice) {
    constexpr uint32_t SPP = 8, K = 5, TOTAL = SPP * K;
    const LatticeSteps steps = lattice_steps(TOTAL, SPP);
    const uint32_t generator = lattice_generator(TOTAL, SPP);
    const std::vector<Code> points = pixel_set(SamplerKind::lattice, SPP, K, 12345);
    for (uint32_t s = 0; s < SPP; ++s) {
        for (uint32_t j = 0; j < K; ++j) {
            const uint32_t index = s + SPP * j;
            const uint32_t x = points[s * K + j].first - points[0].first;
            const uint32_t y = points[s * K + j].second - points[0].second;
            EXPECT_EQ(x, index * steps.x);
            EXPECT_EQ(y, index * steps.y);
            // Against index / 40 and generator * index / 40 themselves, in units of 2^-32.
            const double unit = std::ldexp(1.0, 32);
            EXPECT_NEAR(x, unit * index / TOTAL, TOTAL);
            EXPECT_NEAR(y, unit * (index * generator % TOTAL) / TOTAL, TOTAL);
        }
    }
}

// A dimension drawn in another order holds the same points, and every camera sample keeps its own subset.
TEST_F(SamplerOnDevice, PermutedSamplesAreTheSameSetInAnotherOrder) {
    constexpr uint32_t SPP = 8, K = 4;
    for (const SamplerKind kind : {SamplerKind::lattice, SamplerKind::owen}) {
        std::vector<Code> plain = pixel_set(kind, SPP, K, 9);
        std::vector<Code> permuted = pixel_set(kind, SPP, K, 9, 3, true);
        EXPECT_NE(plain, permuted);
        std::sort(plain.begin(), plain.end());
        std::sort(permuted.begin(), permuted.end());
        EXPECT_EQ(plain, permuted);
    }
}

TEST_F(SamplerOnDevice, PermuteIndexIsAPermutation) {
    for (const uint32_t count : {1u, 2u, 3u, 5u, 8u, 17u, 64u, 100u, 1000u, 4096u}) {
        std::set<std::vector<uint32_t>> orders;
        for (const uint32_t key : {0u, 1u, 2u, 77u, 0x9e3779b9u, 0xffffffffu}) {
            const std::vector<uint32_t> order =
                run<uint32_t>("permutation", count, static_cast<uint32_t>(std::bit_width(count - 1)), key);
            const std::set<uint32_t> values(order.begin(), order.end());
            EXPECT_EQ(values.size(), count) << "key " << key;
            EXPECT_EQ(*values.rbegin(), count - 1) << "key " << key;
            orders.insert(order);
        }
        if (count >= 8) {
            EXPECT_GE(orders.size(), 5U) << "keys give different orders of " << count;
        }
    }
}

TEST_F(SamplerOnDevice, UnitFloatsStayBelowOne) {
    constexpr uint32_t COUNT = 1 << 16;
    for (const float u : run<float>("units", COUNT, ~0u - (COUNT - 1), 1u))
        ASSERT_LT(u, 1);
    const std::vector<float> all = run<float>("units", COUNT, 0u, 1u << 16);
    EXPECT_EQ(all.front(), 0);
    EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
    for (uint32_t i = 0; i < COUNT; ++i)
        ASSERT_EQ(all[i], static_cast<float>(i) / COUNT);
}

// Pixels of a picture: seeds don't repeat beyond chance, and neighbours know nothing of each other.
TEST_F(SamplerOnDevice, PixelsAreIndependent) {
    constexpr uint32_t SIDE = 256, COUNT = SIDE * SIDE;
    const std::vector<uint32_t> seeds = run<uint32_t>("seeds", COUNT, SIDE, 0u);
    EXPECT_GE(std::set<uint32_t>(seeds.begin(), seeds.end()).size(), COUNT - 5U);
    const std::vector<uint32_t> others = run<uint32_t>("seeds", COUNT, SIDE, 1u);
    size_t equal = 0;
    for (uint32_t i = 0; i < COUNT; ++i)
        equal += seeds[i] == others[i] ? 1 : 0;
    EXPECT_LE(equal, 1U) << "another seed of the render";

    std::vector<Query> queries;
    for (const uint32_t seed : seeds)
        queries.push_back({seed, 0, 1, 0});
    for (const SamplerKind kind : {SamplerKind::lattice, SamplerKind::owen, SamplerKind::random}) {
        const std::vector<Code> points = codes(kind, 8, 5, queries);
        const auto centred = [&](size_t i) {
            return std::ldexp(static_cast<double>(points[i].first), -32) - 0.5;
        };
        double sum = 0, beside = 0, below = 0, across = 0;
        for (size_t i = 0; i + SIDE < COUNT; ++i) {
            sum += centred(i);
            beside += centred(i) * centred(i + 1);
            below += centred(i) * centred(i + SIDE);
            across += centred(i) * (std::ldexp(static_cast<double>(points[i].second), -32) - 0.5);
        }
        // Means of 65 280 numbers; products of two have standard deviation 1/12. Five standard errors.
        const double n = COUNT - SIDE;
        EXPECT_LT(std::abs(sum / n), 5 * std::sqrt(1.0 / 12 / n));
        for (const double product : {beside, below, across})
            EXPECT_LT(std::abs(product / n), 5.0 / 12 / std::sqrt(n));
    }
}

TEST_F(SamplerOnDevice, SeedsAndDimensionsGiveDifferentPointsAndRunsRepeat) {
    constexpr uint32_t SPP = 4, K = 8;
    for (const SamplerKind kind : {SamplerKind::lattice, SamplerKind::owen, SamplerKind::random}) {
        std::set<std::vector<Code>> sets;
        for (const uint32_t seed : {1u, 2u, 3u})
            for (const uint32_t dimension : {0u, 1u, 2u, 9u, 17u})
                sets.insert(pixel_set(kind, SPP, K, seed, dimension));
        EXPECT_EQ(sets.size(), 15U);
        EXPECT_EQ(pixel_set(kind, SPP, K, 1, 2), pixel_set(kind, SPP, K, 1, 2));
        const std::vector<Code> points = pixel_set(kind, SPP, K, 1);
        EXPECT_EQ(std::set<Code>(points.begin(), points.end()).size(), SPP * K) << "no point twice";
    }
}

// A grid over the whole square, with the first and the last code of each side.
TEST_F(SamplerOnDevice, CosineDirectionsAreUnitVectorsAboveTheHorizon) {
    constexpr uint32_t SIDE = 1537;  // odd: the middle, where the disc's map has its corner, is on the grid
    std::vector<std::array<uint32_t, 2>> points;
    const auto code = [](uint32_t i) { return static_cast<uint32_t>(uint64_t{0xffffffff} * i / (SIDE - 1)); };
    for (uint32_t y = 0; y < SIDE; ++y)
        for (uint32_t x = 0; x < SIDE; ++x)
            points.push_back({code(x), code(y)});
    points.push_back({0x80000000u, 0x80000000u});
    double worst = 0;
    for (const f32x4& d : directions(points)) {
        ASSERT_GE(d.z, 0);
        const double length =
            std::hypot(static_cast<double>(d.x), static_cast<double>(d.y), static_cast<double>(d.z));
        worst = std::max(worst, std::abs(length - 1));
    }
    EXPECT_LE(worst, 4 * std::ldexp(1.0, -23)) << "4 ulp of 1";
}

TEST_F(SamplerOnDevice, CosineDirectionsHaveTheirMoments) {
    constexpr uint32_t N = 1 << 14;
    std::vector<std::array<uint32_t, 2>> points;
    for (const auto& [x, y] : pixel_set(SamplerKind::owen, 1, N, 4711))
        points.push_back({x, y});
    double x = 0, y = 0, z = 0, z2 = 0;
    for (const f32x4& d : directions(points)) {
        x += static_cast<double>(d.x);
        y += static_cast<double>(d.y);
        z += static_cast<double>(d.z);
        z2 += static_cast<double>(d.z) * static_cast<double>(d.z);
    }
    EXPECT_NEAR(x / N, 0, 1e-4);
    EXPECT_NEAR(y / N, 0, 1e-4);
    EXPECT_NEAR(z / N, 2.0 / 3, 1e-4);
    EXPECT_NEAR(z2 / N, 0.5, 1e-4);
}

}  // namespace
}  // namespace obscura
