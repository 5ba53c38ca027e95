// SPDX-License-Identifier: Apache-2.0
// See memory_ledger.h.
#include "device/memory_ledger.h"

#include <algorithm>

#include "base/error.h"

namespace obscura {

void MemoryLedger::add(std::string_view category, uint64_t bytes) {
    auto found = categories_.find(category);
    if (found == categories_.end()) found = categories_.emplace(category, Account{}).first;
    for (Account* account : {&total_, &found->second}) {
        account->current += bytes;
        account->peak = std::max(account->peak, account->current);
    }
}

void MemoryLedger::remove(std::string_view category, uint64_t bytes) {
    const auto found = categories_.find(category);
    OBSCURA_CHECK(found != categories_.end() && found->second.current >= bytes,
                  "{} bytes of \"{}\" are freed that were never counted", bytes, category);
    total_.current -= bytes;
    found->second.current -= bytes;
}

void MemoryLedger::reset_peaks() {
    total_.peak = total_.current;
    for (auto& [category, account] : categories_)
        account.peak = account.current;
}

uint64_t MemoryLedger::current_bytes(std::string_view category) const {
    const auto found = categories_.find(category);
    return found != categories_.end() ? found->second.current : 0;
}

uint64_t MemoryLedger::peak_bytes(std::string_view category) const {
    const auto found = categories_.find(category);
    return found != categories_.end() ? found->second.peak : 0;
}

}  // namespace obscura
