// SPDX-License-Identifier: Apache-2.0
// One warning per kind of thing that the file holds and obscura does not render.
#include "base/log.h"
#include "base/units.h"
#include "scene/gltf_reader.h"

#include <algorithm>

namespace obscura {

void Notices::add(const std::string& what, const std::string& unit) {
    auto found = std::find_if(notices_.begin(), notices_.end(), [&](const Notice& notice) {
        return notice.what == what && notice.unit == unit;
    });
    if (found == notices_.end()) found = notices_.insert(notices_.end(), {what, unit, 0});
    ++found->count;
}

void Notices::print(const std::string& file) const {
    for (const Notice& notice : notices_)
        log_warning("{}: {} ({}).", file, notice.what, counted(notice.count, notice.unit));
}

std::string gltf_place(const char* kind, const std::string& name, size_t index) {
    return name.empty() ? fmt::format("{} {}", kind, index) : fmt::format("{} '{}'", kind, name);
}

}  // namespace obscura
