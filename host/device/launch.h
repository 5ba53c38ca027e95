// SPDX-License-Identifier: Apache-2.0
// launch(): binds the arguments of a kernel, checks their number, and enqueues it over one dimension.
#pragma once

#include <cstdint>
#include <string_view>
#include <type_traits>

#include "base/error.h"
#include "device/buffer.h"

namespace obscura {

// An argument in local memory, bytes per work group.
struct LocalMemory {
    uint64_t bytes;
};

namespace detail {

// What one kernel launch is, for error messages.
struct LaunchPlace {
    const Device& device;
    const cl::Kernel& kernel;
    std::string_view stage;
    uint64_t item_count;
};

void set_argument(const LaunchPlace& place, uint32_t index, uint64_t bytes, const void* value);
void check_argument_count(const LaunchPlace& place, uint32_t count);
cl::Event enqueue(const LaunchPlace& place, uint32_t local_size);

inline void bind(const LaunchPlace& place, uint32_t index, const Buffer& buffer) {
    const cl_mem memory = buffer.handle()();
    OBSCURA_CHECK(memory != nullptr, "stage {}: argument {} is a buffer without memory", place.stage, index);
    set_argument(place, index, sizeof(memory), &memory);
}

inline void bind(const LaunchPlace& place, uint32_t index, LocalMemory local) {
    set_argument(place, index, local.bytes, nullptr);
}

// Scalars and the structs of kernels/shared, by value. A size that differs from the kernel's is refused.
template <typename T>
void bind(const LaunchPlace& place, uint32_t index, const T& value) {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T> && !std::is_same_v<T, bool>,
                  "kernel arguments are buffers, local memory, numbers and plain structs");
    set_argument(place, index, sizeof(T), &value);
}

}  // namespace detail

// Runs kernel over item_count > 0 items in groups of local_size; the last group is filled up, so the kernel
// compares its index with the count it is given. Returns at once; the event carries the kernel's times.
template <typename... Args>
cl::Event launch(Device& device, const cl::Kernel& kernel, std::string_view stage, uint64_t item_count,
                 uint32_t local_size, const Args&... args) {
    const detail::LaunchPlace place{device, kernel, stage, item_count};
    detail::check_argument_count(place, sizeof...(Args));
    uint32_t index = 0;
    (detail::bind(place, index++, args), ...);
    return detail::enqueue(place, local_size);
}

}  // namespace obscura
