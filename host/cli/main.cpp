// SPDX-License-Identifier: Apache-2.0
// The program: one subcommand per file beside this one. The only catch, and the only exit code.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <string>

#include "base/error.h"
#include "base/log.h"
#include "cli/bench.h"
#include "cli/check.h"
#include "cli/compare.h"
#include "cli/compile_kernels.h"
#include "cli/devices.h"
#include "cli/info.h"
#include "cli/merge.h"
#include "cli/reference.h"
#include "cli/render.h"
#include "cli/sweep.h"
#include "device/compile_processes.h"

namespace obscura {
namespace {

// CLI11 says "--spp: At Most 1 required but received 2", and no more of what is wrong.
std::string usage_message(const CLI::App& app, const CLI::ParseError& error) {
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) == nullptr) return error.what();
    for (const CLI::App* command : app.get_subcommands()) {
        for (const CLI::Option* option : command->get_options()) {
            if (option->get_expected_max() == 1 && option->count() > 1)
                return fmt::format("{} is given {}.", option->get_name(),
                                   option->count() == 2 ? "twice" : fmt::format("{} times", option->count()));
        }
    }
    return error.what();
}

ExitCode run(int argc, char** argv) {
    CLI::App app("Renders scenes with ray-traced obscurances on any OpenCL device.", "obscura");
    app.set_version_flag("--version", "obscura " OBSCURA_VERSION);
    app.require_subcommand(1);
    ExitCode exit_code = ExitCode::ok;
    add_bench_command(app, exit_code);
    add_check_command(app, exit_code);
    add_compare_command(app, exit_code);
    add_compile_kernels_command(app);
    add_devices_command(app, exit_code);
    add_info_command(app, exit_code);
    add_merge_command(app, exit_code);
    add_reference_command(app, exit_code);
    add_render_command(app, exit_code);
    add_sweep_command(app, exit_code);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        // --help and --version end here too, with success; anything else is a usage error.
        if (error.get_exit_code() == 0) {
            app.exit(error);
            return ExitCode::ok;
        }
        const bool unknown_subcommand = app.get_subcommands().empty() && argc > 1 && argv[1][0] != '-';
        throw InputError(
            "{}\nRun obscura --help, or obscura SUBCOMMAND --help, for more.",
            unknown_subcommand ? fmt::format("{} is not a subcommand.", argv[1]) : usage_message(app, error));
    }
    return exit_code;
}

}  // namespace
}  // namespace obscura

int main(int argc, char** argv) {
    using obscura::ExitCode;
    ExitCode exit_code = ExitCode::ok;
    try {
        obscura::set_compile_program("/proc/self/exe");
        exit_code = obscura::run(argc, argv);
        if (std::fflush(stdout) != 0) throw obscura::InputError("Standard output can't be written");
    } catch (const obscura::InputError& error) {
        obscura::log_error(error.what());
        exit_code = ExitCode::bad_input;
    } catch (const obscura::DeviceError& error) {
        obscura::log_error(error.what());
        exit_code = ExitCode::device_failure;
    } catch (const std::bad_alloc&) {
        obscura::log_error("The memory of this machine doesn't suffice for this input.");
        exit_code = ExitCode::bad_input;
    } catch (const std::filesystem::filesystem_error& error) {
        obscura::log_error(error.what());
        exit_code = ExitCode::bad_input;
    } catch (const std::exception& error) {
        // A bug in obscura, as a broken invariant is: none of the exit codes stands for it.
        obscura::log_error(std::string("An unexpected failure, please report it: ") + error.what());
        std::abort();
    }
    return static_cast<int>(exit_code);
}
