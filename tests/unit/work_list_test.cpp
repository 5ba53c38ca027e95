// SPDX-License-Identifier: Apache-2.0
// The work that devices share: every sample once and in order, whoever takes what, and nobody left waiting.
#include "wavefront/work_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <random>
#include <thread>
#include <vector>

namespace obscura {
namespace {

// Threads that take pieces, some of them slowly, until there are no more: how many passes each pixel has then.
std::vector<uint32_t> passes_after(WorkList& list, uint32_t pixels, uint32_t thread_count) {
    std::vector<uint32_t> passes(pixels);  // no atomics: the sanitizers see a pixel in two hands
    std::atomic<bool> in_order = true;
    std::vector<std::thread> threads;
    for (uint32_t thread = 0; thread < thread_count; ++thread)
        threads.emplace_back([&, thread] {
            std::mt19937 random(thread);
            while (const auto piece = list.take()) {
                for (uint32_t pixel = piece->first_pixel; pixel < piece->first_pixel + piece->pixel_count;
                     ++pixel) {
                    if (passes[pixel] != piece->first_pass) in_order = false;
                    passes[pixel] += piece->pass_count;
                }
                if (random() % 4 == 0) std::this_thread::sleep_for(std::chrono::microseconds(100 * thread));
                list.finish(*piece);
            }
        });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_TRUE(in_order);
    return passes;
}

TEST(WorkList, GivesEveryPassOfEveryPixelOnceAndInOrder) {
    for (const uint32_t threads : {1u, 2u, 5u}) {
        for (const uint32_t pixels : {1u, 7u, 1000u}) {
            for (const uint32_t spp : {1u, 3u, 64u}) {
                for (const PieceSize size : {PieceSize{1, 1}, {3, 2}, {64, 7}, {pixels, spp}, {5000, 100}}) {
                    WorkList list(pixels, spp, size);
                    EXPECT_EQ(passes_after(list, pixels, threads), std::vector<uint32_t>(pixels, spp));
                    EXPECT_FALSE(list.take());
                }
            }
        }
    }
}

TEST(WorkList, GivesRangesWithFewestPassesFirst) {
    WorkList list(10, 2, {4, 1});
    EXPECT_EQ(list.range_count(), 3u);
    std::vector<uint32_t> first_pixels, first_passes;
    while (const auto piece = list.take()) {
        first_pixels.push_back(piece->first_pixel);
        first_passes.push_back(piece->first_pass);
        EXPECT_EQ(piece->pixel_count, piece->range == 2 ? 2u : 4u);
        list.finish(*piece);
    }
    EXPECT_EQ(first_pixels, (std::vector<uint32_t>{0, 4, 8, 0, 4, 8}));
    EXPECT_EQ(first_passes, (std::vector<uint32_t>{0, 0, 0, 1, 1, 1}));
}

// Two ranges in the hands of others, of which one comes back with work left.
TEST(WorkList, TakingWaitsForWorkInOtherHands) {
    WorkList list(2, 2, {1, 1});
    const auto first = list.take();
    const auto second = list.take();
    auto third = std::async(std::launch::async, [&] { return list.take(); });
    list.finish(*second);
    const auto taken = third.get();
    ASSERT_TRUE(taken);
    EXPECT_EQ(taken->range, second->range);
    EXPECT_EQ(taken->first_pass, 1u);
    auto fourth = std::async(std::launch::async, [&] { return list.take(); });
    list.finish(*taken);  // the last of its range
    list.finish(*first);
    const auto last = fourth.get();
    ASSERT_TRUE(last);
    EXPECT_EQ(last->range, first->range);
    list.finish(*last);
    EXPECT_FALSE(list.take());
}

TEST(WorkList, StopEndsTheWait) {
    WorkList list(1, 2, {1, 1});
    ASSERT_TRUE(list.take());
    auto waiting = std::async(std::launch::async, [&] { return list.take(); });
    EXPECT_FALSE(list.is_stopped());
    list.stop();
    EXPECT_FALSE(waiting.get());
    EXPECT_TRUE(list.is_stopped());
}

TEST(WorkList, FinishingWhatNobodyHoldsAborts) {
    WorkList list(1, 1, {1, 1});
    EXPECT_DEATH(list.finish({}), "nobody's hands");
}

TEST(PieceSize, OneDeviceTakesAll) {
    const PieceSize size = piece_size(480000, 8, 1 << 17, 1);
    EXPECT_EQ(size.pixel_count, 480000u);
    EXPECT_EQ(size.pass_count, 8u);
}

TEST(PieceSize, PiecesAreWavesAndSmallPartsOfTheWork) {
    for (const uint32_t pixels : {1u, 50u, 3072u, 480000u, 0x7fffffffu}) {
        for (const uint32_t spp : {1u, 8u, 1u << 20}) {
            for (const uint64_t wave_size : {1ull, 64ull, 1ull << 17, 1ull << 31}) {
                for (const size_t devices : {2u, 7u, 64u}) {
                    const PieceSize size = piece_size(pixels, spp, wave_size, devices);
                    SCOPED_TRACE(testing::Message() << size.pixel_count << " x " << size.pass_count);
                    const uint64_t samples = uint64_t{size.pixel_count} * size.pass_count;
                    const uint64_t all = uint64_t{pixels} * spp;
                    ASSERT_GE(size.pixel_count, 1u);
                    ASSERT_LE(size.pixel_count, pixels);
                    ASSERT_GE(size.pass_count, 1u);
                    ASSERT_LE(size.pass_count, spp);
                    EXPECT_LE(samples, wave_size);
                    EXPECT_LE(samples, std::max<uint64_t>(4096, all / (32 * devices)));
                    EXPECT_GE(pixels / size.pixel_count, std::min<uint64_t>(pixels, 4 * devices));
                }
            }
        }
    }
}

}  // namespace
}  // namespace obscura
