// SPDX-License-Identifier: Apache-2.0
// Sub-devices of one device share a render: its picture is that of the whole device, bit for bit, whoever rendered what;
// stopped, it has the first samples of every pixel.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "support/busy_room.h"
#include "support/render.h"
#include "support/same_bits.h"

namespace obscura::test {
namespace {

constexpr uint32_t WIDTH = 96, HEIGHT = 72;

class SeveralDevices : public DeviceTest {
  protected:
    void SetUp() override {
        DeviceTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        if (device().info().max_sub_devices < 2) GTEST_SKIP() << device().name() << " can't be split";
        devices_ = open_devices(fmt::format("{}/2", device().info().index));
        ASSERT_EQ(devices_.size(), 2u);
        for (const auto& part : devices_) {
            libraries_.push_back(std::make_unique<ProgramLibrary>(*part));
            parts_.push_back({*part, *libraries_.back()});
        }
    }

    static RenderSettings room_settings(uint32_t spp = 8) {
        RenderSettings settings = picture(WIDTH, HEIGHT, spp, 3);
        settings.light_samples = 2;
        return settings;
    }
    RenderJob job(const RenderSettings& settings, const RenderCut& cut = {}) const {
        RenderJob job{room_, settings, every_layer(), cut.queue_bytes, cut.wave_size};
        return job;
    }
    RenderResult render_shared(const RenderJob& job) const {
        return render_scene(parts_, job, [](double, const RayCounts&) { return true; });
    }
    void expect_same(const RenderSettings& settings, const RenderCut& cut = {}) const {
        const RenderResult shared = render_shared(job(settings, cut));
        EXPECT_TRUE(shared.complete);
        EXPECT_EQ(shared.samples_per_pixel, settings.spp);
        expect_same_bits(shared.image, render(room_, settings, every_layer()).image);
    }

