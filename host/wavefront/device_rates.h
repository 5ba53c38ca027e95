// SPDX-License-Identifier: Apache-2.0
// What a device can do at most, measured on it: what the figures of a profile are compared with.
#pragma once

#include "device/program.h"

#include <cstdint>

namespace obscura {

struct DeviceRates {
    double copy_gb_per_s = 0;  // bytes read plus bytes written by a kernel that only copies
    double launch_ms = 0;      // of a launch that has nothing to do
    double idle_item_ns = 0;   // of a work item that has nothing to do
    double visit_ns = 0;       // of a core, for a node or a block of a small tree that incoherent rays visit
    uint64_t cache_bytes = 0;  // as the device tells, 0 = it doesn't
    uint32_t cores = 1;        // compute units
};

// Takes some tenths of a second and buffers of 128 MiB. portable: as of the render's kernels.
DeviceRates measure_rates(Device& device, ProgramLibrary& library, bool portable);

}  // namespace obscura
