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
// refers to what it was made from, which has to live until launch() returns.
class LaunchArgument {
  public:
    explicit LaunchArgument(const Buffer& buffer)
        : value_(&buffer.handle()()), bytes_(sizeof(cl_mem)), is_set_(buffer.handle()() != nullptr) {}
    explicit LaunchArgument(const LocalMemory& local) : bytes_(local.bytes) {}
    // A value as its bytes. A size that differs from the kernel's is refused by launch().
    explicit LaunchArgument(std::span<const std::byte> value) : value_(value.data()), bytes_(value.size()) {}
    template <typename T>
    explicit LaunchArgument(const T& value) : value_(&value), bytes_(sizeof(T)) {
        static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T> && !std::is_same_v<T, bool>,
                      "kernel arguments are buffers, local memory, numbers and plain structs");
    }

    const void* value() const { return value_; }
    uint64_t bytes() const { return bytes_; }
    bool is_set() const { return is_set_; }  // false: a buffer without memory

  private:
    const void* value_ = nullptr;
    uint64_t bytes_;
    bool is_set_ = true;
};

// What one launch is, for error messages.
struct LaunchPlace {
    const Device& device;
    const cl::Kernel& kernel;
    std::string_view stage;
    uint64_t item_count;
};

// Runs the kernel over item_count > 0 items in groups of local_size; the last group is filled up, so the kernel
// compares its index with the count it is given. Returns at once; the event carries the kernel's times.
cl::Event launch(const LaunchPlace& place, uint32_t local_size, std::span<const LaunchArgument> arguments);

// The same with the arguments where it is called.
template <typename... Args>
cl::Event launch(const Device& device, const cl::Kernel& kernel, std::string_view stage, uint64_t item_count,
                 uint32_t local_size, const Args&... args) {
    const std::array<LaunchArgument, sizeof...(Args)> arguments{LaunchArgument(args)...};
    return launch({device, kernel, stage, item_count}, local_size, arguments);
}

}  // namespace obscura
