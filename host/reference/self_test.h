// SPDX-License-Identifier: Apache-2.0
// `obscura check --self-test`: geometry and rays that break careless tracers, made by code, on the device of choice.
#pragma once

#include "reference/check.h"

#include <functional>
#include <string>
#include <vector>

namespace obscura {

// One row per case. The rays of the first cases go through the traversal alone, and any-hit queries and the walk of
// single rays have to agree with closest hits: a ray where they don't counts as wrong. The last rows are the queues of a small render.
// only: part of the names of the cases that are run; all if empty.
std::vector<QueueCheck> self_test(Device& device, ProgramLibrary& library, bool portable,
                                  const std::string& only);

// Calls use with the scene and the settings of the case of exactly this name; false if there is none.
using UseOfCase = std::function<void(const Scene&, const RenderSettings&)>;
bool with_self_test_case(const std::string& name, const UseOfCase& use);

}  // namespace obscura
