// SPDX-License-Identifier: Apache-2.0
// Kernels that other processes compile into the cache on disk. PoCL compiles under one lock, so threads would gain nothing.
#pragma once

#include <sys/types.h>

#include <span>
#include <string>
#include <vector>

#include "device/program.h"

namespace obscura {

// The program that compiles: started with "compile-kernels" (cli/compile_kernels.h). Until it is named there are no other
// processes.
void set_compile_program(std::string path);

class CompileProcesses {
  public:
    // Shares the requests out among as many processes as there are cores, this one among them. costs: of each request,
    // in any unit. The shares of processes that can't be started are left to this one.
    CompileProcesses(const Device& device, uint32_t local_size, std::span<const KernelRequest> requests,
                     std::span<const size_t> costs);
    // Waits for them: none outlives the call that needs its kernels.
    ~CompileProcesses();
    CompileProcesses(const CompileProcesses&) = delete;
    CompileProcesses& operator=(const CompileProcesses&) = delete;

    // Request i is compiled elsewhere.
    bool takes(size_t i) const;
    // Returns when the process that compiles request i has ended, whether it has succeeded or not.
    void wait_for(size_t i);

  private:
    std::vector<size_t> owners_;    // of each request
    std::vector<pid_t> processes_;  // 0 = ended, or never started; the first is this one's place
};

}  // namespace obscura
