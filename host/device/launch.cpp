// SPDX-License-Identifier: Apache-2.0
// See launch.h.
#include "device/launch.h"

#include <algorithm>

#include "base/error.h"
#include "device/error.h"

namespace obscura {
namespace {

void set_arguments(const LaunchPlace& place, std::span<const LaunchArgument> arguments) {
    cl_uint expected = 0;
    check(clGetKernelInfo(place.kernel(), CL_KERNEL_NUM_ARGS, sizeof(expected), &expected, nullptr),
          "clGetKernelInfo", place.stage, place.device.name());
    OBSCURA_CHECK(expected == arguments.size(), "stage {}: the kernel takes {} arguments, {} are given",
                  place.stage, expected, arguments.size());
    for (cl_uint index = 0; index < expected; ++index) {
        const LaunchArgument& argument = arguments[index];
        OBSCURA_CHECK(argument.is_set(), "stage {}: argument {} is a buffer without memory", place.stage,
                      index);
        const cl_int code = clSetKernelArg(place.kernel(), index, argument.bytes(), argument.value());
        if (code != CL_SUCCESS)
            throw DeviceError("{}: clSetKernelArg of argument {} ({} bytes) failed with {} ({}) on {}.",
                              place.stage, index, argument.bytes(), error_name(code), code,
                              place.device.name());
    }
}

}  // namespace

cl::Event launch(const LaunchPlace& place, uint32_t local_size, std::span<const LaunchArgument> arguments) {
    set_arguments(place, arguments);
    OBSCURA_CHECK(place.item_count > 0 && local_size > 0, "stage {}: {} items in groups of {}", place.stage,
                  place.item_count, local_size);
    const uint64_t wanted = std::max(place.item_count, place.device.smallest_grid());
    const uint64_t group_count = (wanted + local_size - 1) / local_size;
    const size_t global = group_count * local_size;
    const size_t local = local_size;
    cl_event event = nullptr;
    check(clEnqueueNDRangeKernel(place.device.queue()(), place.kernel(), 1, nullptr, &global, &local, 0,
                                 nullptr, &event),
          "clEnqueueNDRangeKernel", place.stage, place.device.name(), place.item_count);
    return cl::Event(event);  // takes over the reference that the call gave
}

}  // namespace obscura
