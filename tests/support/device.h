// SPDX-License-Identifier: Apache-2.0
// The fixture of tests that need an OpenCL device, and what they share: `using Layout = DeviceTest;` and
// TEST_F(Layout, ...). Without a device the tests are skipped, or fail where OBSCURA_REQUIRE_DEVICE=1.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>

#include "device/device.h"

namespace obscura::test {

// Opens the device on the first call. Only for tests that have checked that there is one. It is never closed: when
// static objects go, a driver may have lost what it keeps for each thread (Oclgrind writes to freed memory then).
inline Device& shared_device() {
    static Device& device = *new Device(open_device());
    return device;
}

class DeviceTest : public ::testing::Test {
  protected:
    void SetUp() override {
        // Drivers run threads: a death test starts its program anew instead of forking.
        GTEST_FLAG_SET(death_test_style, "threadsafe");
        const std::vector<DeviceInfo> devices = list_devices();
        if (default_device(devices) >= 0) return;
        const char* const required = std::getenv("OBSCURA_REQUIRE_DEVICE");
        if (required != nullptr && std::string_view(required) == "1")
            FAIL() << "no usable OpenCL device: " << devices.front().reason;
        GTEST_SKIP() << "no usable OpenCL device: " << devices.front().reason;
    }

    Device& device() { return shared_device(); }
};

// An environment variable for the length of a scope.
class ScopedVariable {
  public:
    ScopedVariable(std::string name, const std::string& value) : name_(std::move(name)) {
        if (const char* const before = std::getenv(name_.c_str())) before_ = before;
        setenv(name_.c_str(), value.c_str(), 1);
    }
    ~ScopedVariable() {
        if (before_)
            setenv(name_.c_str(), before_->c_str(), 1);
        else
            unsetenv(name_.c_str());
    }
    ScopedVariable(const ScopedVariable&) = delete;
    ScopedVariable& operator=(const ScopedVariable&) = delete;

  private:
    std::string name_;
    std::optional<std::string> before_;
};

}  // namespace obscura::test
