// SPDX-License-Identifier: Apache-2.0
// Points drawn for a batch of paths are those that each path would draw by itself.
#include "device/launch.h"
#include "device/program.h"
#include "sampling/lattice.h"
#include "scene/settings.h"
#include "shared/frame.h"
#include "support/device.h"

#include <array>
#include <bit>
#include <span>
#include <utility>
#include <vector>

namespace obscura {
namespace {

// Path i is camera sample i % spp of pixel i / spp. out: its point j as drawn in a batch, and alone.
constexpr const char* SOURCE = R"(
#include "lib/math.clh"
#include "lib/sample_batch.clh"

inline Sampler sampler_of(global const Frame* frame, uint path) {
    Sampler s;
    s.seed = 1000u + path / frame->sampling.x;
    s.sample = path % frame->sampling.x;
    return s;
}

kernel void draw(global const Frame* frame, global uint4* out, uint dimension, uint j, uint n, uint2 steps,
                 uint permuted, uint count) {
    const uint first = (uint)get_global_id(0);
    if (first >= count || first % BATCH != 0u) return;
    SamplerBatch samplers;
    FOR_BATCH(lane) {
        const Sampler s = sampler_of(frame, first + lane);
        samplers.seed[lane] = s.seed;
        samplers.sample[lane] = s.sample;
    }
    SampleSetBatch sets;
    CodeBatch codes;
    make_sample_sets(frame, &samplers, dimension, n, steps, permuted != 0u, &sets);
    draw_codes(&sets, j, &codes);
    for (uint lane = 0u; lane < min(BATCH, count - first); ++lane) {
        const uint2 alone = sample_codes(frame, sampler_of(frame, first + lane), dimension, j, n, steps, permuted != 0u);
        out[first + lane] = (uint4)(codes.x[lane], codes.y[lane], alone.x, alone.y);
    }
}
)";

using Point = std::array<uint32_t, 2>;

struct Points {
    std::vector<Point> batch, alone;
};

class SampleBatch : public test::DeviceTest {
  protected:
    Points draw(SamplerKind kind, uint32_t spp, uint32_t n, uint32_t j, bool permuted) {
        constexpr uint32_t COUNT = 108, DIMENSION = 5;  // the last batch isn't full
        Frame frame{};
        frame.sampling = {spp, 0, 0, static_cast<uint32_t>(kind)};
        frame.seed.y = static_cast<uint32_t>(std::bit_width(spp - 1));
        ProgramLibrary library(device());
        const Buffer out(device(), "out", "test", COUNT * sizeof(u32x4));
        launch(device(), library.kernel_from_text("sample batch", SOURCE, "draw"), "draw", COUNT,
               library.local_size(), Buffer::holding(device(), "frame", "test", std::span(&frame, 1)), out,
               DIMENSION, j, n, lattice_steps(spp * n, spp), permuted ? 1u : 0u, COUNT);
        Points points;
        for (const u32x4& codes : out.contents<u32x4>()) {
            points.batch.push_back({codes.x, codes.y});
            points.alone.push_back({codes.z, codes.w});
        }
        return points;
    }
};

// 12 samples and 3 points aren't powers of two: some lanes have to permute again.
TEST_F(SampleBatch, DrawsThePointsThatEachPathDrawsAlone) {
    for (const SamplerKind kind : {SamplerKind::lattice, SamplerKind::owen, SamplerKind::random}) {
        for (const auto& [n, j] :
             {std::pair(1u, 0u), std::pair(3u, 0u), std::pair(3u, 1u), std::pair(3u, 2u)}) {
            for (const bool permuted : {false, true}) {
                const Points points = draw(kind, 12, n, j, permuted);
                EXPECT_EQ(points.batch, points.alone) << "sampler " << static_cast<int>(kind) << ", point "
                                                      << j << " of " << n << (permuted ? ", permuted" : "");
            }
        }
    }
}

}  // namespace
}  // namespace obscura
