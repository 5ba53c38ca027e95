// SPDX-License-Identifier: Apache-2.0
// Progress of a long job: a bar with rays per second and time left on a terminal, a plain line every
// few seconds otherwise, nothing with --quiet.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace obscura {

class Progress {
  public:
    // title: what is being done ("render"); unit: what is counted ("ray").
    Progress(std::string title, std::string unit);
    ~Progress();  // ends the bar's line
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    // fraction of the job done, 0..1; count: units processed so far.
    void update(double fraction, uint64_t count);
    // Prints the final state, once.
    void finish(uint64_t count);

  private:
    void print_bar(double fraction, uint64_t count, double seconds);
    void print_line(double fraction, uint64_t count, double seconds);

    using Clock = std::chrono::steady_clock;
    std::string title_;
    std::string unit_;
    bool terminal_;
    bool line_open_ = false;
    bool finished_ = false;
    Clock::time_point start_;
    Clock::time_point last_print_;
};

}  // namespace obscura
