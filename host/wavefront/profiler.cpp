// SPDX-License-Identifier: Apache-2.0
#include "wavefront/profiler.h"

#include <algorithm>
#include <ranges>

#include "base/error.h"
#include "device/error.h"

namespace obscura {

void Profiler::record(const std::string& row, uint64_t items, uint64_t work_items, const cl::Event& event) {
    pending_.push_back({row, items, work_items, event});
}

void Profiler::set_items(const std::string& row, uint64_t items) {
    const auto latest =
        std::ranges::find(pending_.rbegin(), pending_.rend(), row, [](const Pending& p) { return p.row; });
    OBSCURA_CHECK(latest != pending_.rend(), "the profile has no new launch of {}", row);
    latest->items = items;
}

void Profiler::collect() {
    for (const Pending& launch : pending_) {
        cl_ulong start = 0, end = 0;
        check(launch.event.getProfilingInfo(CL_PROFILING_COMMAND_START, &start), "clGetEventProfilingInfo",
              launch.row, device_name_);
        check(launch.event.getProfilingInfo(CL_PROFILING_COMMAND_END, &end), "clGetEventProfilingInfo",
              launch.row, device_name_);
        StageProfile& row = rows_[launch.row];
        ++row.launches;
        row.items += launch.items;
        row.work_items += launch.work_items;
        row.ms += static_cast<double>(end - start) * 1e-6;
    }
    pending_.clear();
}

}  // namespace obscura
