// SPDX-License-Identifier: Apache-2.0
// The file from which an interrupted sweep goes on: its settings and the errors of every picture so far.
#pragma once

#include <filesystem>
#include <vector>

#include "cli/json_output.h"
#include "reference/sweep.h"

namespace obscura {

class SweepRecord {
  public:
    // Reads what is there; a file that isn't is an empty record. Throws InputError if it can't be read, or if it was made
    // with other settings, which then have other errors or other times.
    SweepRecord(std::filesystem::path file, Json settings);

    const std::vector<SweepResult>& results() const { return results_; }
    bool holds(const SweepTask& task) const;
    // Replaces a result of fewer runs.
    void add(SweepResult result);
    // Atomic.
    void save() const;

  private:
    std::filesystem::path file_;
    Json settings_;
    std::vector<SweepResult> results_;
};

}  // namespace obscura
