// SPDX-License-Identifier: Apache-2.0
// Makes a device that compiles at launch (PoCL) do so before the kernel is needed.
#pragma once

#include <cstdint>
#include <string_view>

#include "device/device.h"

namespace obscura {

// Launches the kernel with a zero for every number and struct and zeroed memory of WARM_UP_BYTES for every
// pointer. A kernel that has no items does nothing, so it reads at most its item count. The program must have
// been built with -cl-kernel-arg-info.
void warm_up(Device& device, const cl::Kernel& kernel, std::string_view stage, uint32_t local_size);

inline constexpr uint64_t WARM_UP_BYTES = 4096;

}  // namespace obscura
