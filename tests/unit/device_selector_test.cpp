// SPDX-License-Identifier: Apache-2.0
// Which device a selector means, on made-up lists: no OpenCL is needed.
#include <gtest/gtest.h>

#include "base/error.h"
#include "device/error.h"
#include "device/selector.h"

namespace obscura {
namespace {

DeviceInfo device(int index, int platform_index, int device_index, std::string platform, std::string name) {
    DeviceInfo info;
    info.index = index;
    info.platform_index = platform_index;
    info.device_index = device_index;
    info.platform = std::move(platform);
    info.name = std::move(name);
    info.usable = true;
    return info;
}

DeviceInfo unusable(DeviceInfo info, std::string reason) {
    info.usable = false;
    info.reason = std::move(reason);
    return info;
}

// A graphics card, a platform without devices, PoCL's processor, and an old accelerator.
std::vector<DeviceInfo> sample_devices() {
    DeviceInfo empty_platform;
    empty_platform.platform_index = 1;
    empty_platform.platform = "Empty Platform";
    empty_platform.reason = "the platform has no device";
    std::vector<DeviceInfo> devices = {
        device(0, 0, 0, "Maker CL", "Radiant 9000"),
        device(1, 0, 1, "Maker CL", "Radiant 9000 Mini"),
        empty_platform,
        device(2, 2, 0, std::string(POCL_PLATFORM_NAME), "pthread-haswell"),
        unusable(device(3, 3, 0, "Old CL", "Accelerator 1"), "the driver has no compiler for kernels"),
    };
    devices[3].is_cpu = true;
    devices[3].platform_version = "OpenCL 3.0 PoCL 6.0  Linux, Release";
    return devices;
}

template <typename Error>
std::string message_of(std::span<const DeviceInfo> devices, std::string_view selector) {
    try {
        select_device(devices, selector);
    } catch (const Error& error) {
        return error.what();
    }
    return "no such exception";
}

TEST(DeviceSelector, EmptySelectorPrefersPoclsProcessor) {
    EXPECT_EQ(select_device(sample_devices(), ""), 3);
}

TEST(DeviceSelector, EmptySelectorWithoutPoclGivesFirstUsableDevice) {
    auto devices = sample_devices();
    devices[3] = unusable(devices[3], "switched off");
    devices[0] = unusable(devices[0], "switched off");
    EXPECT_EQ(select_device(devices, ""), 1);
}

TEST(DeviceSelector, IndexCountsDevicesNotRows) {
    EXPECT_EQ(select_device(sample_devices(), "0"), 0);
    EXPECT_EQ(select_device(sample_devices(), "2"), 3);
}

TEST(DeviceSelector, PlatformAndDeviceIndexGiveThatDevice) {
    EXPECT_EQ(select_device(sample_devices(), "0:1"), 1);
    EXPECT_EQ(select_device(sample_devices(), "2:0"), 3);
}

TEST(DeviceSelector, PartOfNameInAnyCaseGivesTheDevice) {
    EXPECT_EQ(select_device(sample_devices(), "MINI"), 1);
    EXPECT_EQ(select_device(sample_devices(), "portable computing"), 3);
    EXPECT_EQ(select_device(sample_devices(), "pocl"), 3);  // in the platform's version only
}

TEST(DeviceSelector, SeveralMatchesListTheCandidates) {
    const std::string message = message_of<InputError>(sample_devices(), "radiant");
    EXPECT_NE(message.find("0 (0:0)"), std::string::npos) << message;
    EXPECT_NE(message.find("1 (0:1)"), std::string::npos) << message;
    EXPECT_EQ(message.find("pthread"), std::string::npos) << message;
}

TEST(DeviceSelector, NoMatchListsAllDevices) {
    for (const char* selector : {"4", "1:0", "9:9", "-1", "0:", "quantum"}) {
        const std::string message = message_of<InputError>(sample_devices(), selector);
        EXPECT_NE(message.find(selector), std::string::npos) << message;
        EXPECT_NE(message.find("Radiant 9000 Mini"), std::string::npos) << message;
        EXPECT_NE(message.find("pthread-haswell"), std::string::npos) << message;
    }
}

TEST(DeviceSelector, UnusableMatchSaysWhy) {
    EXPECT_NE(message_of<InputError>(sample_devices(), "accelerator").find("no compiler"), std::string::npos);
}

TEST(DeviceSelector, NoUsableDeviceGivesDeviceErrorWithEachReason) {
    const std::vector<DeviceInfo> devices = {sample_devices()[2], sample_devices()[4]};
    EXPECT_EQ(default_device(devices), -1);
    for (const char* selector : {"", "0", "accelerator"}) {
        const std::string message = message_of<DeviceError>(devices, selector);
        EXPECT_NE(message.find("the platform has no device"), std::string::npos) << message;
        EXPECT_NE(message.find("no compiler"), std::string::npos) << message;
    }
}

TEST(DeviceSelector, NoRowsAtAllGivesDeviceError) {
    EXPECT_NE(message_of<DeviceError>({}, "").find("no OpenCL device"), std::string::npos);
}

// The sample devices, the processor with eight compute units that can be split.
std::vector<DeviceInfo> splittable_devices() {
    std::vector<DeviceInfo> devices = sample_devices();
    devices[3].compute_units = devices[3].max_sub_devices = 8;
    return devices;
}

std::string list_message(std::string_view selector) {
    try {
        select_devices(splittable_devices(), selector);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no such exception";
}

using Choices = std::vector<DeviceChoice>;

TEST(DeviceList, OneSelectorGivesOneDevice) {
    EXPECT_EQ(select_devices(splittable_devices(), ""), (Choices{{3, 1}}));
    EXPECT_EQ(select_devices(splittable_devices(), "mini"), (Choices{{1, 1}}));
}

TEST(DeviceList, CommasSeparateDevicesInTheirOrder) {
    EXPECT_EQ(select_devices(splittable_devices(), "pocl,0"), (Choices{{3, 1}, {0, 1}}));
    EXPECT_EQ(select_devices(splittable_devices(), "0:1, 0:0 ,2"), (Choices{{1, 1}, {0, 1}, {3, 1}}));
}

TEST(DeviceList, SlashGivesTheNumberOfSubDevices) {
    EXPECT_EQ(select_devices(splittable_devices(), "pocl/8"), (Choices{{3, 8}}));
    EXPECT_EQ(select_devices(splittable_devices(), "mini,2:0/3"), (Choices{{1, 1}, {3, 3}}));
    EXPECT_EQ(select_devices(splittable_devices(), "mini/1"), (Choices{{1, 1}}));
}

TEST(DeviceList, NamesMayHoldCommasAndSlashes) {
    std::vector<DeviceInfo> devices = splittable_devices();
    devices[0].name = "Radiant 9000 / 9100/2 (wide, 8 lanes)";
    for (const char* selector : {"9100/2", "wide, 8", "9000 / 9100/2 (wide, 8 lanes)"})
        EXPECT_EQ(select_devices(devices, selector), (Choices{{0, 1}})) << selector;
    EXPECT_EQ(select_devices(devices, "pocl,9100/2"), (Choices{{3, 1}, {0, 1}}));
}

TEST(DeviceList, ImpossibleSplitsAreRefused) {
    EXPECT_NE(list_message("mini/2").find("Radiant 9000 Mini can't be split"), std::string::npos);
    EXPECT_NE(list_message("pocl/9").find("8 compute units, which make at most 8 sub-devices"),
              std::string::npos);
    for (const char* selector :
         {"pocl/0", "pocl/-1", "pocl/", "pocl/x", "pocl/1.5", "pocl/99999999999", "/2"})
        EXPECT_NE(list_message(selector).find("N sub-devices, 1 or more"), std::string::npos) << selector;
}

TEST(DeviceList, DevicesMeantTwiceAreRefused) {
    for (const char* selector : {"pocl,2", "0,pocl,2:0", "pocl/2,pocl", "pocl,pocl/2"}) {
        const std::string message = list_message(selector);
        EXPECT_NE(message.find("means a device twice"), std::string::npos) << message;
        EXPECT_NE(message.find("pthread-haswell"), std::string::npos) << message;
    }
}

TEST(DeviceList, EveryEntryMeansADevice) {
    for (const char* selector : {",", "pocl,", ",pocl", "pocl, ,0"})
        EXPECT_NE(list_message(selector).find("an entry of the list is empty"), std::string::npos)
            << selector;
    EXPECT_NE(list_message("pocl,quantum").find("matches \"quantum\""), std::string::npos);
    EXPECT_NE(list_message("radiant/2").find("Several OpenCL devices match \"radiant\""), std::string::npos);
    EXPECT_NE(list_message("pocl,accelerator").find("no compiler"), std::string::npos);
}

TEST(DeviceErrors, CodesHaveTheirNames) {
    EXPECT_EQ(error_name(-5), "CL_OUT_OF_RESOURCES");
    EXPECT_EQ(error_name(-1001), "CL_PLATFORM_NOT_FOUND_KHR");
    EXPECT_EQ(error_name(-68), "CL_INVALID_DEVICE_PARTITION_COUNT");
    EXPECT_EQ(error_name(-4711), "unknown OpenCL error -4711");
}

TEST(DeviceErrors, CheckNamesCodeCallStageCountAndDevice) {
    EXPECT_NO_THROW(check(0, "clFinish", "trace"));
    try {
        check(-54, "clEnqueueNDRangeKernel", "trace", "pthread-haswell", 4096);
        FAIL() << "no exception";
    } catch (const DeviceError& error) {
        EXPECT_STREQ(
            error.what(),
            "trace: clEnqueueNDRangeKernel failed with CL_INVALID_WORK_GROUP_SIZE (-54) for 4096 items on "
            "pthread-haswell.");
    }
}

}  // namespace
}  // namespace obscura
