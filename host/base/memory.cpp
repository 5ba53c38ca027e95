// SPDX-License-Identifier: Apache-2.0
#include "base/memory.h"

#include <unistd.h>

namespace obscura {

uint64_t physical_memory_bytes() {
    return static_cast<uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<uint64_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace obscura
