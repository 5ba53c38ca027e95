// SPDX-License-Identifier: Apache-2.0
#include "base/error.h"

#include <cstdio>
#include <cstdlib>

namespace obscura {

void fail_invariant(const char* expression, const char* file, int line, const std::string& detail) {
    std::fprintf(stderr, "obscura: internal error: %s:%d: (%s) is false: %s\n", file, line, expression,
                 detail.c_str());
    std::abort();
}

}  // namespace obscura
