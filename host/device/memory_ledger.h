// SPDX-License-Identifier: Apache-2.0
// Counts the bytes of device memory by category ("scene", "bvh", "queues", "film", "status"): now and at
// most (since the last reset).
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace obscura {

class MemoryLedger {
  public:
    void add(std::string_view category, uint64_t bytes);
    void remove(std::string_view category, uint64_t bytes);

    // From now on peaks are those of what follows.
    void reset_peaks();

    uint64_t current_bytes() const { return total_.current; }
    uint64_t peak_bytes() const { return total_.peak; }
    uint64_t current_bytes(std::string_view category) const;
    uint64_t peak_bytes(std::string_view category) const;

  private:
    struct Account {
        uint64_t current = 0, peak = 0;
    };
    Account total_;
    std::map<std::string, Account, std::less<>> categories_;
};

}  // namespace obscura
