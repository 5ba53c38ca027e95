// SPDX-License-Identifier: Apache-2.0
// Files are whole or absent, whatever goes wrong, and the messages say what went wrong.
#include "base/file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "support/errors.h"
#include "support/temporary_folder.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

// A disk that is full after so many bytes, for regular files of this process.
class FileSizeLimit {
  public:
    explicit FileSizeLimit(rlim_t byte_count) {
        old_handler_ = std::signal(SIGXFSZ, SIG_IGN);
        ::getrlimit(RLIMIT_FSIZE, &old_);
        const rlimit limit{byte_count, old_.rlim_max};
        EXPECT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
    }
    ~FileSizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &old_);
        std::signal(SIGXFSZ, old_handler_);
    }

  private:
    rlimit old_{};
    void (*old_handler_)(int) = nullptr;
};

TEST(File, TextIsReadBackAsWritten) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.txt");
    const std::string text = std::string("line\n\0after a zero", 18) + std::string(3'000'000, 'x');
    write_text(path, text);
    EXPECT_EQ(read_text(path), text);
    EXPECT_EQ(read_bytes(path).size(), text.size());
    EXPECT_EQ(folder.entry_count(), 1u);
}

TEST(File, EmptyTextGivesAnEmptyFile) {
    const TemporaryFolder folder;
    write_text(folder.file("empty"), "");
    EXPECT_TRUE(fs::exists(folder.file("empty")));
    EXPECT_EQ(read_text(folder.file("empty")), "");
}

TEST(File, WritingReplacesTheOldFile) {
    const TemporaryFolder folder;
    write_text(folder.file("a"), "a longer old text");
    write_text(folder.file("a"), "new");
    EXPECT_EQ(read_text(folder.file("a")), "new");
}

TEST(File, AWriterThatThrowsLeavesTheTargetAsItWas) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a");
    write_text(path, "old");
    const auto fail_half_way = [](const fs::path& temporary) {
        write_text(temporary, "half of the new");
        throw std::runtime_error("stopped");
    };
    EXPECT_THROW(write_atomically(path, fail_half_way), std::runtime_error);
    EXPECT_EQ(read_text(path), "old");
    EXPECT_EQ(folder.entry_count(), 1u);
}

TEST(File, AFullDiskGivesTheReasonAndLeavesNothing) {
    const TemporaryFolder folder;
    {
        const FileSizeLimit limit(10'000);
        EXPECT_INPUT_ERROR(write_text(folder.file("big"), std::string(1'000'000, 'x')),
                           "big: can't be written");
        // The failure may show only when the last buffer is written.
        EXPECT_INPUT_ERROR(write_text(folder.file("big"), std::string(10'001, 'x')), "File too large");
    }
    EXPECT_EQ(folder.entry_count(), 0u);
    EXPECT_INPUT_ERROR(write_text("/dev/full", "x"), "/dev/full: can't be written: No space left on device");
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST(File, AnEarlyFailureIsNotHiddenByLaterWrites) {
    const TemporaryFolder folder;
    FileWriter writer("/dev/full", "shown.exr");
    writer.write(std::string(100'000, 'x').data(), 100'000);
    writer.seek(0);
    EXPECT_INPUT_ERROR(writer.close(), "shown.exr: can't be written: No space left on device");
}

TEST(File, SeekingOverwritesInPlace) {
    const TemporaryFolder folder;
    FileWriter writer(folder.file("a"), "a");
    writer.write("0123456789", 10);
    EXPECT_EQ(writer.position(), 10u);
    writer.seek(2);
    writer.write("ab", 2);
    EXPECT_EQ(writer.position(), 4u);
    writer.close();
    EXPECT_EQ(read_text(folder.file("a")), "01ab456789");
}

TEST(File, AMissingFolderIsNamed) {
    const TemporaryFolder folder;
    const std::string path = folder.file("no/such/a.txt");
    const std::string reason = "the folder " + folder.file("no/such") + " does not exist";
    EXPECT_INPUT_ERROR(write_text(path, "x"), path + ": can't be written: " + reason);
    EXPECT_INPUT_ERROR(require_writable(path), reason);
    EXPECT_EQ(folder.entry_count(), 0u);
}

TEST(File, FoldersAndEmptyNamesAreRefused) {
    const TemporaryFolder folder;
    write_text(folder.file("plain"), "x");
    EXPECT_INPUT_ERROR(write_text(folder.path(), "x"), "it is a folder");
    EXPECT_INPUT_ERROR(write_text(folder.file("plain") + "/", "x"), "it is a folder");
    EXPECT_INPUT_ERROR(write_text(folder.file("plain/a"), "x"), "is not a folder");
    EXPECT_INPUT_ERROR(require_writable(""), "empty");
    EXPECT_INPUT_ERROR(write_text("/proc/a.txt", "x"), "/proc/a.txt: can't be written");
}

TEST(File, MakesAFolderWithThoseAboveItOrSaysWhyNot) {
    const TemporaryFolder folder;
    const std::string made = folder.file("a/b"), file = folder.file("file");
    make_folder(made);
    make_folder(made);
    EXPECT_TRUE(fs::is_directory(made));
    write_text(file, "text");
    EXPECT_INPUT_ERROR(make_folder(file + "/b"), file + "/b: the folder can't be made: Not a directory");
    EXPECT_INPUT_ERROR(make_folder(file), file);
}

TEST(File, RequireWritableTouchesNothing) {
    const TemporaryFolder folder;
    require_writable(folder.file("new"));
    EXPECT_EQ(folder.entry_count(), 0u);
    write_text(folder.file("old"), "old");
    require_writable(folder.file("old"));
    EXPECT_EQ(read_text(folder.file("old")), "old");
    EXPECT_INPUT_ERROR(require_writable("/proc/a.exr"), "/proc/a.exr: can't be written");
}

TEST(File, ALinkIsFollowedAndADeviceIsKept) {
    const TemporaryFolder folder;
    write_text(folder.file("target"), "old");
    fs::create_symlink(folder.file("target"), folder.file("link"));
    write_text(folder.file("link"), "new");
    EXPECT_TRUE(fs::is_symlink(folder.file("link")));
    EXPECT_EQ(read_text(folder.file("target")), "new");
    write_text("/dev/null", "x");
    require_writable("/dev/null");
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(File, WhatCannotBeReadIsSaid) {
    const TemporaryFolder folder;
    EXPECT_INPUT_ERROR(read_text(folder.file("none")), "none: can't be read: No such file or directory");
    EXPECT_INPUT_ERROR(read_bytes(folder.path()), "can't be read: Is a directory");
}

}  // namespace
}  // namespace obscura
