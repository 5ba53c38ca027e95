// SPDX-License-Identifier: Apache-2.0
#include "cli/interrupt.h"

#include <unistd.h>

#include <atomic>
#include <csignal>

namespace obscura {
namespace {

std::atomic<bool> interrupted{false};

void handle_interrupt(int signal) {
    interrupted = true;
    std::signal(signal, SIG_DFL);
    static constexpr char MESSAGE[] =
        "\nobscura: stopping after the work in hand; interrupt again to stop at once\n";
    [[maybe_unused]] const auto written = write(STDERR_FILENO, MESSAGE, sizeof(MESSAGE) - 1);
}

void on_interrupt(void (*handler)(int)) {
    std::signal(SIGINT, handler);
    std::signal(SIGTERM, handler);
    std::signal(SIGHUP, handler);
}

}  // namespace

void catch_interrupts() {
    on_interrupt(handle_interrupt);
}

void ignore_interrupts() {
    on_interrupt(SIG_IGN);
}

bool is_interrupted() {
    return interrupted;
}

}  // namespace obscura
