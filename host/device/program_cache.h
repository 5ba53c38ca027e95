// SPDX-License-Identifier: Apache-2.0
// Built programs on disk, one file per key. Entries carry magic, key, length and checksum: a bad one is as
// good as none. Nothing here is fatal: an unusable folder costs one warning and the time to build again.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace obscura {

// 128 bits of the text as 32 hexadecimal digits; not cryptographic.
std::string hash_text(std::string_view text);

class ProgramCache {
  public:
    // OBSCURA_CACHE_DIR, else $XDG_CACHE_HOME/obscura, else ~/.cache/obscura.
    ProgramCache();
    explicit ProgramCache(std::filesystem::path folder);

    const std::filesystem::path& folder() const { return folder_; }
    std::filesystem::path entry_path(const std::string& key) const;

    // The program stored under key, if there is one and it is whole. Its file's time becomes that of its last use.
    std::optional<std::vector<unsigned char>> load(const std::string& key) const;
    // Replaces the entry atomically, so that several processes can share the folder; removes entries that were not used for
    // 30 days, which no driver or version in use asks for.
    void store(const std::string& key, std::span<const unsigned char> program);

  private:
    void remove_unused() const;

    std::filesystem::path folder_;
    bool warned_ = false;
};

}  // namespace obscura
