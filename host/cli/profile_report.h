// SPDX-License-Identifier: Apache-2.0
// The figures of `obscura render --profile`: a table for people, and JSON for --stats.
#pragma once

#include "cli/json_output.h"
#include "wavefront/stage_figures.h"

#include <vector>

namespace obscura {

struct RenderProfile {
    DeviceRates rates;
    std::vector<StageFigures> stages;
    RenderVisits visits;
};

void print_profile(const RenderProfile& profile);
Json profile_json(const RenderProfile& profile);

}  // namespace obscura
