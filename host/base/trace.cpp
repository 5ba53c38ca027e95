// SPDX-License-Identifier: Apache-2.0
// Writes the events one a line as they are formatted: a long render has millions.
#include "base/trace.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "base/file.h"

namespace obscura {
namespace {

// From 1 on: viewers take process 0 and thread 0 for the idle task's.
constexpr uint32_t HOST_PROCESS = 1;
constexpr uint32_t FIRST_DEVICE_PROCESS = 2;
constexpr uint32_t FIRST_THREAD = 1;

const char* category_name(TraceCategory category) {
    switch (category) {
        case TraceCategory::kernel:
            return "kernel";
        case TraceCategory::transfer:
            return "transfer";
        case TraceCategory::compile:
            return "compile";
        case TraceCategory::host:
            return "host";
    }
    return "";
}

// Names of devices may hold any bytes: what is not UTF-8 becomes U+FFFD.
std::string json_text(std::string_view text) {
    using Json = nlohmann::json;
    return Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
}

// The format counts in microseconds.
std::string microseconds(int64_t ns) {
    return fmt::format("{}.{:03}", ns / 1000, ns % 1000);
}

std::string arguments(const TraceDetail& detail) {
    if (detail.name.empty()) return "{}";
    const auto* const number = std::get_if<uint64_t>(&detail.value);
    const std::string value =
        number != nullptr ? fmt::format("{}", *number) : json_text(std::get<std::string_view>(detail.value));
    return fmt::format("{{{}:{}}}", json_text(detail.name), value);
}

// The array of events in the file.
class EventWriter {
  public:
    explicit EventWriter(FileWriter& file) : file_(file) {
        put("{\"displayTimeUnit\":\"ms\",\"traceEvents\":[");
    }
    void add(const std::string& event) {
        put(std::exchange(is_first_, false) ? "\n" : ",\n");
        put(event);
    }
    void end() { put("\n]}\n"); }

    void name_process(uint32_t process, const std::string& name) {
        add(fmt::format(R"({{"ph":"M","name":"process_name","pid":{},"args":{{"name":{}}}}})", process,
                        json_text(name)));
    }
    void name_thread(uint32_t process, uint32_t thread, const std::string& name) {
        add(fmt::format(R"({{"ph":"M","name":"thread_name","pid":{},"tid":{},"args":{{"name":{}}}}})",
                        process, thread, json_text(name)));
    }

  private:
    void put(std::string_view text) { file_.write(text.data(), text.size()); }

    FileWriter& file_;
    bool is_first_ = true;
};

}  // namespace

TraceRecord::TraceRecord() {
    threads_.emplace(std::this_thread::get_id(), FIRST_THREAD);
}

int64_t TraceRecord::now_ns() const {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - start_)
        .count();
}

uint32_t TraceRecord::add_device(const std::string& name) {
    const std::lock_guard lock(mutex_);
    devices_.push_back(name);
    return static_cast<uint32_t>(devices_.size() - 1);
}

void TraceRecord::add_command(uint32_t device, TraceCategory category, std::string name, int64_t start_ns,
                              int64_t end_ns, TraceDetail detail) {
    const std::lock_guard lock(mutex_);
    slices_.push_back(
        {{FIRST_DEVICE_PROCESS + device, FIRST_THREAD}, category, detail, std::move(name), start_ns, end_ns});
}

void TraceRecord::add_queue_length(uint32_t device, std::string_view queue, int64_t time_ns, uint64_t items) {
    const std::lock_guard lock(mutex_);
    lengths_.push_back({FIRST_DEVICE_PROCESS + device, queue, time_ns, items});
}

void TraceRecord::add_step(TraceCategory category, std::string name, int64_t start_ns, int64_t end_ns,
                           TraceDetail detail) {
    const std::lock_guard lock(mutex_);
    const uint32_t next = FIRST_THREAD + static_cast<uint32_t>(threads_.size());
    const uint32_t thread = threads_.emplace(std::this_thread::get_id(), next).first->second;
    slices_.push_back({{HOST_PROCESS, thread}, category, detail, std::move(name), start_ns, end_ns});
}

void TraceRecord::write(const std::filesystem::path& path) const {
    const std::lock_guard lock(mutex_);
    write_atomically(path, [&](const std::filesystem::path& temporary) {
        FileWriter file(temporary, path);
        EventWriter events(file);
        events.name_process(HOST_PROCESS, "host");
        for (const auto& [id, thread] : threads_)
            events.name_thread(HOST_PROCESS, thread, thread == FIRST_THREAD ? "main" : "worker");
        for (uint32_t i = 0; i < devices_.size(); ++i) {
            events.name_process(FIRST_DEVICE_PROCESS + i, devices_[i]);
            events.name_thread(FIRST_DEVICE_PROCESS + i, FIRST_THREAD, "command queue");
        }
        for (const Slice& slice : slices_) {
            events.add(fmt::format(
                R"({{"ph":"X","name":{},"cat":"{}","pid":{},"tid":{},"ts":{},"dur":{},"args":{}}})",
                json_text(slice.name), category_name(slice.category), slice.row.process, slice.row.thread,
                microseconds(slice.start_ns), microseconds(slice.end_ns - slice.start_ns),
                arguments(slice.detail)));
        }
        for (const QueueLength& length : lengths_) {
            // Perfetto calls the counter "shadow rays queued", chrome://tracing "shadow rays".
            events.add(fmt::format(R"({{"ph":"C","name":{},"pid":{},"ts":{},"args":{{"queued":{}}}}})",
                                   json_text(length.queue), length.process, microseconds(length.time_ns),
                                   length.items));
        }
        events.end();
        file.close();
    });
}

TraceStep::TraceStep(TraceRecord* trace, TraceCategory category, std::string name, TraceDetail detail)
    : trace_(trace), category_(category), name_(std::move(name)), detail_(detail) {
    if (trace_ != nullptr) start_ns_ = trace_->now_ns();
}

TraceStep::~TraceStep() {
    if (trace_ != nullptr)
        trace_->add_step(category_, std::move(name_), start_ns_, trace_->now_ns(), detail_);
}

}  // namespace obscura
