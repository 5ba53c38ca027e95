// SPDX-License-Identifier: Apache-2.0
// An entry is one line of text, which the key and the program's bytes determine, and then those bytes: an
// entry is whole if its line is the one that its bytes call for.
#include "device/program_cache.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <fstream>

#include "base/error.h"
#include "base/file.h"
#include "base/log.h"

namespace obscura {

namespace {

std::filesystem::path default_folder() {
    const auto variable = [](const char* name) -> std::filesystem::path {
        const char* const value = std::getenv(name);
        return value != nullptr ? value : "";
    };
    if (auto folder = variable("OBSCURA_CACHE_DIR"); !folder.empty()) return folder;
    // The XDG base directory specification says that a relative path is to be ignored.
    if (const auto folder = variable("XDG_CACHE_HOME"); folder.is_absolute()) return folder / "obscura";
    if (const auto home = variable("HOME"); !home.empty()) return home / ".cache" / "obscura";
    return {};
}

constexpr std::chrono::days KEPT_UNUSED{30};
constexpr const char* ENTRY_EXTENSION = ".program";

std::string entry_header(const std::string& key, std::string_view program) {
    return fmt::format("obscura program 1 {} {:016x} {}\n", key, program.size(), hash_text(program));
}

std::string_view as_text(std::span<const unsigned char> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

// FNV-1a with 128 bits; offset basis and prime from its specification (draft-eastlake-fnv).
std::string hash_text(std::string_view text) {
    __extension__ using Word = unsigned __int128;
    constexpr Word PRIME = (Word{1} << 88) + 0x13b;
    Word hash = (Word{0x6c62272e07bb0142} << 64) + 0x62b821756295c58d;
    for (const char c : text) {
        hash ^= static_cast<unsigned char>(c);
        hash *= PRIME;
    }
    return fmt::format("{:016x}{:016x}", static_cast<uint64_t>(hash >> 64), static_cast<uint64_t>(hash));
}

ProgramCache::ProgramCache() : ProgramCache(default_folder()) {}

ProgramCache::ProgramCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

std::filesystem::path ProgramCache::entry_path(const std::string& key) const {
    return folder_ / (key + ENTRY_EXTENSION);
}

std::optional<std::vector<unsigned char>> ProgramCache::load(const std::string& key) const {
    if (folder_.empty()) return std::nullopt;
    std::error_code error;
    const auto size = std::filesystem::file_size(entry_path(key), error);  // a folder has none
    if (error) return std::nullopt;
    std::vector<unsigned char> bytes(size);
    std::ifstream file(entry_path(key), std::ios::binary);
    if (!file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size)))
        return std::nullopt;
    const size_t header_size = entry_header(key, "").size();
    if (bytes.size() < header_size) return std::nullopt;
    const std::string_view text = as_text(bytes);
    if (text.substr(0, header_size) != entry_header(key, text.substr(header_size))) return std::nullopt;
    bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(header_size));
    // A folder that can be read only keeps its times.
    std::filesystem::last_write_time(entry_path(key), std::filesystem::file_time_type::clock::now(), error);
    return bytes;
}

void ProgramCache::store(const std::string& key, std::span<const unsigned char> program) {
    try {
        if (folder_.empty()) throw InputError("none of OBSCURA_CACHE_DIR, XDG_CACHE_HOME and HOME is set");
        make_folder(folder_);
        write_text(entry_path(key), entry_header(key, as_text(program)).append(as_text(program)));
        remove_unused();
    } catch (const std::exception& error) {  // no permission, disk full, ...: only speed is lost
        if (!warned_) log_warning("Compiled kernels can't be kept for the next start: {}", error.what());
        warned_ = true;
    }
}

// Failures are left alone: another process may be cleaning up too, and an old file costs only its space.
void ProgramCache::remove_unused() const {
    namespace fs = std::filesystem;
    const auto oldest = fs::file_time_type::clock::now() - KEPT_UNUSED;
    std::error_code error;
    for (fs::directory_iterator entry(folder_, error), end; !error && entry != end; entry.increment(error)) {
        if (entry->path().extension() != ENTRY_EXTENSION) continue;
        std::error_code ignored;
        const fs::file_time_type used = entry->last_write_time(ignored);
        if (!ignored && used < oldest) fs::remove(entry->path(), ignored);
    }
}

}  // namespace obscura
