// SPDX-License-Identifier: Apache-2.0
// Kernels by stage name. The sources are embedded in the program (the folder named by OBSCURA_KERNEL_DIR
// replaces them), their includes are expanded here, and built programs are kept in a cache on disk.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "device/device.h"
#include "device/program_cache.h"

namespace obscura {

// A stage's kernel: kernels/<stage>.cl holds the kernel <stage>. options: build options on top of those that
// every kernel gets, such as "-D FEATURE_TEXTURES". Values belong in arguments, not here.
// A kernel whose item count is zero, as an argument or in a buffer, must return before it does anything else:
// on devices that compile at launch it is launched once with all arguments zero (warm_up.h).
struct KernelRequest {
    std::string stage;
    std::string options = {};
    std::string file = {};    // "<stage>.cl" if empty
    std::string kernel = {};  // the stage's name if empty
};

class ProgramLibrary {
  public:
    // local_size: of the work groups that the kernels will be launched with. A cached program of PoCL holds machine code
    // for one.
    explicit ProgramLibrary(Device& device, uint32_t local_size = 64);

    // The kernels, in the order of the requests. Says "compiling kernel k of n" for each that is not in the cache. Throws
    // DeviceError with the whole build log. Each call gives objects of its own, with their own arguments.
    std::vector<cl::Kernel> kernels(std::span<const KernelRequest> requests);
    cl::Kernel kernel(const KernelRequest& request);
    cl::Kernel kernel(const std::string& stage, const std::string& options = {});
    // The same for a source that is no file (a test's); it may include files of kernels/. Neither cached on
    // disk nor warmed up.
    cl::Kernel kernel_from_text(const std::string& stage, const std::string& text, const std::string& kernel,
                                const std::string& options = {});

    uint32_t local_size() const { return local_size_; }
    int compiled_count() const { return compiled_count_; }    // built from source
    int cache_hit_count() const { return cache_hit_count_; }  // taken from the disk cache

  private:
    struct Source {
        std::string stage, text, options, kernel, key;
    };
    Source source_of(const KernelRequest& request) const;
    Source make_source(const std::string& stage, const std::string& text, const std::string& kernel,
                       const std::string& options) const;
    void prepare(std::span<const KernelRequest> requests, std::span<const Source> sources);
    // from: where the cache has it from, for the trace.
    bool load(const Source& source, std::string_view from);
    void compile(const Source& source);
    cl::Program build_from_text(const Source& source) const;
    cl::Kernel make_kernel(const cl::Program& program, const Source& source) const;

    Device& device_;
    uint32_t local_size_;
    ProgramCache cache_;
    std::map<std::string, cl::Program> programs_;  // by Source::key
    int compiled_count_ = 0;
    int cache_hit_count_ = 0;
};

}  // namespace obscura
