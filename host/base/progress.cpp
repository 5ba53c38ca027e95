// SPDX-License-Identifier: Apache-2.0
// Draws the bar or prints the lines.
#include "base/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <utility>

#include "base/log.h"
#include "base/units.h"

namespace obscura {
namespace {

constexpr std::chrono::milliseconds BAR_PERIOD{100};
constexpr std::chrono::seconds LINE_PERIOD{5};  // a log of an hour stays under a thousand lines
constexpr int BAR_WIDTH = 24;                   // the whole line stays within 80 columns
constexpr std::string_view ERASE_LINE = "\r\x1b[K";

std::string rate_text(uint64_t count, double seconds, const std::string& unit) {
    const double rate = seconds > 0 ? static_cast<double>(count) / seconds : 0;
    return fmt::format("{} {}s/s", si_count(rate), unit);
}

std::string time_left_text(double fraction, double seconds) {
    if (fraction <= 0) return "time left unknown";
    return duration_text(seconds * (1 - fraction) / fraction) + " left";
}

double seconds_between(std::chrono::steady_clock::time_point from, std::chrono::steady_clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
}

}  // namespace

Progress::Progress(std::string title, std::string unit)
    : title_(std::move(title)),
      unit_(std::move(unit)),
      terminal_(::isatty(STDERR_FILENO) == 1),
      start_(Clock::now()),
      last_print_(start_) {}

Progress::~Progress() {
    if (line_open_) fmt::print(stderr, "\n");
}

void Progress::update(double fraction, uint64_t count) {
    const auto now = Clock::now();
    if (is_quiet() || finished_) return;
    if (now - last_print_ < (terminal_ ? Clock::duration(BAR_PERIOD) : Clock::duration(LINE_PERIOD))) return;
    last_print_ = now;
    const double seconds = seconds_between(start_, now);
    if (terminal_) {
        print_bar(fraction, count, seconds);
    } else {
        print_line(fraction, count, seconds);
    }
}

void Progress::finish(uint64_t count) {
    if (is_quiet() || std::exchange(finished_, true)) return;
    const double seconds = seconds_between(start_, Clock::now());
    fmt::print(stderr, "{}{}: {} {} in {}, {}\n", line_open_ ? ERASE_LINE : "", title_,
               si_count(static_cast<double>(count)), plural(count, unit_), duration_text(seconds),
               rate_text(count, seconds, unit_));
    line_open_ = false;
}

void Progress::print_bar(double fraction, uint64_t count, double seconds) {
    const int filled = static_cast<int>(std::lround(std::clamp(fraction, 0.0, 1.0) * BAR_WIDTH));
    fmt::print(stderr, "{}{} [{:#<{}}{:.<{}}] {:3.0f} %  {}  {}", ERASE_LINE, title_, "", filled, "",
               BAR_WIDTH - filled, 100 * fraction, rate_text(count, seconds, unit_),
               time_left_text(fraction, seconds));
    std::fflush(stderr);
    line_open_ = true;
}

void Progress::print_line(double fraction, uint64_t count, double seconds) {
    fmt::print(stderr, "{}: {:.0f} %, {} {}, {}, {}\n", title_, 100 * fraction,
               si_count(static_cast<double>(count)), plural(count, unit_), rate_text(count, seconds, unit_),
               time_left_text(fraction, seconds));
}

}  // namespace obscura
