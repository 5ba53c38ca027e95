// SPDX-License-Identifier: Apache-2.0
// One opened OpenCL device: its context, its in-order command queue with profiling, what is known about it,
// and the ledger of its memory. Buffers and programs refer to it, so it outlives them.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "device/command_log.h"
#include "device/memory_ledger.h"
#include "device/opencl.h"
#include "device/selector.h"

namespace obscura {

class Device {
  public:
    // name: in messages, traces and figures; sub-devices share the one of their driver.
    Device(cl::Device handle, DeviceInfo info, std::string name);
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    const DeviceInfo& info() const { return info_; }
    const std::string& name() const { return name_; }
    const cl::Device& handle() const { return handle_; }
    const cl::Context& context() const { return context_; }
    const cl::CommandQueue& queue() const { return queue_; }
    // Division and square root can be rounded correctly on request, so that they equal the host's.
    bool has_correctly_rounded_division() const { return correctly_rounded_division_; }
    uint64_t max_work_group_size() const { return max_work_group_size_; }
    // PoCL finishes compiling a kernel at its first launch, again for each local size (see program.cpp).
    bool compiles_at_launch() const { return compiles_at_launch_; }
    // Launches are filled up to this many items, 0 = any size is fine. PoCL compiles a second version of each
    // kernel for grids below 65536 items; 65536 items that have nothing to do cost it 0.1 ms, compiling 0.4
    // s.
    uint64_t smallest_grid() const { return compiles_at_launch_ ? 65536 : 0; }
    // The work-items of a group run one after the other, not in the lanes of a vector: known of PoCL and Oclgrind. (Mesa's
    // llvmpipe runs them in lanes, and ends every loop after 65535 turns.)
    bool runs_items_in_turn() const { return runs_items_in_turn_; }

    MemoryLedger& memory() { return memory_; }
    const MemoryLedger& memory() const { return memory_; }

    // From now on commands are logged in the trace, which must live as long as the device.
    void log_commands(TraceRecord& trace);
    CommandLog* commands() const { return commands_.get(); }  // null: nothing is traced
    TraceRecord* trace() const { return commands_ ? &commands_->trace() : nullptr; }

    // Waits until everything enqueued is done. stage names the work in an error message.
    void finish(std::string_view stage) const;

  private:
    cl::Device handle_;
    DeviceInfo info_;
    std::string name_;
    cl::Context context_;
    cl::CommandQueue queue_;
    bool correctly_rounded_division_ = false;
    uint64_t max_work_group_size_ = 0;
    bool compiles_at_launch_ = false;
    bool runs_items_in_turn_ = false;
    MemoryLedger memory_;
    std::unique_ptr<CommandLog> commands_;
};

// Opens the devices that the selector means (select_devices); an empty selector means the environment variable
// OBSCURA_DEVICE, and if that is unset or empty the default device. Sub-devices of one device are devices of their own.
std::vector<std::unique_ptr<Device>> open_devices(std::string_view selector = {});

// For work that takes one device: throws InputError if the selector means several.
Device open_device(std::string_view selector = {});

}  // namespace obscura
