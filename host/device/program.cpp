// SPDX-License-Identifier: Apache-2.0
// Building kernels, or taking them from the cache.
//
// PoCL compiles in three steps: OpenCL C to an intermediate form in clBuildProgram; that to machine code for
// one local size at the first launch; and once more for any local size when the program's binary is asked for.
// A binary holds the machine code of whatever was launched before it was asked for. Measured with PoCL 3.1 on
// one core for a BVH traversal of 80 lines, in ms, with PoCL's own cache empty:
//
//   from                                       clBuildProgram   first launch   asking for the binary
//   source                                                800            400                     400
//   binary asked for before the first launch                5            350                       -
//   binary asked for after the first launch                 5              0                       -
//
// So a kernel is launched once over no items before its program goes to the cache. The last row is the same
// with PoCL's own cache warm or switched off; source with that cache warm takes 70 to 160 ms. The attribute
// reqd_work_group_size changes none of these times. PoCL compiles under one lock, whatever the
// context: threads gain nothing, processes do (compile_processes.h).
#include "device/program.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <unordered_set>
#include <utility>

#include "base/error.h"
#include "base/log.h"
#include "base/stopwatch.h"
#include "base/units.h"
#include "device/compile_processes.h"
#include "device/error.h"
#include "device/kernel_source.h"
#include "device/warm_up.h"

