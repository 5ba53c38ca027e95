// SPDX-License-Identifier: Apache-2.0
// launch(): binds the arguments of a kernel, checks their number, and enqueues it over one dimension.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>

#include "device/buffer.h"

namespace obscura {

// An argument in local memory, bytes per work group.
struct LocalMemory {
    uint64_t bytes;
};

// What a kernel parameter is set to: a buffer, local memory, or by value a number or a plain struct of kernels/shared. It
// refers to the buffer or value that it was made from, which has to live until launch() returns.
class LaunchArgument {
  public:
    explicit LaunchArgument(const Buffer& buffer)
        : value_(&buffer.handle()()), bytes_(sizeof(cl_mem)), is_set_(buffer.handle()() != nullptr) {}
    explicit LaunchArgument(LocalMemory local) : LaunchArgument(nullptr, local.bytes) {}
    template <typename T>
    explicit LaunchArgument(const T& value) : LaunchArgument(&value, sizeof(T)) {
        static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T> && !std::is_same_v<T, bool>,
                      "kernel arguments are buffers, local memory, numbers and plain structs");
    }
    template <typename T>
    explicit LaunchArgument(const T&& gone_too_soon) = delete;
    // A value of a type that only the kernel knows. A size that differs from its own is refused by launch().
    static LaunchArgument of_bytes(std::span<const std::byte> value) {
        return LaunchArgument(value.data(), value.size());
    }

    const void* value() const { return value_; }
    uint64_t bytes() const { return bytes_; }
    bool is_set() const { return is_set_; }  // false: a buffer without memory

  private:
    LaunchArgument(const void* value, uint64_t bytes) : value_(value), bytes_(bytes) {}

    const void* value_;
    uint64_t bytes_;
    bool is_set_ = true;
};

// A kernel's run over item_count > 0 items in groups of local_size. The last group is filled up, so the kernel compares
// its index with the count it is given.
struct Launch {
    const Device& device;
    const cl::Kernel& kernel;
    std::string_view stage;  // for error messages and traces
    uint64_t item_count;
    uint32_t local_size;
};

// Work items of a launch: its items, and those that fill up the last group and the smallest grid.
uint64_t grid_size(const Device& device, uint64_t item_count, uint32_t local_size);

// Returns at once; the event carries the kernel's times.
cl::Event launch(const Launch& run, std::span<const LaunchArgument> arguments);

// The same with the arguments where it is called.
template <typename... Args>
cl::Event launch(const Device& device, const cl::Kernel& kernel, std::string_view stage, uint64_t item_count,
                 uint32_t local_size, const Args&... args) {
    const std::array<LaunchArgument, sizeof...(Args)> arguments{LaunchArgument(args)...};
    return launch({device, kernel, stage, item_count, local_size}, arguments);
}

}  // namespace obscura
