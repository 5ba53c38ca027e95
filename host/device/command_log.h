// SPDX-License-Identifier: Apache-2.0
// The commands of a device's queue in a trace. Nothing waits for a command because it is logged: the times are read
// where the queue is idle anyway.
//
// An OpenCL device has a clock of its own. A command that the host waits for brackets the difference of the two clocks: it
// was queued after the host had called, and it had ended when the call returned. Such brackets, a few microseconds wide, are
// taken when the log begins and when it ends; between them the device's times are mapped to the host's by a straight line,
// since clocks drift, and what came first stays first.
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "base/trace.h"
#include "device/opencl.h"

namespace obscura {

class CommandLog {
  public:
    CommandLog(TraceRecord& trace, const cl::Context& context, const cl::CommandQueue& queue,
               std::string device_name);

    TraceRecord& trace() const { return trace_; }

    // From this moment on the device's queue of items has this length. queue: a literal.
    void set_queue_length(std::string_view queue, int64_t time_ns, uint64_t items) const {
        trace_.add_queue_length(device_, queue, time_ns, items);
    }

    void add(TraceCategory category, std::string name, TraceDetail detail, const cl::Event& event);
    // Reads the times of the commands. Call when the queue is idle.
    void collect();
    // Waits for the device and hands all commands to the trace. Those of later come with another call.
    void flush();

  private:
    // One moment on both clocks.
    struct Moment {
        int64_t host_ns = 0, device_ns = 0;
    };
    struct Command {
        TraceCategory category;
        TraceDetail detail;
        std::string name;
        cl::Event event;
        uint64_t start_ns = 0, end_ns = 0;  // of the device's clock
    };

    Moment read_clocks() const;
    uint64_t time_of(const cl::Event& event, cl_profiling_info moment) const;

    TraceRecord& trace_;
    cl::CommandQueue queue_;
    cl::Buffer probe_;  // written to when the clocks are read
    std::string device_name_;
    uint32_t device_;
    Moment begin_;
    std::mutex mutex_;  // of the two below
    std::vector<Command> pending_, collected_;
};

}  // namespace obscura
