// SPDX-License-Identifier: Apache-2.0
#include "device/compile_processes.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <functional>
#include <numeric>
#include <thread>
#include <utility>

extern "C" char** environ;

namespace obscura {
namespace {

std::string& compile_program() {
    static std::string path;
    return path;
}

std::string selector_of(const DeviceInfo& info) {
    return info.parts == 1 ? fmt::format("{}", info.index) : fmt::format("{}/{}", info.index, info.parts);
}

// 0 if it can't be started. It is silent: what it can't compile is compiled, and complained of, here.
pid_t start(std::vector<std::string> arguments) {
    std::vector<char*> argv;
    argv.reserve(arguments.size() + 1);
    for (std::string& argument : arguments)
        argv.push_back(argument.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t files;
    if (posix_spawn_file_actions_init(&files) != 0) return 0;
    pid_t process = 0;
    bool started = posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0) == 0;
    for (const int file : {STDOUT_FILENO, STDERR_FILENO})
        started = started && posix_spawn_file_actions_addopen(&files, file, "/dev/null", O_WRONLY, 0) == 0;
    started = started && posix_spawn(&process, argv.front(), &files, nullptr, argv.data(), environ) == 0;
    posix_spawn_file_actions_destroy(&files);
    return started ? process : 0;
}

// Who takes each item so that all are done about together: the dearest first, each to who has the least so far.
std::vector<size_t> share_out(std::span<const size_t> costs, size_t owner_count) {
    std::vector<size_t> order(costs.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::ranges::stable_sort(order, std::greater{}, [&](size_t i) { return costs[i]; });
    std::vector<size_t> owners(costs.size());
    std::vector<size_t> sums(owner_count, 0);
    for (const size_t i : order) {
        owners[i] = static_cast<size_t>(std::ranges::min_element(sums) - sums.begin());
        sums[owners[i]] += costs[i];
    }
    return owners;
}

}  // namespace

void set_compile_program(std::string path) {
    compile_program() = std::move(path);
}

CompileProcesses::CompileProcesses(const Device& device, uint32_t local_size,
                                   std::span<const KernelRequest> requests, std::span<const size_t> costs) {
    const size_t cores = compile_program().empty() ? 1 : std::max(std::thread::hardware_concurrency(), 1u);
    processes_.resize(std::clamp<size_t>(requests.size(), 1, cores));
    owners_ = share_out(costs, processes_.size());
    for (size_t process = 1; process < processes_.size(); ++process) {
        std::vector<std::string> arguments{compile_program(),
                                           "compile-kernels",
                                           "--device",
                                           selector_of(device.info()),
                                           "--local-size",
                                           fmt::format("{}", local_size),
                                           "--"};
        for (size_t i = 0; i < requests.size(); ++i) {
            if (owners_[i] != process) continue;
            const KernelRequest& request = requests[i];
            arguments.insert(arguments.end(), {request.stage, request.options, request.file, request.kernel});
        }
        processes_[process] = start(std::move(arguments));
    }
}

CompileProcesses::~CompileProcesses() {
    for (size_t i = 0; i < owners_.size(); ++i)
        wait_for(i);
}

bool CompileProcesses::takes(size_t i) const {
    return processes_[owners_[i]] != 0;
}

void CompileProcesses::wait_for(size_t i) {
    if (!takes(i)) return;
    pid_t& process = processes_[owners_[i]];
    while (waitpid(process, nullptr, 0) < 0 && errno == EINTR) {
    }
    process = 0;
}

}  // namespace obscura
