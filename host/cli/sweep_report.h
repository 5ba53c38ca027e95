// SPDX-License-Identifier: Apache-2.0
// The results of a sweep as JSON, as CSV and as tables.
#pragma once

#include <string>
#include <vector>

#include "cli/json_output.h"
#include "reference/sweep_summary.h"

namespace obscura {

struct SweepReport {
    Json settings;  // and the machine
    Json references;
    std::vector<MethodSummary> methods;
    uint32_t seeds = 0;    // wanted
    bool complete = true;  // false: stopped early
};

Json to_json(const SweepReport& report);
// One row for each method, budget and layer.
std::string csv_text(const SweepReport& report);
void print_tables(const SweepReport& report);

}  // namespace obscura
