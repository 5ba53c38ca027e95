// SPDX-License-Identifier: Apache-2.0
// Numbers for people.
#include "base/units.h"

#include <gtest/gtest.h>

#include <limits>

namespace obscura {
namespace {

TEST(Plural, IsForAllCountsButOne) {
    EXPECT_EQ(plural(0, "ray"), "rays");
    EXPECT_EQ(plural(1, "ray"), "ray");
    EXPECT_EQ(plural(2, "ray"), "rays");
}

TEST(Counted, HasTheNounInTheRightNumber) {
    EXPECT_EQ(counted(0, "ray"), "0 rays");
    EXPECT_EQ(counted(1, "ray"), "1 ray");
    EXPECT_EQ(counted(2, "ray"), "2 rays");
}

TEST(SiCount, HasThreeDigitsAndAPrefix) {
    EXPECT_EQ(si_count(0), "0");
    EXPECT_EQ(si_count(7), "7");
    EXPECT_EQ(si_count(12.34), "12.3");
    EXPECT_EQ(si_count(999), "999");
    EXPECT_EQ(si_count(1000), "1.00 k");
    EXPECT_EQ(si_count(12345), "12.3 k");
    EXPECT_EQ(si_count(1234567), "1.23 M");
    EXPECT_EQ(si_count(999.6e6), "1.00 G");
    EXPECT_EQ(si_count(35e9), "35.0 G");
    EXPECT_EQ(si_count(1.8e19), "18.0 E");
    EXPECT_EQ(si_count(-1500), "-1.50 k");
}

TEST(DurationText, SuitsTheLength) {
    EXPECT_EQ(duration_text(0), "0.00 ms");
    EXPECT_EQ(duration_text(0.01234), "12.3 ms");
    EXPECT_EQ(duration_text(0.9996), "1.00 s");
    EXPECT_EQ(duration_text(4.217), "4.22 s");
    EXPECT_EQ(duration_text(59.96), "1:00");
    EXPECT_EQ(duration_text(75.3), "1:15");
    EXPECT_EQ(duration_text(3599.7), "1:00:00");
    EXPECT_EQ(duration_text(37325), "10:22:05");
    EXPECT_EQ(duration_text(std::numeric_limits<double>::infinity()), "unlimited time");
}

TEST(BytesText, UsesBinaryPrefixes) {
    EXPECT_EQ(bytes_text(0), "0 B");
    EXPECT_EQ(bytes_text(1023), "1023 B");
    EXPECT_EQ(bytes_text(1536), "1.5 KiB");
    EXPECT_EQ(bytes_text(1024 * 1024 - 1), "1 MiB");
    EXPECT_EQ(bytes_text(1000 * 1024), "1000 KiB");
    EXPECT_EQ(bytes_text(uint64_t{512} << 20), "512 MiB");
    EXPECT_EQ(bytes_text(std::numeric_limits<uint64_t>::max()), "16 EiB");
}

}  // namespace
}  // namespace obscura
