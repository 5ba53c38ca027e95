// SPDX-License-Identifier: Apache-2.0
// Choosing among the listed devices: plain strings and numbers, no OpenCL.
#include "device/selector.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>

#include "base/error.h"
#include "base/units.h"

namespace obscura {

namespace {

std::optional<int> parse_index(std::string_view text) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole = error == std::errc{} && end == text.data() + text.size();
    return whole && value >= 0 ? std::optional(value) : std::nullopt;
}

bool contains_ignoring_case(std::string_view text, std::string_view part) {
    const auto equal = [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); };
    return std::search(text.begin(), text.end(), part.begin(), part.end(), equal) != text.end();
}

std::string describe(const DeviceInfo& info) {
    std::string text = info.index >= 0 ? fmt::format("  {} ({}:{})  {}, {}", info.index, info.platform_index,
                                                     info.device_index, info.platform, info.name)
                                       : fmt::format("  -  {}", info.platform);
    return info.usable ? text : fmt::format("{} - not usable: {}", text, info.reason);
}

std::string describe(std::span<const DeviceInfo> devices, std::span<const int> positions) {
    std::string text;
    for (const int position : positions)
        text.append("\n").append(describe(devices[static_cast<size_t>(position)]));
    return text;
}

// Positions of the devices (not of the platforms without any) that satisfy the predicate.
template <typename Predicate>
std::vector<int> positions_where(std::span<const DeviceInfo> devices, Predicate predicate) {
    std::vector<int> positions;
    for (size_t i = 0; i < devices.size(); ++i)
        if (devices[i].index >= 0 && predicate(devices[i])) positions.push_back(static_cast<int>(i));
    return positions;
}

std::vector<int> matches(std::span<const DeviceInfo> devices, std::string_view selector) {
    if (const auto index = parse_index(selector))
        return positions_where(devices, [&](const DeviceInfo& info) { return info.index == *index; });
    if (const size_t colon = selector.find(':'); colon != std::string_view::npos) {
        const auto platform = parse_index(selector.substr(0, colon));
        const auto device = parse_index(selector.substr(colon + 1));
        if (platform && device)
            return positions_where(devices, [&](const DeviceInfo& info) {
                return info.platform_index == *platform && info.device_index == *device;
            });
    }
    return positions_where(devices, [&](const DeviceInfo& info) {
        // PoCL's platform calls itself "Portable Computing Language"; "PoCL" stands in its version.
        return contains_ignoring_case(info.name, selector) ||
               contains_ignoring_case(info.platform, selector) ||
               contains_ignoring_case(info.platform_version, selector);
    });
}

std::string_view trimmed(std::string_view text) {
    const size_t first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

// Commas and slashes of a name are its own.
bool is_part_of_a_name(std::span<const DeviceInfo> devices, std::string_view text) {
    return std::ranges::any_of(
        devices, [&](const DeviceInfo& info) { return contains_ignoring_case(info.name, text); });
}

// SELECTOR or SELECTOR/N.
DeviceChoice select_choice(std::span<const DeviceInfo> devices, std::string_view entry) {
    const size_t slash = entry.rfind('/');
    if (slash == std::string_view::npos || is_part_of_a_name(devices, entry))
        return {select_device(devices, entry), 1};
    const auto parts = parse_index(entry.substr(slash + 1));
    if (!parts || *parts < 1 || slash == 0)
        throw InputError(
            "\"{}\": no device is called so; SELECTOR/N splits one into N sub-devices, 1 or more", entry);
    const int position = select_device(devices, entry.substr(0, slash));
    const DeviceInfo& info = devices[static_cast<size_t>(position)];
    const auto count = static_cast<uint32_t>(*parts);
    if (count > 1 && info.max_sub_devices == 0)
        throw InputError("\"{}\": {} can't be split into sub-devices", entry, info.name);
    if (count > std::max(info.max_sub_devices, 1u))
        throw InputError("\"{}\": {} has {}, which make at most {}", entry, info.name,
                         counted(info.compute_units, "compute unit"),
                         counted(info.max_sub_devices, "sub-device"));
    return {position, count};
}

}  // namespace

int default_device(std::span<const DeviceInfo> devices) {
    const auto pocl_cpu = [](const DeviceInfo& info) {
        return info.usable && info.is_cpu && info.platform == POCL_PLATFORM_NAME;
    };
    auto found = std::ranges::find_if(devices, pocl_cpu);
    if (found == devices.end()) found = std::ranges::find_if(devices, &DeviceInfo::usable);
    return found == devices.end() ? -1 : static_cast<int>(found - devices.begin());
}

int select_device(std::span<const DeviceInfo> devices, std::string_view selector) {
    const int fallback = default_device(devices);
    if (fallback < 0) {
        std::string rows;
        for (const DeviceInfo& info : devices)
            rows.append("\n").append(describe(info));
        throw DeviceError("There is no OpenCL device that obscura can use.{}", rows);
    }
    if (selector.empty()) return fallback;

    const std::vector<int> found = matches(devices, selector);
    if (found.empty())
        throw InputError("No OpenCL device matches \"{}\". There are:{}", selector,
                         describe(devices, positions_where(devices, [](const DeviceInfo&) { return true; })));
    if (found.size() > 1)
        throw InputError("Several OpenCL devices match \"{}\"; choose one by its index:{}", selector,
                         describe(devices, found));
    if (!devices[static_cast<size_t>(found.front())].usable)
        throw InputError("The OpenCL device that \"{}\" means can't be used:{}", selector,
                         describe(devices, found));
    return found.front();
}

std::vector<DeviceChoice> select_devices(std::span<const DeviceInfo> devices, std::string_view selector) {
    if (selector.empty() || is_part_of_a_name(devices, selector))
        return {{select_device(devices, selector), 1}};
    std::vector<DeviceChoice> choices;
    for (size_t start = 0; start <= selector.size();) {
        const size_t end = std::min(selector.find(',', start), selector.size());
        const std::string_view entry = trimmed(selector.substr(start, end - start));
        if (entry.empty()) throw InputError("\"{}\": an entry of the list is empty", selector);
        const DeviceChoice choice = select_choice(devices, entry);
        if (std::ranges::find(choices, choice.position, &DeviceChoice::position) != choices.end())
            throw InputError("\"{}\" means a device twice; it can be split by /N:\n{}", selector,
                             describe(devices[static_cast<size_t>(choice.position)]));
        choices.push_back(choice);
        start = end + 1;
    }
    return choices;
}

}  // namespace obscura
