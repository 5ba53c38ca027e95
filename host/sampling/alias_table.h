// SPDX-License-Identifier: Apache-2.0
// Selection of one of n things in constant time with given probabilities (Walker 1977; built after Vose 1991).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace obscura {

struct AliasEntry {
    float acceptance = 1;   // in [0, 1]: the column's own index below it, the alias above
    uint32_t alias = 0;     // index
    float probability = 0;  // of this index being selected; 0 or a normal float
};

// weights: >= 0, finite, not all zero (OBSCURA_CHECK). One entry per weight.
std::vector<AliasEntry> build_alias_table(std::span<const double> weights);

}  // namespace obscura
