// SPDX-License-Identifier: Apache-2.0
// The folder of compiled kernels doesn't grow for ever.
#include "device/program_cache.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <vector>

#include "base/file.h"
#include "support/temporary_folder.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

TEST(ProgramCache, UnusedForAMonthAreRemovedByAStore) {
    const test::TemporaryFolder folder;
    ProgramCache cache(folder.path());
    const std::vector<unsigned char> program{1, 2, 3};
    const auto now = fs::file_time_type::clock::now();
    for (const char* key : {"unused", "used", "recent"})
        cache.store(key, program);
    write_text(folder.path() / "notes.txt", "not an entry");
    for (const char* name : {"unused.program", "used.program", "notes.txt"})
        fs::last_write_time(folder.path() / name, now - std::chrono::days(31));
    fs::last_write_time(cache.entry_path("recent"), now - std::chrono::days(29));
    EXPECT_EQ(cache.load("used"), program);
    cache.store("new", program);
    EXPECT_FALSE(cache.load("unused"));
    for (const char* key : {"used", "recent", "new"})
        EXPECT_EQ(cache.load(key), program) << key;
    EXPECT_TRUE(fs::exists(folder.path() / "notes.txt"));
}

TEST(ProgramCache, FolderInPlaceOfAnEntryIsNoEntry) {
    const test::TemporaryFolder folder;
    ProgramCache cache(folder.path());
    fs::create_directories(cache.entry_path("key") / "inside");
    EXPECT_FALSE(cache.load("key"));
    cache.store("key", std::vector<unsigned char>{1, 2, 3});  // warns; the next start compiles again
    EXPECT_FALSE(cache.load("key"));
}

}  // namespace
}  // namespace obscura
