// SPDX-License-Identifier: Apache-2.0
// Buffers on the device: contents, sizes, the ledger; and the binding of arguments by launch().
#include "device/buffer.h"

#include <array>
#include <numeric>
#include <type_traits>

#include "base/error.h"
#include "device/launch.h"
#include "device/program.h"
#include "support/device.h"

namespace obscura {
namespace {

using test::DeviceTest;

class DeviceBuffer : public DeviceTest {};
class MemoryLedgerOfDevice : public DeviceTest {};
class Launching : public DeviceTest {};

std::vector<uint32_t> counting(size_t count) {
    std::vector<uint32_t> values(count);
    std::iota(values.begin(), values.end(), 1u);
    return values;
}

TEST_F(DeviceBuffer, DownloadGivesWhatWasUploaded) {
    const auto values = counting(1000);
    const Buffer buffer = Buffer::holding(device(), "values", "scene", values);
    EXPECT_EQ(buffer.bytes(), 4000u);
    EXPECT_EQ(buffer.contents<uint32_t>(), values);
}

TEST_F(DeviceBuffer, TransferOfPartLeavesTheRest) {
    Buffer buffer = Buffer::holding(device(), "values", "scene", counting(8));
    buffer.upload(std::array<uint32_t, 2>{100, 200}, 3);
    std::array<uint32_t, 3> part{};
    buffer.download(part, 2);
    EXPECT_EQ(part, (std::array<uint32_t, 3>{3, 100, 200}));
    EXPECT_EQ(buffer.contents<uint32_t>(), (std::vector<uint32_t>{1, 2, 3, 100, 200, 6, 7, 8}));
}

TEST_F(DeviceBuffer, EnqueuedTransfersAreDoneAfterFinish) {
    const auto values = counting(100);
    Buffer buffer(device(), "values", "scene", 400);
    buffer.upload(values, 0, Transfer::enqueued);
    std::vector<uint32_t> back(100);
    buffer.download(back, 0, Transfer::enqueued);
    device().finish("test");
    EXPECT_EQ(back, values);
}

TEST_F(DeviceBuffer, ReadingInPlaceSeesWhatWasEnqueuedBefore) {
    Buffer buffer = Buffer::holding(device(), "values", "scene", counting(1000));
    const std::array<uint32_t, 2> two{100, 200};
    buffer.upload(two, 3, Transfer::enqueued);
    std::vector<uint32_t> seen;
    buffer.read_in_place<uint32_t>(
        6, [&](std::span<const uint32_t> values) { seen.assign(values.begin(), values.end()); });
    EXPECT_EQ(seen, (std::vector<uint32_t>{1, 2, 3, 100, 200, 6}));
    buffer.upload(counting(1), 3);
    EXPECT_EQ(buffer.contents<uint32_t>().at(3), 1u) << "the buffer is the device's again";
}

TEST_F(DeviceBuffer, ClearSetsEveryByteToZero) {
    for (const size_t bytes : {1u, 3u, 16u, 4097u}) {
        Buffer buffer = Buffer::holding(device(), "values", "scene", std::vector<uint8_t>(bytes, 0xa5));
        buffer.clear();
        EXPECT_EQ(buffer.contents<uint8_t>(), std::vector<uint8_t>(bytes, 0));
    }
}

TEST_F(DeviceBuffer, EmptyBufferHasHandleAndNoContents) {
    Buffer buffer(device(), "nothing", "scene", 0);
    EXPECT_NE(buffer.handle()(), nullptr);
    EXPECT_EQ(buffer.bytes(), 0u);
    buffer.upload(std::vector<float>());
    buffer.clear();
    EXPECT_TRUE(buffer.contents<float>().empty());
}

TEST_F(DeviceBuffer, RangeBeyondTheEndAborts) {
    Buffer buffer(device(), "values", "scene", 16);
    EXPECT_DEATH(buffer.upload(counting(5)), "values");
    EXPECT_DEATH(buffer.upload(counting(1), 4), "values");
    EXPECT_DEATH(buffer.upload(counting(1), ~uint64_t{0} / 4), "values");
}

TEST_F(DeviceBuffer, MoreThanTheLargestAllocationIsRefusedByNameAndSize) {
    const uint64_t bytes = device().info().max_allocation_bytes + 1;
    const uint64_t bytes_before = device().memory().current_bytes();
    try {
        Buffer buffer(device(), "the queue of rays", "queues", bytes);
        FAIL() << "no exception";
    } catch (const DeviceError& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("the queue of rays"), std::string::npos) << message;
        EXPECT_NE(message.find(std::to_string(bytes)), std::string::npos) << message;
        EXPECT_NE(message.find(std::to_string(bytes - 1)), std::string::npos) << message;
    }
    EXPECT_EQ(device().memory().current_bytes(), bytes_before);
}

TEST_F(MemoryLedgerOfDevice, CountsByCategoryNowAndAtMost) {
    Device own = open_device();
    {
        Buffer scene(own, "a", "scene", 1000);
        Buffer queue(own, "b", "queues", 500);
        Buffer moved = std::move(queue);
        EXPECT_EQ(own.memory().current_bytes(), 1500u);
        EXPECT_EQ(own.memory().current_bytes("queues"), 500u);
        moved = Buffer(own, "c", "queues", 100);  // both exist for a moment
        EXPECT_EQ(own.memory().current_bytes(), 1100u);
    }
    EXPECT_EQ(own.memory().current_bytes(), 0u);
    EXPECT_EQ(own.memory().peak_bytes(), 1600u);
    EXPECT_EQ(own.memory().peak_bytes("queues"), 600u);
    EXPECT_EQ(own.memory().peak_bytes("film"), 0u);
    own.memory().reset_peaks();
    EXPECT_EQ(own.memory().peak_bytes(), 0u);
    EXPECT_EQ(own.memory().peak_bytes("queues"), 0u);
}

struct Pair {
    float a, b;
};

constexpr const char* MIX_SOURCE = R"(
typedef struct Pair { float a, b; } Pair;
kernel void mix_values(global const float* in, global float* out, uint count, Pair pair, local float* scratch) {
    scratch[get_local_id(0)] = pair.a;
    const uint i = (uint)get_global_id(0);
    if (i >= count)
        return;
    out[i] = scratch[get_local_id(0)] * in[i] + pair.b;
})";

