// SPDX-License-Identifier: Apache-2.0
// The figures of `obscura bench` as tables for people, or as JSON.
#pragma once

#include <string>

#include "device/selector.h"
#include "reference/bench.h"

namespace obscura {

// json: a file, "-" for standard output, or empty for the tables.
void report_bench(const SceneBench& bench, const Scene& scene, const DeviceInfo& device,
                  const std::string& json);

}  // namespace obscura
