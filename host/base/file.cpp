// SPDX-License-Identifier: Apache-2.0
// Atomic writing by temporary name and rename, and reading of whole files, through C streams: they keep
// errno, so that every message can give the system's reason.
#include "base/file.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <system_error>
#include <utility>

#include "base/error.h"

namespace obscura {
namespace fs = std::filesystem;
namespace {

std::string reason_text(int code) {
    return std::generic_category().message(code);
}

[[noreturn]] void fail_write(const fs::path& path, const std::string& reason) {
    throw InputError("{}: can't be written: {}", path.string(), reason);
}

// What can be known before anything is written: the target isn't a folder, and its folder exists.
void check_target(const fs::path& path) {
    if (path.empty()) throw InputError("The name of the file to write is empty");
    std::error_code ignored;  // an unreadable folder shows when the file is opened
    if (!path.has_filename() || fs::is_directory(path, ignored)) fail_write(path, "it is a folder");
    const fs::path folder = path.parent_path();
    if (folder.empty() || fs::is_directory(folder, ignored)) return;
    if (fs::exists(folder, ignored)) fail_write(path, fmt::format("{} is not a folder", folder.string()));
    fail_write(path, fmt::format("the folder {} does not exist", folder.string()));
}

bool is_device_or_pipe(const fs::path& path) {
    std::error_code ignored;
    return fs::exists(path, ignored) && !fs::is_regular_file(path, ignored);
}

fs::path without_link(const fs::path& path) {
    std::error_code ignored;
    return fs::is_symlink(path, ignored) ? fs::weakly_canonical(path) : path;
}

// A name beside the target that no other process or thread uses; the file is removed unless it was renamed.
class TemporaryFile {
  public:
    explicit TemporaryFile(const fs::path& target) : path_(target) {
        static std::atomic<unsigned> serial{0};
        path_ += fmt::format(".tmp{}-{}", ::getpid(), serial++);
    }
    ~TemporaryFile() {
        std::error_code ignored;
        if (!renamed_) fs::remove(path_, ignored);
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    const fs::path& path() const { return path_; }

    void rename_to(const fs::path& target) {
        std::error_code error;
        fs::rename(path_, target, error);
        if (error) fail_write(target, error.message());
        renamed_ = true;
    }

  private:
    fs::path path_;
    bool renamed_ = false;
};

template <typename Container>
Container read_whole(const fs::path& path) {
    const auto fail = [&](int code) {
        throw InputError("{}: can't be read: {}", path.string(), reason_text(code));
    };
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
    if (!file) fail(errno);
    Container content;
    constexpr size_t BLOCK_BYTES = size_t{1} << 20;
    for (size_t filled = 0;;) {
        content.resize(filled + BLOCK_BYTES);
        const size_t count = std::fread(content.data() + filled, 1, BLOCK_BYTES, file.get());
        filled += count;
        if (count == BLOCK_BYTES) continue;
        if (std::ferror(file.get()) != 0) fail(errno);
        content.resize(filled);
        return content;
    }
}

void write_whole(const fs::path& path, const void* data, size_t byte_count) {
    write_atomically(path, [&](const fs::path& temporary) {
        FileWriter file(temporary, path);
        file.write(data, byte_count);
        file.close();
    });
}

}  // namespace

void write_atomically(const fs::path& path, const std::function<void(const fs::path&)>& write) {
    check_target(path);
    if (is_device_or_pipe(path)) return write(path);
    const fs::path target = without_link(path);
    TemporaryFile temporary(target);
    write(temporary.path());
    temporary.rename_to(target);
}

void require_writable(const fs::path& path) {
    check_target(path);
    if (is_device_or_pipe(path)) return;
    const TemporaryFile probe(without_link(path));
    FileWriter(probe.path(), path).close();
}

void make_folder(const fs::path& path) {
    std::error_code error;
    fs::create_directories(path, error);
    if (error) throw InputError("{}: the folder can't be made: {}", path.string(), error.message());
}

std::string read_text(const fs::path& path) {
    return read_whole<std::string>(path);
}

std::vector<std::byte> read_bytes(const fs::path& path) {
    return read_whole<std::vector<std::byte>>(path);
}

void write_text(const fs::path& path, const std::string& text) {
    write_whole(path, text.data(), text.size());
}

void write_bytes(const fs::path& path, const std::vector<std::byte>& bytes) {
    write_whole(path, bytes.data(), bytes.size());
}

FileWriter::FileWriter(const fs::path& path, fs::path shown_as)
    : shown_as_(std::move(shown_as)), file_(std::fopen(path.c_str(), "wb"), &std::fclose) {
    if (!file_) fail_write(shown_as_, reason_text(errno));
}

void FileWriter::note_failure() {
    if (first_errno_ == 0) first_errno_ = errno;
}

void FileWriter::write(const void* data, size_t byte_count) {
    if (std::fwrite(data, 1, byte_count, file_.get()) != byte_count) note_failure();
}

uint64_t FileWriter::position() {
    const off_t position = ::ftello(file_.get());
    if (position >= 0) return static_cast<uint64_t>(position);
    note_failure();
    return 0;
}

void FileWriter::seek(uint64_t position) {
    if (::fseeko(file_.get(), static_cast<off_t>(position), SEEK_SET) != 0) note_failure();
}

void FileWriter::close() {
    OBSCURA_CHECK(file_ != nullptr, "{} is closed twice", shown_as_.string());
    if (std::fclose(file_.release()) != 0) note_failure();
    if (first_errno_ != 0) fail_write(shown_as_, reason_text(first_errno_));
}

}  // namespace obscura
