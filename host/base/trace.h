// SPDX-License-Identifier: Apache-2.0
// What happened when: steps of the host's threads, commands of the devices and lengths of queues, all on the host's
// monotonic clock, in the JSON of Chrome's tracing ("Trace Event Format"), which Perfetto opens.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <variant>
#include <vector>

namespace obscura {

enum class TraceCategory : uint8_t { kernel, transfer, compile, host };

// A fact about a slice: {"bytes", 4096u}, {"cache", "hit"}. Both texts are literals.
struct TraceDetail {
    std::string_view name;  // empty: there is none
    std::variant<uint64_t, std::string_view> value;
};

// Threads may report to it at once.
class TraceRecord {
  public:
    // Time 0 of the trace is when the record is made, in the thread that becomes its row "main".
    TraceRecord();

    int64_t now_ns() const;

    // A device with one row, of the commands in its queue. The number is what the next two take.
    uint32_t add_device(const std::string& name);
    void add_command(uint32_t device, TraceCategory category, std::string name, int64_t start_ns,
                     int64_t end_ns, TraceDetail detail);
    // From this moment on the queue of items has this length.
    void add_queue_length(uint32_t device, std::string_view queue, int64_t time_ns, uint64_t items);
    // In the calling thread's row.
    void add_step(TraceCategory category, std::string name, int64_t start_ns, int64_t end_ns,
                  TraceDetail detail);

    // Atomic. Throws InputError.
    void write(const std::filesystem::path& path) const;

  private:
    // As the format numbers rows. The host is a process with its threads, each device a process with one thread.
    struct Row {
        uint32_t process, thread;
    };
    struct Slice {
        Row row;
        TraceCategory category;
        TraceDetail detail;
        std::string name;
        int64_t start_ns, end_ns;
    };
    struct QueueLength {
        uint32_t process;
        std::string_view queue;
        int64_t time_ns;
        uint64_t items;
    };

    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    mutable std::mutex mutex_;  // of all below
    std::vector<std::string> devices_;
    std::map<std::thread::id, uint32_t> threads_;
    std::vector<Slice> slices_;
    std::vector<QueueLength> lengths_;
};

// A step of the host, from the object's construction to its end.
class TraceStep {
  public:
    // trace: where to report; null = nowhere.
    TraceStep(TraceRecord* trace, TraceCategory category, std::string name, TraceDetail detail = {});
    ~TraceStep();
    TraceStep(const TraceStep&) = delete;
    TraceStep& operator=(const TraceStep&) = delete;

    int64_t start_ns() const { return start_ns_; }

  private:
    TraceRecord* trace_;
    TraceCategory category_;
    std::string name_;
    TraceDetail detail_;
    int64_t start_ns_ = 0;
};

}  // namespace obscura
