// SPDX-License-Identifier: Apache-2.0
// See warm_up.h.
#include "device/warm_up.h"

#include <array>
#include <span>
#include <string>
#include <vector>

#include "device/buffer.h"
#include "device/error.h"
#include "device/launch.h"

namespace obscura {
namespace {

// OpenCL doesn't tell the size of an argument that is passed by value, but refuses a wrong one.
LaunchArgument zero_of_its_size(const cl::Kernel& kernel, cl_uint index, std::string_view stage) {
    static constexpr std::array<std::byte, 1024> ZEROS{};
    for (size_t bytes = 1; bytes <= ZEROS.size(); bytes += bytes < 4 ? bytes : 4)
        if (clSetKernelArg(kernel(), index, bytes, ZEROS.data()) == CL_SUCCESS)
            return LaunchArgument::of_bytes(std::span(ZEROS).first(bytes));
    throw DeviceError(
        "{}: argument {} of the kernel is larger than {} bytes or has a type that can't be set.", stage,
        index, ZEROS.size());
}

}  // namespace

void warm_up(Device& device, const cl::Kernel& kernel, std::string_view stage, uint32_t local_size) {
    Buffer memory(device, "warm-up", "status", WARM_UP_BYTES);
    memory.clear();
    cl_uint count = 0;
    check(kernel.getInfo(CL_KERNEL_NUM_ARGS, &count), "clGetKernelInfo", stage, device.name());
    std::vector<LaunchArgument> arguments;
    for (cl_uint i = 0; i < count; ++i) {
        cl_kernel_arg_address_qualifier space = 0;
        check(kernel.getArgInfo(i, CL_KERNEL_ARG_ADDRESS_QUALIFIER, &space), "clGetKernelArgInfo", stage,
              device.name());
        if (space == CL_KERNEL_ARG_ADDRESS_PRIVATE)
            arguments.push_back(zero_of_its_size(kernel, i, stage));
        else if (space == CL_KERNEL_ARG_ADDRESS_LOCAL)
            arguments.emplace_back(LocalMemory{WARM_UP_BYTES});
        else
            arguments.emplace_back(memory);
    }
    launch({device, kernel, "warm-up of " + std::string(stage), 1, local_size}, arguments);
    device.finish(stage);
}

}  // namespace obscura
