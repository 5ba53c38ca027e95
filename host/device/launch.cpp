// SPDX-License-Identifier: Apache-2.0
// See launch.h.
#include "device/launch.h"

#include <algorithm>

#include "device/error.h"

namespace obscura::detail {

void set_argument(const LaunchPlace& place, uint32_t index, uint64_t bytes, const void* value) {
    const cl_int code = clSetKernelArg(place.kernel(), index, bytes, value);
    if (code != CL_SUCCESS)
        throw DeviceError("{}: clSetKernelArg of argument {} ({} bytes) failed with {} ({}) on {}.",
                          place.stage, index, bytes, error_name(code), code, place.device.name());
}

void check_argument_count(const LaunchPlace& place, uint32_t count) {
    cl_uint expected = 0;
    check(clGetKernelInfo(place.kernel(), CL_KERNEL_NUM_ARGS, sizeof(expected), &expected, nullptr),
          "clGetKernelInfo", place.stage, place.device.name());
    OBSCURA_CHECK(expected == count, "stage {}: the kernel takes {} arguments, {} are given", place.stage,
                  expected, count);
}

cl::Event enqueue(const LaunchPlace& place, uint32_t local_size) {
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

}  // namespace obscura::detail