namespace obscura {

namespace {

// Before the compilation a line without an end, so that it can be seen what takes the time; then its end.
void say_compiling(size_t number, size_t count, const std::string& stage) {
    if (!is_quiet()) fmt::print(stderr, "compiling kernel {} of {} ({}) ... ", number, count, stage);
    std::fflush(stderr);
}

void say_compiled(const std::string& outcome) {
    if (!is_quiet()) fmt::print(stderr, "{}\n", outcome);
}

// About in proportion to the time that the compiler takes. Headers that are included again are not read again.
size_t distinct_lines(std::string_view text) {
    std::unordered_set<std::string_view> lines;
    for (size_t first = 0; first < text.size();) {
        const size_t last = std::min(text.find('\n', first), text.size());
        lines.insert(text.substr(first, last - first));
        first = last + 1;
    }
    return lines.size();
}

// Traversal, intersection and the exact merging of images rest on IEEE arithmetic.
void refuse_inexact_arithmetic(const std::string& options) {
    for (const char* flag : {"fast-relaxed-math", "unsafe-math", "mad-enable", "finite-math",
                             "denorms-are-zero", "no-signed-zeros"})
        OBSCURA_CHECK(options.find(flag) == std::string::npos, "kernels are never built with {}", flag);
}

}  // namespace

ProgramLibrary::ProgramLibrary(Device& device, uint32_t local_size)
    : device_(device), local_size_(local_size) {
    OBSCURA_CHECK(local_size > 0, "an empty work group");
    if (local_size > device.max_work_group_size())
        throw InputError("Work groups of {} items are too large: {} allows at most {}.", local_size,
                         device.name(), device.max_work_group_size());
}

std::vector<cl::Kernel> ProgramLibrary::kernels(std::span<const KernelRequest> requests) {
    std::vector<Source> sources;
    sources.reserve(requests.size());
    for (const KernelRequest& request : requests)
        sources.push_back(source_of(request));
    prepare(requests, sources);
    std::vector<cl::Kernel> kernels;
    kernels.reserve(sources.size());
    for (const Source& source : sources)
        kernels.push_back(make_kernel(programs_.at(source.key), source));
    return kernels;
}

cl::Kernel ProgramLibrary::kernel(const KernelRequest& request) {
    return kernels(std::span(&request, 1)).front();
}

cl::Kernel ProgramLibrary::kernel(const std::string& stage, const std::string& options) {
    return kernel(KernelRequest{.stage = stage, .options = options});
}

// Builds those programs that are neither in memory nor in the cache: a share of them, while other processes put the rest
// into the cache.
void ProgramLibrary::prepare(std::span<const KernelRequest> requests, std::span<const Source> sources) {
    std::vector<const Source*> missing;
    std::vector<KernelRequest> missing_requests;
    std::vector<size_t> costs;
    for (size_t i = 0; i < sources.size(); ++i) {
        const auto is_same = [&](const Source* other) { return other->key == sources[i].key; };
        if (load(sources[i], "hit") || std::ranges::any_of(missing, is_same)) continue;
        missing.push_back(&sources[i]);
        missing_requests.push_back(requests[i]);
        costs.push_back(distinct_lines(sources[i].text));
    }
    CompileProcesses others(device_, local_size_, missing_requests, costs);
    std::vector<size_t> order(missing.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::stable_partition(order.begin(), order.end(), [&](size_t i) { return !others.takes(i); });
    for (size_t done = 0; done < order.size(); ++done) {
        const Source& source = *missing[order[done]];
        say_compiling(done + 1, missing.size(), source.stage);
        const Stopwatch stopwatch;
        try {
            const bool expected = others.takes(order[done]);
            if (expected) {
                const TraceStep step(device_.trace(), TraceCategory::host, "wait for another process");
                others.wait_for(order[done]);
            }
            if (!expected || !load(source, "filled by another process")) compile(source);
        } catch (...) {
            say_compiled("failed");
            throw;
        }
        say_compiled(duration_text(stopwatch.seconds()));
    }
}

cl::Kernel ProgramLibrary::kernel_from_text(const std::string& stage, const std::string& text,
                                            const std::string& kernel, const std::string& options) {
    const Source source = make_source(stage, expand_kernel_text(stage, text), kernel, options);
    auto found = programs_.find(source.key);
    if (found == programs_.end()) {
        found = programs_.emplace(source.key, build_from_text(source)).first;
        ++compiled_count_;
    }
    return make_kernel(found->second, source);
}

ProgramLibrary::Source ProgramLibrary::source_of(const KernelRequest& request) const {
    const std::string file = request.file.empty() ? request.stage + ".cl" : request.file;
    const std::string& kernel = request.kernel.empty() ? request.stage : request.kernel;
    return make_source(request.stage, expand_kernel_file(file), kernel, request.options);
}

// Adds the options of all kernels, and the key, which names everything that the built program depends on.
ProgramLibrary::Source ProgramLibrary::make_source(const std::string& stage, const std::string& text,
                                                   const std::string& kernel,
                                                   const std::string& options) const {
    refuse_inexact_arithmetic(options);
    // Without warnings: PoCL's compiler writes their number to stderr, and all of them before the error that is looked for.
    std::string all = "-cl-std=CL1.2 -cl-kernel-arg-info -w";
    if (device_.has_correctly_rounded_division()) all += " -cl-fp32-correctly-rounded-divide-sqrt";
    if (!options.empty()) all += " " + options;
    const DeviceInfo& info = device_.info();
    all += device_.runs_items_in_turn() ? fmt::format(" -D COMPUTE_UNITS={}", info.compute_units)
                                        : " -D OBSCURA_PORTABLE";
    const std::string key = hash_text(fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n{}\n{}\n{}", info.platform,
                                                  info.platform_version, info.name, info.driver_version,
                                                  info.opencl_version, kernel, local_size_, all, text));
    return {.stage = stage, .text = text, .options = all, .kernel = kernel, .key = key};
}

// Takes the program from memory or from the disk cache. A cached program that the device refuses is as good
// as none.
bool ProgramLibrary::load(const Source& source, std::string_view from) {
    if (programs_.contains(source.key)) return true;
    const auto binary = cache_.load(source.key);
    if (!binary) return false;
    const TraceStep step(device_.trace(), TraceCategory::compile, "compile " + source.stage, {"cache", from});
    std::vector<cl_int> status;
    cl_int code = CL_SUCCESS;
    cl::Program program(device_.context(), {device_.handle()}, {*binary}, &status, &code);
    if (code != CL_SUCCESS || program.build(device_.handle(), source.options.c_str()) != CL_SUCCESS)
        return false;
    const cl::Kernel kernel(program, source.kernel.c_str(), &code);
    if (code != CL_SUCCESS) return false;
    programs_.emplace(source.key, std::move(program));
    ++cache_hit_count_;
    return true;
}

// Compiles the program and keeps it, in the cache, too, if the device gives its binary.
void ProgramLibrary::compile(const Source& source) {
    const TraceStep step(device_.trace(), TraceCategory::compile, "compile " + source.stage,
                         {"cache", "miss"});
    const cl::Program program = build_from_text(source);
    if (device_.compiles_at_launch())
        warm_up(device_, make_kernel(program, source), source.stage, local_size_);
    std::vector<std::vector<unsigned char>> binaries;
    check(program.getInfo(CL_PROGRAM_BINARIES, &binaries), "clGetProgramInfo", source.stage, device_.name());
    programs_.emplace(source.key, program);
    ++compiled_count_;
    if (!binaries.empty() && !binaries.front().empty()) cache_.store(source.key, binaries.front());
}

cl::Program ProgramLibrary::build_from_text(const Source& source) const {
    cl_int code = CL_SUCCESS;
    cl::Program program(device_.context(), source.text, false, &code);
    check(code, "clCreateProgramWithSource", source.stage, device_.name());
    code = program.build(device_.handle(), source.options.c_str());
    if (code != CL_SUCCESS) {
        cl::string log;
        program.getBuildInfo(device_.handle(), CL_PROGRAM_BUILD_LOG, &log);
        throw DeviceError("{}: clBuildProgram failed with {} ({}) on {}, options {}. The compiler says:\n{}",
                          source.stage, error_name(code), code, device_.name(), source.options, log);
    }
    return program;
}

cl::Kernel ProgramLibrary::make_kernel(const cl::Program& program, const Source& source) const {
    cl_int code = CL_SUCCESS;
    cl::Kernel kernel(program, source.kernel.c_str(), &code);
    if (code != CL_SUCCESS)
        throw DeviceError("{}: clCreateKernel of \"{}\" failed with {} ({}) on {}.", source.stage,
                          source.kernel, error_name(code), code, device_.name());
    return kernel;
}

}  // namespace obscura
