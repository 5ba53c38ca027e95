// SPDX-License-Identifier: Apache-2.0
// See command_log.h.
#include "device/command_log.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "device/error.h"

namespace obscura {
namespace {

constexpr const char* STAGE = "tracing";
constexpr cl_uint PROBE = 0;
constexpr int CLOCK_READINGS = 8;  // the first ones find cold caches and sleeping threads

}  // namespace

CommandLog::CommandLog(TraceRecord& trace, const cl::Context& context, const cl::CommandQueue& queue,
                       std::string device_name)
    : trace_(trace),
      queue_(queue),
      device_name_(std::move(device_name)),
      device_(trace.add_device(device_name_)) {
    cl_int code = CL_SUCCESS;
    probe_ = cl::Buffer(context, CL_MEM_READ_WRITE, sizeof(PROBE), nullptr, &code);
    check(code, "clCreateBuffer", STAGE, device_name_);
    begin_ = read_clocks();
}

uint64_t CommandLog::time_of(const cl::Event& event, cl_profiling_info moment) const {
    cl_ulong time = 0;
    check(event.getProfilingInfo(moment, &time), "clGetEventProfilingInfo", STAGE, device_name_);
    return time;
}

// The middle of what all brackets of (host - device) have in common.
CommandLog::Moment CommandLog::read_clocks() const {
    int64_t least = std::numeric_limits<int64_t>::min(), most = std::numeric_limits<int64_t>::max();
    Moment moment;
    for (int i = 0; i < CLOCK_READINGS; ++i) {
        cl::Event event;
        const int64_t before = trace_.now_ns();
        check(queue_.enqueueWriteBuffer(probe_, CL_TRUE, 0, sizeof(PROBE), &PROBE, nullptr, &event),
              "clEnqueueWriteBuffer", STAGE, device_name_);
        const int64_t after = trace_.now_ns();
        moment.device_ns = static_cast<int64_t>(time_of(event, CL_PROFILING_COMMAND_END));
        least = std::max(least, before - static_cast<int64_t>(time_of(event, CL_PROFILING_COMMAND_QUEUED)));
        most = std::min(most, after - moment.device_ns);
    }
    moment.host_ns = moment.device_ns + std::midpoint(least, most);
    return moment;
}

void CommandLog::add(TraceCategory category, std::string name, TraceDetail detail, const cl::Event& event) {
    const std::lock_guard lock(mutex_);
    pending_.push_back({category, detail, std::move(name), event});
}

void CommandLog::collect() {
    const std::lock_guard lock(mutex_);
    for (Command& command : pending_) {
        command.start_ns = time_of(command.event, CL_PROFILING_COMMAND_START);
        command.end_ns = time_of(command.event, CL_PROFILING_COMMAND_END);
        command.event = cl::Event();
        collected_.push_back(std::move(command));
    }
    pending_.clear();
}

void CommandLog::flush() {
    check(queue_.finish(), "clFinish", STAGE, device_name_);
    collect();
    const Moment end = read_clocks();
    const double rate = static_cast<double>(end.host_ns - begin_.host_ns) /
                        static_cast<double>(std::max<int64_t>(end.device_ns - begin_.device_ns, 1));
    const auto to_host = [&](uint64_t device_ns) {
        return begin_.host_ns +
               std::llround(static_cast<double>(static_cast<int64_t>(device_ns) - begin_.device_ns) * rate);
    };
    const std::lock_guard lock(mutex_);
    for (Command& command : collected_) {
        trace_.add_command(device_, command.category, std::move(command.name), to_host(command.start_ns),
                           to_host(command.end_ns), command.detail);
    }
    collected_.clear();
}

}  // namespace obscura
