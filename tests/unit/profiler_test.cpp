// SPDX-License-Identifier: Apache-2.0
// The profiler's rows. What it measures is a matter of the device: tests/kernel/stages_test.cpp.
#include "wavefront/profiler.h"

#include <gtest/gtest.h>

namespace obscura {
namespace {

TEST(Profiler, ItemsOfARowThatWasNotLaunchedAbort) {
    Profiler profiler("device");
    profiler.record("shade", 1, 1, {});
    EXPECT_DEATH(profiler.set_items("shadow", 1), "no new launch of shadow");
}

}  // namespace
}  // namespace obscura
