// SPDX-License-Identifier: Apache-2.0
// Opening a device: context, queue, and the few properties that decide how kernels are built and launched.
#include "device/device.h"

#include <cstdlib>
#include <span>
#include <utility>

#include "device/error.h"

namespace obscura {

namespace {

cl::Device find_handle(const DeviceInfo& info) {
    constexpr const char* STAGE = "opening the device";
    std::vector<cl::Platform> platforms;
    check(cl::Platform::get(&platforms), "clGetPlatformIDs", STAGE, info.name);
    const auto platform_index = static_cast<size_t>(info.platform_index);
    const auto device_index = static_cast<size_t>(info.device_index);
    std::vector<cl::Device> devices;
    if (platform_index < platforms.size())
        check(platforms[platform_index].getDevices(CL_DEVICE_TYPE_ALL, &devices), "clGetDeviceIDs", STAGE,
              info.name);
    if (device_index >= devices.size())
        throw DeviceError("{}: {} is gone since the devices were listed.", STAGE, info.name);
    return devices[device_index];
}

// Without a selector the environment's choice, which the message names when it is a wrong one.
int select_named(std::span<const DeviceInfo> devices, std::string_view selector) {
    const char* const variable = std::getenv("OBSCURA_DEVICE");
    if (!selector.empty() || variable == nullptr) return select_device(devices, selector);
    try {
        return select_device(devices, variable);
    } catch (const InputError& error) {
        throw InputError("The environment variable OBSCURA_DEVICE: {}", error.what());
    }
}

}  // namespace

Device::Device(cl::Device handle, DeviceInfo info) : handle_(std::move(handle)), info_(std::move(info)) {
    constexpr const char* STAGE = "opening the device";
    cl_int code = CL_SUCCESS;
    context_ = cl::Context(handle_, nullptr, nullptr, nullptr, &code);
    check(code, "clCreateContext", STAGE, info_.name);
    queue_ = cl::CommandQueue(context_, handle_, CL_QUEUE_PROFILING_ENABLE, &code);
    check(code, "clCreateCommandQueue", STAGE, info_.name);

    cl_device_fp_config float_config = 0;
    check(handle_.getInfo(CL_DEVICE_SINGLE_FP_CONFIG, &float_config), "clGetDeviceInfo", STAGE, info_.name);
    correctly_rounded_division_ = (float_config & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
    size_t group_size = 0;
    check(handle_.getInfo(CL_DEVICE_MAX_WORK_GROUP_SIZE, &group_size), "clGetDeviceInfo", STAGE, info_.name);
    max_work_group_size_ = group_size;
    compiles_at_launch_ = info_.platform == POCL_PLATFORM_NAME;
    runs_items_in_turn_ = info_.is_cpu && (compiles_at_launch_ || info_.platform == "Oclgrind");
}

void Device::log_commands(TraceRecord& trace) {
    commands_ = std::make_unique<CommandLog>(trace, context_, queue_, info_.name);
}

void Device::finish(std::string_view stage) const {
    check(queue_.finish(), "clFinish", stage, info_.name);
}

Device open_device(std::string_view selector) {
    const std::vector<DeviceInfo> devices = list_devices();
    const DeviceInfo& info = devices[static_cast<size_t>(select_named(devices, selector))];
    return Device(find_handle(info), info);
}

}  // namespace obscura
