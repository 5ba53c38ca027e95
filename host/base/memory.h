// SPDX-License-Identifier: Apache-2.0
// What this machine has. A system that overcommits its memory would end a program half-way that asks for more.
#pragma once

#include <cstdint>

namespace obscura {

uint64_t physical_memory_bytes();

}  // namespace obscura
