// SPDX-License-Identifier: Apache-2.0
// The stage shadow: what stands between a surface and a light, and nothing else, takes its visibility.
#include "scene/material.h"
#include "support/device.h"
#include "support/kernel_queue.h"
#include "support/render.h"
#include "support/scene_builder.h"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace obscura {
namespace {

constexpr float FAR = std::numeric_limits<float>::infinity();
const Rgb TINT(0.25f, 0.5f, 1);

// In the plane z = 0: a wall for x in [0, 1], a clear pane for x in [2, 3]; a second pane in front, x in [2.5, 3].
Scene wall_and_panes() {
    Material clear = test::matte(TINT);
    clear.transmission = 1;
    test::SceneBuilder builder;
    const uint32_t pane = builder.material(clear);
    builder.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, builder.material(test::matte(Rgb(0.5f))));
    builder.quad({2, 0, 0}, {1, 0, 0}, {0, 1, 0}, pane);
    builder.quad({2.5f, 0, 0.5f}, {0.5f, 0, 0}, {0, 1, 0}, pane);
    return builder.finish();
}

struct Query {
    V3f origin, to_light;
    float t_light;
    V3f expected;
};

const V3f ONE_PANE = V3f(V3d(TINT) * (1 - pane_reflectance(1)));

const std::vector<Query> QUERIES = {
    {{0.5f, 0.5f, 1}, {0, 0, -2}, 1, V3f(0)},               // wall between
    {{0.5f, 0.5f, 1}, {0, 0, -0.5f}, 1, V3f(1)},            // wall behind the light
    {{0.5f, 0.5f, 1}, {0, 0, 2}, 1, V3f(1)},                // wall behind the surface
    {{0.5f, 0.5f, 1}, {1.25f, 0, -2}, 1, V3f(1)},           // past the wall
    {{0.5f, 0.5f, 1}, {0, 0, -1}, FAR, V3f(0)},             // a sun behind the wall
    {{0.5f, 0.5f, 1}, {0, 0, 1}, FAR, V3f(1)},              // a sun in the open
    {{2.25f, 0.5f, 1}, {0, 0, -2}, 1, ONE_PANE},            // through one pane
    {{2.75f, 0.5f, 1}, {0, 0, -3}, 1, ONE_PANE* ONE_PANE},  // through two
    {{2.75f, 0.5f, 1}, {0, 0, -0.75f}, 1, ONE_PANE},        // the light stands between the two
    {{2.75f, 0.5f, 1}, {0, 0, -1}, FAR, ONE_PANE* ONE_PANE},
};
const auto COUNT = static_cast<uint32_t>(QUERIES.size());

class ShadowStage : public test::DeviceTest {
  protected:
    // Query i has the result index COUNT - 1 - i; two light samples for each of five slots: an exactly full queue.
    test::StageBench bench() {
        test::StageBench bench(device(), wall_and_panes(), test::picture(8, 8), COUNT / 2);
        for (uint32_t i = 0; i < COUNT; ++i) {
            const Query& query = QUERIES[i];
            bench.shadow_rays().at(SHADOW_ORIGIN, i) =
                test::lane_of(query.origin, test::as_float(COUNT - 1 - i));
            bench.shadow_rays().at(SHADOW_DIRECTION, i) = test::lane_of(query.to_light, query.t_light);
        }
        bench.counters[COUNT_SHADOWS] = COUNT;
        return bench;
    }
    // The result index counts over both lanes.
    static f32x4 visibility(test::StageBench& bench, uint32_t query) {
        const uint32_t index = COUNT - 1 - query;
        return bench.visibility().at(index / bench.capacity, index % bench.capacity);
    }
};

TEST_F(ShadowStage, ExactlyFullQueueFindsWhatIsBetweenSurfaceAndLight) {
    test::StageBench wave = bench();
    ASSERT_EQ(wave.capacity * wave.light_samples, COUNT);
    wave.run_shadow();
    for (uint32_t i = 0; i < COUNT; ++i) {
        const V3f seen = test::xyz_of(visibility(wave, i));
        EXPECT_LT((seen - QUERIES[i].expected).length(), 1e-6f) << "query " << i << ": " << seen.x;
    }
    EXPECT_TRUE(wave.guards_untouched());
    EXPECT_EQ(wave.counters[STATUS_CODE], STATUS_OK);
}

// A ray passes sixteen panes, and sees what is behind them; the next pane stops it.
TEST_F(ShadowStage, SixteenPanesArePassed) {
    Material clear = test::matte(Rgb(1));
    clear.transmission = 1;
    for (const uint32_t count : {15U, 16U, 17U}) {
        test::SceneBuilder builder;
        const uint32_t pane = builder.material(clear);
        for (uint32_t i = 0; i < count; ++i)
            builder.quad({0, 0, -static_cast<float>(i)}, {3, 0, 0}, {0, 1, 0}, pane);
        // Behind them all stands a wall, for x in [0, 1].
        builder.quad({0, 0, -20}, {1, 0, 0}, {0, 1, 0}, builder.material(test::matte(Rgb(0.5f))));
        test::StageBench wave(device(), builder.finish(), test::picture(8, 8), 2);
        const std::vector<std::pair<V3f, float>> lights{
            {{0, 0, -1}, FAR},    // a sun behind the wall
            {{0, 0, -19}, 1},     // a lamp before it
            {{1.5f, 0, -30}, 1},  // a lamp beside it, farther away
        };
        for (uint32_t i = 0; i < lights.size(); ++i) {
            wave.shadow_rays().at(SHADOW_ORIGIN, i) = test::lane_of({0.5f, 0.5f, 1}, test::as_float(i));
            wave.shadow_rays().at(SHADOW_DIRECTION, i) = test::lane_of(lights[i].first, lights[i].second);
        }
        wave.counters[COUNT_SHADOWS] = static_cast<uint32_t>(lights.size());
        wave.run_shadow();
        const auto seen = [&](uint32_t i) {
            return static_cast<double>(wave.visibility().at(i / 2, i % 2).x);
        };
        const auto through = [&](double cosine) {
            return count > 16 ? 0 : std::pow(1 - pane_reflectance(cosine), count);
        };
        EXPECT_EQ(seen(0), 0) << count << " panes";
        EXPECT_NEAR(seen(1), through(1), 1e-5) << count << " panes";
        EXPECT_NEAR(seen(2), through(30 / std::hypot(30, 1.5)), 1e-5) << count << " panes";
    }
}

// Without panes in the scene the kernel is built without their transmittance: only opaque surfaces count.
TEST_F(ShadowStage, AnyHitVariantAgreesOnOpaqueSurfaces) {
    test::StageBench wave = bench();
    wave.kernel_options = "-D NEED_AREA_LIGHTS=1 -D NEED_POINT_LIGHTS=1";  // and no panes
    wave.run_shadow();
    for (uint32_t i = 0; i < COUNT; ++i) {
        const bool free = QUERIES[i].expected != V3f(0);
        EXPECT_EQ(test::xyz_of(visibility(wave, i)), free ? V3f(1) : V3f(0)) << "query " << i;
    }
}

TEST_F(ShadowStage, OnlyCountedRaysAreTraced) {
    test::StageBench wave = bench();
    wave.counters[COUNT_SHADOWS] = 4;
    wave.run_shadow();
    for (uint32_t i = 0; i < COUNT; ++i) {
        const bool written = test::bits(visibility(wave, i)) != test::bits(test::canary());
        EXPECT_EQ(written, i < 4) << "query " << i;
    }
}

}  // namespace
}  // namespace obscura
