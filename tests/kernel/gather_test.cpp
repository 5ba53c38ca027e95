// SPDX-License-Identifier: Apache-2.0
// The stage gather: light samples times their visibility and the mean of the K obscurance results arrive in the layers
// of their path's slot, and in no other.
#include <array>

#include "support/device.h"
#include "support/kernel_queue.h"
#include "support/scene_builder.h"

namespace obscura {
namespace {

constexpr uint32_t K = 3;

class GatherStage : public test::DeviceTest {
  protected:
    // Every slot: light contributions that nothing blocks, no ambient light.
    test::StageBench bench(uint32_t capacity) {
        test::SceneBuilder builder;
        builder.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, builder.material(test::matte(Rgb(0.5f))));
        RenderSettings settings;
        settings.width = 8;
        settings.height = 8;
        settings.obscurance_rays = K;
        settings.light_samples = 2;
        test::StageBench bench(device(), builder.finish(), settings, capacity, {LAYER_OBSCURANCE});
        for (uint32_t slot = 0; slot < capacity; ++slot) {
            bench.start_path(slot);
            bench.paths().at(PATH_AMBIENT, slot) = {};
            for (uint32_t sample = 0; sample < bench.light_samples; ++sample) {
                bench.contribution(sample, 0, slot) = {static_cast<float>(slot + 1), 2,
                                                       static_cast<float>(sample), 0};
                bench.contribution(sample, 1, slot) = {0.25f, 0.5f, 0.75f, 0};
                bench.visibility().at(sample, slot) = {1, 1, 1, 0};
            }
        }
        return bench;
    }
    static V3f layer(test::StageBench& bench, uint32_t layer, uint32_t slot) {
        return test::xyz_of(bench.layer(layer, slot));
    }
};

TEST_F(GatherStage, SumsLightSamplesThatAreSeen) {
    test::StageBench wave = bench(2);
    wave.set_slot(0, 1);
    wave.set_slot(1, 0);
    ASSERT_EQ(wave.light_samples, 4U) << "two of each group";
    wave.visibility().at(1, 0) = {0, 0, 0, 0};         // blocked
    wave.visibility().at(2, 0) = {0.5f, 0.25f, 1, 0};  // through a pane
    wave.contribution(3, 0, 0) = {};                   // no light, so no shadow ray ...
    wave.contribution(3, 1, 0) = {};
    wave.visibility().at(3, 0) = {1e30f, 1e30f, 1e30f, 0};  // ... and nothing meaningful here
    wave.run_gather(2, 0);
    EXPECT_EQ(layer(wave, LAYER_DIRECT, 0), V3f(1 + 0.5f, 2 + 0.5f, 0 + 2));
    EXPECT_EQ(layer(wave, LAYER_SPECULAR_EMISSION, 0), V3f(0.25f + 0.125f, 0.5f + 0.125f, 0.75f + 0.75f));
    EXPECT_EQ(layer(wave, LAYER_DIRECT, 1), V3f(8, 8, 6));
    EXPECT_EQ(layer(wave, LAYER_SPECULAR_EMISSION, 1), V3f(1, 2, 3));
    EXPECT_EQ(layer(wave, LAYER_SPECULAR_DIRECT, 1), V3f(0, 0, 0));
    EXPECT_TRUE(wave.guards_untouched());
}

// Nothing clears a slot between two waves.
TEST_F(GatherStage, FirstDepthStartsTheLayersWhateverTheyHeld) {
    constexpr std::array STARTED{LAYER_DIRECT,          LAYER_AMBIENT,          LAYER_SPECULAR_EMISSION,
                                 LAYER_SPECULAR_DIRECT, LAYER_SPECULAR_AMBIENT, LAYER_OBSCURANCE};
    test::StageBench clean = bench(1), used = bench(1);
    clean.set_slot(0, 0);
    used.set_slot(0, 0);
    for (const int started : STARTED)
        used.layer(static_cast<uint32_t>(started), 0) = {7, 8, 9, 10};
    clean.run_gather(1, 0);
    used.run_gather(1, 0);
    EXPECT_EQ(layer(used, LAYER_DIRECT, 0), V3f(4, 8, 6));
    for (const int started : STARTED) {
        const auto number = static_cast<uint32_t>(started);
        EXPECT_EQ(test::bits(used.layer(number, 0)), test::bits(clean.layer(number, 0)))
            << "layer " << started;
    }
}

TEST_F(GatherStage, DeeperLightGoesToTheSpecularLayers) {
    test::StageBench wave = bench(1);
    wave.set_slot(0, 0);
    wave.layer(LAYER_SPECULAR_DIRECT, 0) = {10, 20, 30, 0};
    wave.paths().at(PATH_AMBIENT, 0) = {2, 4, 6, AMBIENT_CONSTANT};
    wave.run_gather(1, 2);
    EXPECT_EQ(layer(wave, LAYER_DIRECT, 0), V3f(0, 0, 0));
    EXPECT_EQ(layer(wave, LAYER_SPECULAR_DIRECT, 0), V3f(14, 28, 36)) << "added to what was there";
    EXPECT_EQ(layer(wave, LAYER_AMBIENT, 0), V3f(0, 0, 0));
    EXPECT_EQ(layer(wave, LAYER_SPECULAR_AMBIENT, 0), V3f(2, 4, 6)) << "W = 1";
}

TEST_F(GatherStage, AmbientIsWeightedByTheMeanOfTheResults) {
    test::StageBench wave = bench(3);
    wave.set_slot(0, 2);
    wave.paths().at(PATH_AMBIENT, 2) = {1, 10, 100, AMBIENT_TRACED};
    for (uint32_t k = 0; k < K; ++k)
        wave.results().at(0, 2 * K + k) = {static_cast<float>(k), 0.5f, 0.25f * static_cast<float>(k), 0.75f};
    wave.run_gather(1, 0);
    EXPECT_EQ(layer(wave, LAYER_AMBIENT, 2), V3f(1, 5, 25));
    EXPECT_EQ(layer(wave, LAYER_OBSCURANCE, 2), V3f(1, 0.5f, 0.25f));
    EXPECT_EQ(wave.layer(LAYER_OBSCURANCE, 2).w, 0.75f) << "the colourless W";
}

// The obscurance layer shows W where a path first meets a diffuse surface, not at each one.
TEST_F(GatherStage, ObscuranceLayerIsWrittenOncePerPath) {
    test::StageBench wave = bench(1);
    wave.set_slot(0, 0);
    wave.paths().at(PATH_AMBIENT, 0) = {1, 1, 1, AMBIENT_TRACED};
    for (uint32_t k = 0; k < K; ++k)
        wave.results().at(0, k) = {0.5f, 0.5f, 0.5f, 0.5f};
    wave.run_gather(1, 0);
    wave.run_gather(1, 1);
    EXPECT_EQ(layer(wave, LAYER_OBSCURANCE, 0), V3f(0.5f));
    EXPECT_EQ(layer(wave, LAYER_AMBIENT, 0), V3f(0.5f));
    EXPECT_EQ(layer(wave, LAYER_SPECULAR_AMBIENT, 0), V3f(0.5f));
    EXPECT_EQ(test::bits(wave.paths().at(PATH_SAMPLE, 0).w), PATH_OBSCURANCE_SEEN);
}

// Shade has reported such an item; gather only has to leave the memory behind the slots alone.
TEST_F(GatherStage, SlotBeyondTheLastIsNotFollowed) {
    constexpr uint32_t CAPACITY = 2;
    test::StageBench wave = bench(CAPACITY);
    wave.set_slot(0, CAPACITY);
    const auto before = wave.snapshot();
    wave.run_gather(1, 0);
    EXPECT_EQ(wave.snapshot(), before);
}

TEST_F(GatherStage, TouchesOnlyTheSlotsOfItsItems) {
    test::StageBench wave = bench(6);
    for (const uint32_t item : {0u, 1u, 2u})
        wave.set_slot(item, 2 * item);
    wave.set_slot(3, 1);  // beyond the count
    wave.run_gather(3, 0);
    for (uint32_t slot = 0; slot < 6; ++slot) {
        const V3f expected = slot % 2 == 0 ? V3f(4 * static_cast<float>(slot + 1), 8, 6) : V3f(0);
        EXPECT_EQ(layer(wave, LAYER_DIRECT, slot), expected) << "slot " << slot;
    }
}

}  // namespace
}  // namespace obscura
