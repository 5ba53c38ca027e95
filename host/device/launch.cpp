// SPDX-License-Identifier: Apache-2.0
// See launch.h.
#include "device/launch.h"

#include <algorithm>
#include <string>

#include "base/error.h"
#include "base/units.h"
#include "device/error.h"

namespace obscura {
namespace {

void set_arguments(const Launch& run, std::span<const LaunchArgument> arguments) {
    cl_uint expected = 0;
    check(clGetKernelInfo(run.kernel(), CL_KERNEL_NUM_ARGS, sizeof(expected), &expected, nullptr),
          "clGetKernelInfo", run.stage, run.device.name());
    OBSCURA_CHECK(expected == arguments.size(), "stage {}: the kernel takes {} arguments, {} are given",
                  run.stage, expected, arguments.size());
    for (cl_uint index = 0; index < expected; ++index) {
        const LaunchArgument& argument = arguments[index];
        OBSCURA_CHECK(argument.is_set(), "stage {}: argument {} is a buffer without memory", run.stage,
                      index);
        const cl_int code = clSetKernelArg(run.kernel(), index, argument.bytes(), argument.value());
        if (code != CL_SUCCESS)
            throw DeviceError("{}: clSetKernelArg of argument {} ({}) failed with {} ({}) on {}.", run.stage,
                              index, counted(argument.bytes(), "byte"), error_name(code), code,
                              run.device.name());
    }
}

}  // namespace

uint64_t grid_size(const Device& device, uint64_t item_count, uint32_t local_size) {
    const uint64_t wanted = std::max(item_count, device.smallest_grid());
    return (wanted + local_size - 1) / local_size * local_size;
}

cl::Event launch(const Launch& run, std::span<const LaunchArgument> arguments) {
    set_arguments(run, arguments);
    OBSCURA_CHECK(run.item_count > 0 && run.local_size > 0, "stage {}: {} items in groups of {}", run.stage,
                  run.item_count, run.local_size);
    const size_t global = grid_size(run.device, run.item_count, run.local_size);
    const size_t local = run.local_size;
    cl_event event = nullptr;
    check(clEnqueueNDRangeKernel(run.device.queue()(), run.kernel(), 1, nullptr, &global, &local, 0, nullptr,
                                 &event),
          "clEnqueueNDRangeKernel", run.stage, run.device.name(), run.item_count);
    cl::Event launched(event);  // takes over the reference that the call gave
    if (CommandLog* const commands = run.device.commands())
        commands->add(TraceCategory::kernel, std::string(run.stage), {"work items", uint64_t{global}},
                      launched);
    return launched;
}

}  // namespace obscura