    Scene room_ = busy_room();
    std::vector<std::unique_ptr<Device>> devices_;
    std::vector<std::unique_ptr<ProgramLibrary>> libraries_;
    std::vector<RenderDevice> parts_;
};

TEST_F(SeveralDevices, PartsAreDevicesOfTheirOwn) {
    uint32_t units = 0;
    for (const RenderDevice& part : parts_)
        units += part.device.info().compute_units;
    EXPECT_EQ(units, device().info().compute_units);
    EXPECT_EQ(parts_[0].device.name(), device().name() + " (1 of 2)");
    EXPECT_EQ(parts_[1].device.name(), device().name() + " (2 of 2)");
}

TEST_F(SeveralDevices, PictureIsThatOfTheWholeDevice) {
    expect_same(room_settings());
}

TEST_F(SeveralDevices, PictureIsTheSameForEveryCutIntoWaves) {
    for (const uint64_t wave_size : {uint64_t{64}, uint64_t{1001}, uint64_t{WIDTH * HEIGHT + 17}})
        expect_same(room_settings(), {.wave_size = wave_size});
    expect_same(room_settings(), {.queue_bytes = uint64_t{256} << 10});
}

TEST_F(SeveralDevices, PictureIsTheSameForACropAndForManySamples) {
    RenderSettings crop = room_settings();
    crop.crop = {0.37, 0.9, 0.13, 0.61};
    expect_same(crop);
    RenderSettings pixel = room_settings(5000);
    pixel.crop = {0.5, 0.51, 0.5, 0.513};
    expect_same(pixel);
}

TEST_F(SeveralDevices, WorkIsThatOfTheWholeDevice) {
    RenderJob shared_job = job(room_settings(), {.wave_size = 2048});
    shared_job.count_visits = true;
    const RenderResult shared = render_shared(shared_job);
    const RenderResult whole = render(room_, room_settings());
    ASSERT_EQ(shared.devices.size(), 2u);
    RayCounts sum;
    std::array<uint64_t, RAY_QUEUES.size()> visited{};
    for (const DeviceWork& part : shared.devices) {
        EXPECT_GT(part.rays.camera, 0u);
        EXPECT_EQ(part.profile.at("camera").items, part.rays.camera);
        sum += part.rays;
        for (size_t i = 0; i < visited.size(); ++i)
            visited[i] += part.visits->queues[i].rays;
    }
    EXPECT_EQ(sum.camera, whole.rays.camera);
    EXPECT_EQ(sum.shadow, whole.rays.shadow);
    EXPECT_EQ(sum.glossy, whole.rays.glossy);
    EXPECT_EQ(sum.obscurance, whole.rays.obscurance);
    EXPECT_EQ(shared.rays.total(), whole.rays.total());
    EXPECT_EQ(visited, (std::array{sum.camera, sum.shadow, sum.glossy, sum.obscurance}));
    for (const auto& [row, stage] : shared.profile)
        EXPECT_EQ(stage.items, row == "film" ? stage.items : whole.profile.at(row).items) << row;
    EXPECT_EQ(shared.bytes.at("bvh"), 2 * whole.bytes.at("bvh"));

    double of_rays = 0, of_pixels = 0;
    for (const RayVisits& queue : shared.visits->queues)
        of_rays += mean(queue.nodes) * static_cast<double>(queue.rays);
    for (const float nodes : shared.nodes_per_sample)
        of_pixels += 8.0 * static_cast<double>(nodes);
    EXPECT_NEAR(of_pixels / of_rays, 1, 1e-5);
}

// What the whole device has rendered after so many waves.
RenderResult stopped_after(const RenderJob& job, Device& device, ProgramLibrary& library, uint32_t waves) {
    uint32_t calls = 0;
    return render_scene(device, library, job, [&](double, const RayCounts&) { return calls++ < waves; });
}

TEST_F(SeveralDevices, StoppedPictureHasTheFirstSamplesOfEveryPixel) {
    const RenderSettings settings = room_settings();
    // One wave of so many samples of every pixel.
    std::vector<Image> after;
    for (uint32_t samples = 0; samples <= settings.spp; ++samples) {
        const uint64_t wave_size = uint64_t{WIDTH} * HEIGHT * std::max(samples, 1u);
        RenderResult result = stopped_after(job(settings, {.wave_size = wave_size}), device(),
                                            shared_library(64), samples == 0 ? 0 : 1);
        EXPECT_EQ(result.samples_per_pixel, samples);
        after.push_back(std::move(result.image));
    }
    for (const double end : {0.1, 0.7}) {
        const RenderResult stopped =
            render_scene(parts_, job(settings, {.wave_size = 777}),
                         [&](double fraction, const RayCounts&) { return fraction < end; });
        EXPECT_FALSE(stopped.complete);
        EXPECT_LT(stopped.samples_per_pixel, settings.spp);
        EXPECT_GE(stopped.samples_per_pixel, end > 0.5 ? settings.spp / 2 : 0u);
        for (size_t pixel = 0; pixel < size_t{WIDTH} * HEIGHT; ++pixel) {
            const auto is_after = [&](const Image& image) {
                return std::ranges::all_of(stopped.image.layers, [&](const Layer& layer) {
                    const size_t channels = layer.channel_count();
                    const float* const expected =
                        image.find_layer(layer.name)->pixels.data() + pixel * channels;
                    return std::equal(expected, expected + channels, layer.pixels.data() + pixel * channels);
                });
            };
            ASSERT_TRUE(std::any_of(after.begin() + stopped.samples_per_pixel, after.end(), is_after))
                << "pixel " << pixel;
        }
    }
}

TEST_F(SeveralDevices, FailureOfOneStopsTheOthers) {
    std::atomic<int> calls = 0;
    const auto fail_once = [&](double fraction, const RayCounts&) {
        if (fraction > 0 && ++calls == 3) throw std::runtime_error("a device fails");
        return true;
    };
    EXPECT_THROW(render_scene(parts_, job(room_settings(), {.wave_size = 64}), fail_once),
                 std::runtime_error);
    EXPECT_LE(calls, 4);  // the other was in its wave
}

}  // namespace
}  // namespace obscura::test
