// SPDX-License-Identifier: Apache-2.0
#include "base/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace obscura {
namespace {

spdlog::logger& logger() {
    static const std::shared_ptr<spdlog::logger> instance = [] {
        auto created = std::make_shared<spdlog::logger>(
            "obscura", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
        created->set_pattern("%^%v%$");
        return created;
    }();
    return *instance;
}

bool quiet_ = false;

}  // namespace

void set_quiet(bool quiet) {
    quiet_ = quiet;
    logger().set_level(quiet ? spdlog::level::warn : spdlog::level::info);
}

bool is_quiet() {
    return quiet_;
}

MutedWarnings::MutedWarnings() {
    logger().set_level(spdlog::level::err);
}

MutedWarnings::~MutedWarnings() {
    set_quiet(quiet_);
}

void log_info(const std::string& message) {
    // Information is printed plain: colour is for what needs attention.
    if (!quiet_) fmt::print(stderr, "{}\n", message);
}

void log_warning(const std::string& message) {
    logger().warn("obscura: warning: {}", message);
}

void log_error(const std::string& message) {
    logger().error("obscura: error: {}", message);
}

}  // namespace obscura
