// SPDX-License-Identifier: Apache-2.0
// See compile_kernels.h.
#include "cli/compile_kernels.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/log.h"
#include "device/compile_processes.h"

namespace obscura {
namespace {

struct CompileOptions {
    std::string device;
    uint32_t local_size = 0;
    std::vector<std::string> requests;  // stage, options, file, kernel of each
};

void compile_kernels(const CompileOptions& options) {
    set_quiet(true);
    set_compile_program({});  // it has no processes of its own
    if (options.requests.size() % 4 != 0)
        throw InputError("compile-kernels takes stage, options, file and kernel of each request.");
    std::vector<KernelRequest> requests;
    for (size_t i = 0; i < options.requests.size(); i += 4)
        requests.push_back(
            {options.requests[i], options.requests[i + 1], options.requests[i + 2], options.requests[i + 3]});
    const auto devices = open_devices(options.device);
    ProgramLibrary(*devices.front(), options.local_size).kernels(requests);
}

}  // namespace

void add_compile_kernels_command(CLI::App& app) {
    CLI::App* const command =
        app.add_subcommand("compile-kernels", "Compile kernels into the cache")->group("");
    const auto options = std::make_shared<CompileOptions>();
    command->add_option("--device", options->device)->required();
    command->add_option("--local-size", options->local_size)->required();
    command->add_option("requests", options->requests)->required();
    command->callback([options] { compile_kernels(*options); });
}

}  // namespace obscura
