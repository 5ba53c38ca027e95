// SPDX-License-Identifier: Apache-2.0
// Times of the kernels, from OpenCL's own events: the only timing in the wavefront.
#pragma once

#include "device/opencl.h"

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace obscura {

struct StageProfile {
    uint64_t launches = 0;
    uint64_t items = 0;
    uint64_t work_items = 0;  // launched, with work or without
    double ms = 0;            // on the device, start to end

    StageProfile& operator+=(const StageProfile& other) {
        launches += other.launches;
        items += other.items;
        work_items += other.work_items;
        ms += other.ms;
        return *this;
    }
};

class Profiler {
  public:
    // device_name: for error messages.
    explicit Profiler(std::string device_name) : device_name_(std::move(device_name)) {}

    // row: "trace_camera", "shade" ...; items: work of the launch as its stage counts it; work_items: of its grid.
    void record(const std::string& row, uint64_t items, uint64_t work_items, const cl::Event& event);
    // Replaces the item count of the row's latest launch, which is not collected yet, once the device has told it.
    void set_items(const std::string& row, uint64_t items);
    // Reads the times of finished launches. Call when the queue is idle.
    void collect();

    const std::map<std::string, StageProfile>& rows() const { return rows_; }

  private:
    struct Pending {
        std::string row;
        uint64_t items, work_items;
        cl::Event event;
    };
    std::string device_name_;
    std::vector<Pending> pending_;
    std::map<std::string, StageProfile> rows_;
};

}  // namespace obscura
