// SPDX-License-Identifier: Apache-2.0
#include "cli/bench_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "base/units.h"
#include "cli/json_output.h"

namespace obscura {
namespace {

constexpr double MEGA = 1e6;

double per(double sum, uint64_t count) {
    return count > 0 ? sum / static_cast<double>(count) : 0;
}

double per(uint64_t sum, uint64_t count) {
    return per(static_cast<double>(sum), count);
}

// Rays per second of a mode in the survey, in millions.
double survey_mrays(const QueueBench& queue, const ModeResult& mode) {
    return mode.seconds > 0 ? static_cast<double>(queue.visits.rays) / mode.seconds / MEGA : 0;
}

const char* robustness(bool robust) {
    return robust ? "robust" : "fast";
}

const char* query_name(RayQuery query) {
    switch (query) {
        case RayQuery::closest:
            return "closest";
        case RayQuery::any:
            return "any";
        case RayQuery::opaque:
            return "any but panes";
    }
    return "";
}

// --- JSON ------------------------------------------------------------------------------------------------------

void put_spread(Json& json, const std::string& name, const Spread& spread, double unit = 1) {
    json[name] = spread.median / unit;
    json[name + "_min"] = spread.min / unit;
    json[name + "_max"] = spread.max / unit;
}

// Figures that there are none of are null: the ratio of speeds at wrong answers, and all of a queue without rays.
Json to_json(const PairedTimes& times, const ModeResult& best, bool agrees) {
    if (times.rays == 0)
        return {{"embree_mode", nullptr},
                {"device_mrays", nullptr},
                {"embree_mrays", nullptr},
                {"ratio", nullptr}};
    Json json{{"embree_mode", fmt::format("{}, {}", robustness(best.mode.robust), call_text(best.mode))}};
    put_spread(json, "device_mrays", times.device_rate(), MEGA);
    put_spread(json, "embree_mrays", times.embree_rate(), MEGA);
    if (agrees) {
        put_spread(json, "ratio", times.ratio());
    } else {
        json["ratio"] = nullptr;
    }
    json["device_seconds"] = times.device;
    json["embree_seconds"] = times.embree;
    return json;
}

Json to_json(const QueueBench& queue) {
    Json json{{"rays", queue.robust.rays}, {"hits", queue.visits.hits}, {"query", query_name(queue.query)}};
    json.update(to_json(queue.robust, queue.best(true), queue.agrees()));
    json["fast"] = to_json(queue.fast, queue.best(false), queue.agrees());
    json["agrees"] = queue.agrees();
    json["differing"] = queue.differing();
    json["differing_share"] = per(queue.differing(), queue.visits.rays);
    json["nodes_per_ray"] = per(queue.visits.nodes, queue.visits.rays);
    json["blocks_per_ray"] = per(queue.visits.blocks, queue.visits.rays);
    json["stack_entries"] = queue.visits.stack_entries;
    for (const ModeResult& mode : queue.modes) {
        json["modes"].push_back({{"robust", mode.mode.robust},
                                 {"call", call_text(mode.mode)},
                                 {"mrays", survey_mrays(queue, mode)},
                                 {"differing", mode.differing}});
    }
    return json;
}

Json cost_json(uint64_t bytes, double build_seconds, uint64_t triangles) {
    return {
        {"bytes", bytes}, {"bytes_per_triangle", per(bytes, triangles)}, {"build_seconds", build_seconds}};
}

Json to_json(const SceneBench& bench, const Scene& scene, const DeviceInfo& device) {
    const uint64_t triangles = scene.triangles.size();
    Json json{{"scene", scene.name},
              {"triangles", triangles},
              {"device", device.name},
              {"driver", device.driver_version},
              {"device_threads", device.compute_units},
              {"embree_threads", bench.threads},
              {"waves", bench.waves},
              {"pairs", BENCH_PAIRS},
              {"complete", bench.complete},
              {"passed", std::ranges::all_of(bench.queues, &QueueBench::agrees)}};
    json["bvh"] = {{"device", cost_json(bench.bvh_bytes, bench.build_seconds, triangles)},
                   {"embree_robust", cost_json(bench.robust.bytes, bench.robust.build_seconds, triangles)},
                   {"embree_fast", cost_json(bench.fast.bytes, bench.fast.build_seconds, triangles)}};
    for (const QueueBench& queue : bench.queues)
        json["queues"][queue.name] = to_json(queue);
    return json;
}

// --- Tables ----------------------------------------------------------------------------------------------------

// The queues that have rays which were timed.
std::vector<const QueueBench*> used_queues(const SceneBench& bench) {
    std::vector<const QueueBench*> used;
    for (const QueueBench& queue : bench.queues)
        if (queue.robust.rays > 0) used.push_back(&queue);
    return used;
}

std::string spread_text(const Spread& spread, double unit = 1) {
    return fmt::format("{:5.2f} ({:5.2f} to {:5.2f})", spread.median / unit, spread.min / unit,
                       spread.max / unit);
}

void print_ratios(const std::vector<const QueueBench*>& queues) {
    fmt::print("{:<10}  {:>8}  {:<6}  {:<22}  {:<22}  {:<22}  {}\n", "queue", "rays", "Embree",
               "device, Mrays/s", "Embree, Mrays/s", "device / Embree", "Embree's best mode");
    for (const QueueBench* queue : queues) {
        for (const bool robust : {true, false}) {
            const PairedTimes& times = robust ? queue->robust : queue->fast;
            const std::string ratio = queue->agrees() ? spread_text(times.ratio()) : "hits differ";
            fmt::print("{:<10}  {:>8}  {:<6}  {:<22}  {:<22}  {:<22}  {}\n", robust ? queue->name : "",
                       robust ? si_count(static_cast<double>(times.rays)) : "", robustness(robust),
                       spread_text(times.device_rate(), MEGA), spread_text(times.embree_rate(), MEGA), ratio,
                       call_text(queue->best(robust).mode));
        }
    }
    fmt::print("Medians of {} pairs, smallest and largest; ratios are taken pair by pair.\n\n", BENCH_PAIRS);
}

void print_modes(const std::vector<const QueueBench*>& queues) {
    fmt::print("{:<31}", "Embree, Mrays/s");
    for (const QueueBench* queue : queues)
        fmt::print("  {:^14}", queue->name);
    fmt::print("\n{:<31}", "");
    for (size_t i = 0; i < queues.size(); ++i)
        fmt::print("  {:>7}{:>7}", "robust", "fast");
    fmt::print("\n");
    const size_t half = embree_modes().size() / 2;  // robust, then the same calls fast
    for (size_t i = 0; i < half; ++i) {
        fmt::print("{:<31}", call_text(embree_modes()[i]));
        for (const QueueBench* queue : queues) {
            fmt::print("  {:>7.2f}{:>7.2f}", survey_mrays(*queue, queue->modes[i]),
                       survey_mrays(*queue, queue->modes[half + i]));
        }
        fmt::print("\n");
    }
    fmt::print("\n");
}

void print_visits(const std::vector<const QueueBench*>& queues) {
    fmt::print("{:<10}  {:>13}  {:>14}  {:>8}  {:>16}\n", "queue", "nodes per ray", "blocks per ray", "stack",
               "differing hits");
    for (const QueueBench* queue : queues) {
        const Visits& visits = queue->visits;
        fmt::print("{:<10}  {:>13.2f}  {:>14.2f}  {:>8}  {:>16}\n", queue->name,
                   per(visits.nodes, visits.rays), per(visits.blocks, visits.rays), visits.stack_entries,
                   fmt::format("{} of {}", queue->differing(), si_count(static_cast<double>(visits.rays))));
    }
    fmt::print("\n");
}

void print_costs(const SceneBench& bench, uint64_t triangles) {
    fmt::print("{:<14}  {:>18}  {:>8}\n", "BVH", "bytes per triangle", "build, s");
    const auto print_row = [&](const char* name, uint64_t bytes, double seconds) {
        fmt::print("{:<14}  {:>18.1f}  {:>8.3f}\n", name, per(bytes, triangles), seconds);
    };
    print_row("device", bench.bvh_bytes, bench.build_seconds);
    print_row("Embree, robust", bench.robust.bytes, bench.robust.build_seconds);
    print_row("Embree, fast", bench.fast.bytes, bench.fast.build_seconds);
    fmt::print("\n");
}

void print_tables(const SceneBench& bench, const Scene& scene, const DeviceInfo& device) {
    fmt::print("{}, {}, {}\n{}, {}; Embree on {}\n\n", scene.name,
               counted(scene.triangles.size(), "triangle"), counted(bench.waves, "wave"), device.name,
               counted(device.compute_units, "compute unit"),
               counted(static_cast<uint64_t>(bench.threads), "thread"));
    const std::vector<const QueueBench*> queues = used_queues(bench);
    print_ratios(queues);
    print_modes(queues);
    print_visits(queues);
    print_costs(bench, scene.triangles.size());
    fmt::print("The device's obscurance kernel also makes the directions and finds falloff and colours.\n");
    if (bench.has_panes)
        fmt::print(
            "Shadow rays pass through panes on both sides; obscurance rays do on the device, Embree's "
            "end.\n");
    for (const QueueBench* queue : queues) {
        if (queue->agrees()) continue;
        fmt::print("{}: the hits differ in more than {} of the rays: there is nothing to compare.\n",
                   queue->name, MAX_DIFFERING_SHARE);
    }
}

}  // namespace

void report_bench(const SceneBench& bench, const Scene& scene, const DeviceInfo& device,
                  const std::string& json) {
    if (json.empty()) {
        print_tables(bench, scene, device);
    } else {
        write_json(json, to_json(bench, scene, device));
    }
}

}  // namespace obscura
