// SPDX-License-Identifier: Apache-2.0
// What OpenCL devices there are, which of them obscura can use, and which one a selector means. No OpenCL
// header is needed to include this, and choosing needs no device: the list is plain data.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace obscura {

inline constexpr std::string_view POCL_PLATFORM_NAME = "Portable Computing Language";

// One row of `obscura devices`. A platform that offers no device has a row of its own, with index -1.
struct DeviceInfo {
    int index = -1;           // counts the devices of all platforms, usable or not
    int platform_index = -1;  // as the ICD loader lists them; -1 where there is no platform at all
    int device_index = -1;    // within the platform
    std::string platform, platform_version;
    std::string name, driver_version, opencl_version;
    uint32_t compute_units = 0;
    uint32_t max_sub_devices = 0;  // that it can be split into; 0 = it can't
    uint32_t parts = 1;            // it is one of so many sub-devices; 1 = a device as it is
    uint64_t memory_bytes = 0, max_allocation_bytes = 0;
    std::vector<std::string> float_features;  // what CL_DEVICE_SINGLE_FP_CONFIG names
    bool is_cpu = false;
    bool usable = false;
    std::string reason;  // why not, a phrase for people; empty if usable
};

// Every platform and device, in the ICD loader's order. Never throws: a platform that fails is a row that
// says so.
std::vector<DeviceInfo> list_devices();

// Position in devices of the one used when nobody chose: PoCL's CPU if usable, else the first usable one.
// -1 if none is usable.
int default_device(std::span<const DeviceInfo> devices);

// Position in devices of the one meant by the selector: empty (the default), an index, "platform:device"
// indices, or a part of the device's name or the platform's name or version in any case. Throws InputError that lists the
// candidates if none or several match or the match is not usable; DeviceError with the reasons if no device
// is usable at all.
int select_device(std::span<const DeviceInfo> devices, std::string_view selector);

// A device, or what it is split into.
struct DeviceChoice {
    int position = -1;   // in the list
    uint32_t parts = 1;  // sub-devices; 1 = the device as it is
    bool operator==(const DeviceChoice&) const = default;
};

// The same for several devices: selectors separated by commas, each with /N behind it where the device is to be split into N
// sub-devices. A part of a device's name may hold commas and slashes. Throws InputError too if a device can't be split so,
// or is meant twice.
std::vector<DeviceChoice> select_devices(std::span<const DeviceInfo> devices, std::string_view selector);

}  // namespace obscura