TEST_F(Launching, BindsBuffersNumbersStructsAndLocalMemory) {
    constexpr uint32_t COUNT = 1000;  // no multiple of the local size
    std::vector<float> in(COUNT);
    std::iota(in.begin(), in.end(), 0.0f);
    const Buffer source = Buffer::holding(device(), "in", "scene", in);
    Buffer target = Buffer::holding(device(), "out", "scene", std::vector<float>(COUNT + 1, -1.0f));
    ProgramLibrary library(device());
    const cl::Kernel kernel = library.kernel_from_text("mix", MIX_SOURCE, "mix_values");
    const cl::Event event = launch(device(), kernel, "mix", COUNT, 64, source, target, COUNT,
                                   Pair{2.0f, 0.5f}, LocalMemory{64 * sizeof(float)});
    event.wait();
    const auto out = target.contents<float>();
    for (uint32_t i = 0; i < COUNT; ++i)
        ASSERT_EQ(out[i], 2.0f * static_cast<float>(i) + 0.5f);
    EXPECT_EQ(out[COUNT], -1.0f);  // the filled-up group writes nothing
    cl_ulong start = 0, end = 0;
    EXPECT_EQ(event.getProfilingInfo(CL_PROFILING_COMMAND_START, &start), CL_SUCCESS);
    EXPECT_EQ(event.getProfilingInfo(CL_PROFILING_COMMAND_END, &end), CL_SUCCESS);
    EXPECT_GT(end, start);
}

// It would be bound after the value is gone.
TEST_F(Launching, TemporariesAreNoArguments) {
    EXPECT_TRUE((std::is_constructible_v<LaunchArgument, const Buffer&>));
    EXPECT_FALSE((std::is_constructible_v<LaunchArgument, Buffer>));
    EXPECT_TRUE((std::is_constructible_v<LaunchArgument, const uint32_t&>));
    EXPECT_FALSE((std::is_constructible_v<LaunchArgument, uint32_t>));
    EXPECT_TRUE((std::is_constructible_v<LaunchArgument, LocalMemory>));
}

TEST_F(Launching, WrongNumberOfArgumentsAborts) {
    ProgramLibrary library(device());
    const cl::Kernel kernel = library.kernel_from_text("mix", MIX_SOURCE, "mix_values");
    EXPECT_DEATH(launch(device(), kernel, "mix", 1, 64, 1u), "takes 5 arguments, 1 are given");
}

TEST_F(Launching, WrongArgumentSizeNamesStageAndArgument) {
    ProgramLibrary library(device());
    const cl::Kernel kernel = library.kernel_from_text("mix", MIX_SOURCE, "mix_values");
    const Buffer buffer(device(), "values", "scene", 256);
    try {
        launch(device(), kernel, "mix", 1, 64, buffer, buffer, uint64_t{1}, Pair{}, LocalMemory{256});
        FAIL() << "no exception";
    } catch (const DeviceError& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("mix: clSetKernelArg of argument 2 (8 bytes) failed with CL_INVALID_ARG_SIZE"),
                  std::string::npos)
            << message;
    }
}

TEST_F(Launching, TooLargeGroupNamesStageAndCount) {
    ProgramLibrary library(device());
    const cl::Kernel kernel = library.kernel_from_text("mix", MIX_SOURCE, "mix_values");
    const Buffer buffer(device(), "values", "scene", 256);
    const auto local_size = static_cast<uint32_t>(device().max_work_group_size() + 1);
    try {
        launch(device(), kernel, "mix", 7, local_size, buffer, buffer, 0u, Pair{}, LocalMemory{256});
        FAIL() << "no exception";
    } catch (const DeviceError& error) {
        const std::string message = error.what();
        // A driver may find the size of the group or that of its one dimension too large.
        const bool names_group = message.find("CL_INVALID_WORK_GROUP_SIZE") != std::string::npos;
        const bool names_items = message.find("CL_INVALID_WORK_ITEM_SIZE") != std::string::npos;
        EXPECT_TRUE(names_group || names_items) << message;
        EXPECT_NE(message.find("mix: "), std::string::npos) << message;
        EXPECT_NE(message.find("7 items"), std::string::npos) << message;
    }
}

}  // namespace
}  // namespace obscura
