// SPDX-License-Identifier: Apache-2.0
#include "cli/profile_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string>

#include "base/units.h"

namespace obscura {
namespace {

using Histogram = RayVisits::Histogram;

std::string number_or_dash(double value, const char* format) {
    return value > 0 ? fmt::format(fmt::runtime(format), value) : "-";
}

void print_stages(const RenderProfile& profile) {
    fmt::print("{:<12} {:>8} {:>8} {:>9} {:>6} {:>8} {:>8} {:>10} {:>6} {:>5}  {}\n", "stage", "launches",
               "items", "ms", "share", "ns/item", "Mrays/s", "moved", "GB/s", "fill", "bound by");
    for (const StageFigures& stage : profile.stages) {
        fmt::print("{:<12} {:>8} {:>8} {:>9.1f} {:>4.0f} % {:>8.1f} {:>8} {:>10} {:>6.2f} {:>3.0f} %  {}\n",
                   stage.row, stage.profile.launches, si_count(static_cast<double>(stage.profile.items)),
                   stage.profile.ms, 100 * stage.share, stage.ns_per_item,
                   number_or_dash(stage.mrays_per_s, "{:.2f}"), bytes_text(stage.bytes), stage.gb_per_s,
                   100 * stage.fill, stage.bound);
    }
    const DeviceRates& rates = profile.rates;
    fmt::print(
        "Bytes moved are computed, not counted: the lanes of the queues that a stage reads and writes. fill: "
        "work items that "
        "had work.\nThis device at its best: a copy moves {:.2f} GB/s, a launch without work takes {:.0f} us "
        "and an idle work "
        "item {:.2f} ns,\na visit of a node or block {:.1f} ns of a core, for incoherent rays in a tree of 2 "
        "MB.\n\n",
        rates.copy_gb_per_s, 1000 * rates.launch_ms, rates.idle_item_ns, rates.visit_ns);
}

// 0, 1, 2-3, 4-7 ...: rays by the number of bits of their count.
std::vector<uint64_t> by_powers_of_two(const Histogram& histogram) {
    std::vector<uint64_t> bins;
    for (size_t n = 0; n < histogram.size(); ++n) {
        const auto bin = static_cast<size_t>(std::bit_width(n));
        if (bins.size() <= bin) bins.resize(bin + 1);
        bins[bin] += histogram[n];
    }
    return bins;
}

// A bar for each bin, the fullest one as high as the line.
std::string bars(const std::vector<uint64_t>& bins) {
    static constexpr std::array BARS{" ", "▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
    const auto most = static_cast<double>(*std::ranges::max_element(bins));
    std::string text;
    for (const uint64_t rays : bins)
        text += BARS.at(static_cast<size_t>(std::ceil(8 * static_cast<double>(rays) / most)));
    return text;
}

// The smallest number that 99 % of the rays don't exceed.
size_t percentile99(const Histogram& histogram, uint64_t rays) {
    uint64_t sum = 0;
    for (size_t n = 0; n < histogram.size(); ++n) {
        sum += histogram[n];
        if (static_cast<double>(sum) >= 0.99 * static_cast<double>(rays)) return n;
    }
    return histogram.size();
}

void print_visits(const RenderProfile& profile) {
    fmt::print("{:<12} {:>8}  {:<8} {:>7} {:>6} {:>6}  {}\n", "queue", "rays", "per ray", "mean", "99 %",
               "most", "histogram: 0, 1, 2-3, 4-7, 8-15, ...");
    for (size_t i = 0; i < RAY_QUEUES.size(); ++i) {
        const RayVisits& queue = profile.visits.queues[i];
        if (queue.rays == 0) continue;
        const auto print_row = [&](bool is_first, const char* what, const Histogram& histogram) {
            fmt::print("{:<12} {:>8}  {:<8} {:>7.2f} {:>6} {:>6}  |{}|\n", is_first ? RAY_QUEUES[i] : "",
                       is_first ? si_count(static_cast<double>(queue.rays)) : "", what, mean(histogram),
                       percentile99(histogram, queue.rays), histogram.size() - 1,
                       bars(by_powers_of_two(histogram)));
        };
        print_row(true, "nodes", queue.nodes);
        print_row(false, "blocks", queue.blocks);
        print_row(false, "stack", queue.stack);
    }
    fmt::print("Counted by kernels of their own, which took {} more; what lies behind panes isn't counted.\n",
               duration_text(profile.visits.seconds));
}

Json queue_json(const RayVisits& queue) {
    return {{"rays", queue.rays},
            {"nodes_per_ray", mean(queue.nodes)},
            {"blocks_per_ray", mean(queue.blocks)},
            {"stack_per_ray", mean(queue.stack)},
            // [n]: rays with n of them
            {"histograms", {{"nodes", queue.nodes}, {"blocks", queue.blocks}, {"stack", queue.stack}}}};
}

}  // namespace

void print_profile(const RenderProfile& profile) {
    print_stages(profile);
    print_visits(profile);
}

Json profile_json(const RenderProfile& profile) {
    Json json;
    json["device"] = {{"copy_gb_per_s", profile.rates.copy_gb_per_s}, {"launch_ms", profile.rates.launch_ms},
                      {"idle_item_ns", profile.rates.idle_item_ns},   {"visit_ns", profile.rates.visit_ns},
                      {"cache_bytes", profile.rates.cache_bytes},     {"cores", profile.rates.cores}};
    for (const StageFigures& stage : profile.stages) {
        Json& row = json["stages"][stage.row];
        row = {{"launches", stage.profile.launches},
               {"items", stage.profile.items},
               {"ms", stage.profile.ms},
               {"share", stage.share},
               {"ns_per_item", stage.ns_per_item}};
        if (stage.mrays_per_s > 0) row["mrays_per_s"] = stage.mrays_per_s;
        row["bytes"] = stage.bytes;
        row["gb_per_s"] = stage.gb_per_s;
        row["fill"] = stage.fill;
        row["idle_share"] = stage.idle_share;
        row["bound"] = stage.bound;
    }
    for (size_t i = 0; i < RAY_QUEUES.size(); ++i) {
        if (profile.visits.queues[i].rays > 0)
            json["queues"][std::string(RAY_QUEUES[i])] = queue_json(profile.visits.queues[i]);
    }
    json["counting_seconds"] = profile.visits.seconds;
    return json;
}

}  // namespace obscura
