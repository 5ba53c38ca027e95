// SPDX-License-Identifier: Apache-2.0
// The order that makes neighbouring rays alike: by the octant of their direction, then along the Morton curve of their
// origins.
#pragma once

#include "reference/tracer.h"

#include <cstdint>
#include <span>
#include <vector>

namespace obscura {

// Indices of the rays in that order; rays of one cell of the curve keep theirs.
std::vector<uint32_t> coherent_order(std::span<const TraceRay> rays);

}  // namespace obscura
