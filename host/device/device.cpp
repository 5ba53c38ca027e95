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
template <typename Choose>
auto choose_named(std::string_view selector, const Choose& choose) {
    const char* const variable = std::getenv("OBSCURA_DEVICE");
    if (!selector.empty() || variable == nullptr) return choose(selector);
    try {
        return choose(variable);
    } catch (const InputError& error) {
        throw InputError("The environment variable OBSCURA_DEVICE: {}", error.what());
    }
}

// As equal as whole compute units can be: the first ones have one more if they don't come out even.
std::vector<cl::Device> split(const cl::Device& handle, const DeviceInfo& info, uint32_t parts) {
    std::vector<cl_device_partition_property> request{CL_DEVICE_PARTITION_BY_COUNTS};
    for (uint32_t i = 0; i < parts; ++i)
        request.push_back(info.compute_units / parts + (i < info.compute_units % parts ? 1 : 0));
    request.insert(request.end(), {CL_DEVICE_PARTITION_BY_COUNTS_LIST_END, 0});
    std::vector<cl::Device> handles;
    cl::Device whole = handle;
    check(whole.createSubDevices(request.data(), &handles), "clCreateSubDevices", "splitting the device",
          info.name);
    OBSCURA_CHECK(handles.size() == parts, "{} sub-devices in place of {}", handles.size(), parts);
    return handles;
}

}  // namespace

Device::Device(cl::Device handle, DeviceInfo info, std::string name)
    : handle_(std::move(handle)), info_(std::move(info)), name_(std::move(name)) {
    constexpr const char* STAGE = "opening the device";
    cl_int code = CL_SUCCESS;
    context_ = cl::Context(handle_, nullptr, nullptr, nullptr, &code);
    check(code, "clCreateContext", STAGE, name_);
    queue_ = cl::CommandQueue(context_, handle_, CL_QUEUE_PROFILING_ENABLE, &code);
    check(code, "clCreateCommandQueue", STAGE, name_);

    cl_device_fp_config float_config = 0;
    check(handle_.getInfo(CL_DEVICE_SINGLE_FP_CONFIG, &float_config), "clGetDeviceInfo", STAGE, name_);
    correctly_rounded_division_ = (float_config & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
    size_t group_size = 0;
    check(handle_.getInfo(CL_DEVICE_MAX_WORK_GROUP_SIZE, &group_size), "clGetDeviceInfo", STAGE, name_);
    max_work_group_size_ = group_size;
    compiles_at_launch_ = info_.platform == POCL_PLATFORM_NAME;
    runs_items_in_turn_ = info_.is_cpu && (compiles_at_launch_ || info_.platform == "Oclgrind");
}

void Device::log_commands(TraceRecord& trace) {
    commands_ = std::make_unique<CommandLog>(trace, context_, queue_, name_);
}

void Device::finish(std::string_view stage) const {
    check(queue_.finish(), "clFinish", stage, name_);
}

std::vector<std::unique_ptr<Device>> open_devices(std::string_view selector) {
    const std::vector<DeviceInfo> list = list_devices();
    const std::vector<DeviceChoice> choices =
        choose_named(selector, [&](std::string_view named) { return select_devices(list, named); });
    std::vector<std::unique_ptr<Device>> devices;
    for (const DeviceChoice& choice : choices) {
        const DeviceInfo& info = list[static_cast<size_t>(choice.position)];
        const cl::Device handle = find_handle(info);
        if (choice.parts == 1) {
            devices.push_back(std::make_unique<Device>(handle, info, info.name));
            continue;
        }
        const std::vector<cl::Device> parts = split(handle, info, choice.parts);
        for (size_t i = 0; i < parts.size(); ++i) {
            DeviceInfo part = info;
            part.max_sub_devices = 0;
            part.parts = choice.parts;
            check(parts[i].getInfo(CL_DEVICE_MAX_COMPUTE_UNITS, &part.compute_units), "clGetDeviceInfo",
                  "splitting the device", info.name);
            devices.push_back(std::make_unique<Device>(
                parts[i], part, fmt::format("{} ({} of {})", info.name, i + 1, parts.size())));
        }
    }
    return devices;
}

Device open_device(std::string_view selector) {
    const std::vector<DeviceInfo> list = list_devices();
    const DeviceChoice choice = choose_named(selector, [&](std::string_view named) {
        const std::vector<DeviceChoice> choices = select_devices(list, named);
        if (choices.size() > 1 || choices.front().parts > 1)
            throw InputError(
                "\"{}\" means several devices; only obscura render shares its work among several", named);
        return choices.front();
    });
    const DeviceInfo& info = list[static_cast<size_t>(choice.position)];
    return Device(find_handle(info), info, info.name);
}

}  // namespace obscura
