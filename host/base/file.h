// SPDX-License-Identifier: Apache-2.0
// Files are written whole or not at all: to a temporary name beside the target, then renamed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace obscura {

// Calls write(temporary path), which must create that file, then renames it to path. If write throws, or the
// rename fails, the temporary file is removed and the target is left as it was. A symbolic link is followed;
// a device or pipe (/dev/null) is written directly, since renaming would replace it. Throws InputError when
// the target can't be written (no such folder, no permission, disk full).
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path&)>& write);

// Fails early, with InputError, if path can't be written later: called before a long render.
void require_writable(const std::filesystem::path& path);

// A folder and those above it, if they aren't there. Throws InputError with the system's reason.
void make_folder(const std::filesystem::path& path);

// The whole file. Throws InputError with the system's reason.
std::string read_text(const std::filesystem::path& path);
std::vector<std::byte> read_bytes(const std::filesystem::path& path);

// Writes a small file atomically.
void write_text(const std::filesystem::path& path, const std::string& text);
void write_bytes(const std::filesystem::path& path, const std::vector<std::byte>& bytes);

// A file being written. Failures are kept and thrown by close(), so that it can stand behind libraries which
// swallow exceptions; a file that was not closed was not written.
class FileWriter {
  public:
    // shown_as: the name in messages, for a file that still has its temporary name. Throws InputError.
    FileWriter(const std::filesystem::path& path, std::filesystem::path shown_as);

    void write(const void* data, size_t byte_count);
    uint64_t position();
    void seek(uint64_t position);
    // Throws InputError with the reason of the first failure since the file was opened.
    void close();

  private:
    void note_failure();

    std::filesystem::path shown_as_;
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
    int first_errno_ = 0;
};

}  // namespace obscura
