// SPDX-License-Identifier: Apache-2.0
// The trace file, read back as JSON. What a render reports is tests/image/trace_file_test.py.
#include "base/trace.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "base/file.h"
#include "support/temporary_folder.h"

namespace obscura {
namespace {

using Json = nlohmann::json;

class Trace : public testing::Test {
  protected:
    std::vector<Json> events(const std::string& phase) const {
        trace.write(folder.path() / "trace.json");
        std::vector<Json> found;
        const Json file = Json::parse(read_text(folder.path() / "trace.json"));
        for (const Json& event : file.at("traceEvents"))
            if (event.at("ph") == phase) found.push_back(event);
        return found;
    }
    // Names of the rows by process and thread.
    Json row_names() const {
        Json names;
        for (const Json& event : events("M")) {
            const int thread = event.value("tid", -1);
            names[event.at("pid").dump() + ":" + std::to_string(thread)] = event.at("args").at("name");
        }
        return names;
    }

    test::TemporaryFolder folder;
    TraceRecord trace;
};

TEST_F(Trace, WithoutEventsIsValid) {
    EXPECT_TRUE(events("X").empty());
    EXPECT_EQ(row_names(), (Json{{"1:-1", "host"}, {"1:1", "main"}}));
}

TEST_F(Trace, SliceIsInMicroseconds) {
    const uint32_t device = trace.add_device("PoCL");
    trace.add_command(device, TraceCategory::transfer, "upload nodes", 1234567, 1234570, {"bytes", 4096u});
    EXPECT_EQ(events("X"),
              std::vector<Json>{Json::parse(R"({"ph": "X", "name": "upload nodes", "cat": "transfer",
        "pid": 2, "tid": 1, "ts": 1234.567, "dur": 0.003, "args": {"bytes": 4096}})")});
}

TEST_F(Trace, EachDeviceAndEachThreadHasARow) {
    trace.add_device("first");
    trace.add_device("second");
    std::thread([&] { const TraceStep step(&trace, TraceCategory::host, "build BVH"); }).join();
    EXPECT_EQ(row_names(), (Json{{"1:-1", "host"},
                                 {"1:1", "main"},
                                 {"1:2", "worker"},
                                 {"2:-1", "first"},
                                 {"2:1", "command queue"},
                                 {"3:-1", "second"},
                                 {"3:1", "command queue"}}));
    EXPECT_EQ(events("X").at(0).at("tid"), 2);
}

TEST_F(Trace, StepsNestAndTellTheirDetail) {
    {
        const TraceStep outer(&trace, TraceCategory::host, "outer");
        const TraceStep inner(&trace, TraceCategory::compile, "shade", {"cache", "miss"});
    }
    const std::vector<Json> steps = events("X");
    ASSERT_EQ(steps.size(), 2u);
    const Json &inner = steps[0], &outer = steps[1];
    EXPECT_EQ(inner.at("name"), "shade");
    EXPECT_EQ(inner.at("cat"), "compile");
    EXPECT_EQ(inner.at("args"), (Json{{"cache", "miss"}}));
    const auto end = [](const Json& step) {
        return step.at("ts").get<double>() + step.at("dur").get<double>();
    };
    EXPECT_LE(outer.at("ts"), inner.at("ts"));
    EXPECT_GE(end(outer) + 1e-6, end(inner));
}

TEST_F(Trace, StepWithoutATraceIsNone) {
    { const TraceStep step(nullptr, TraceCategory::host, "outer"); }
    EXPECT_TRUE(events("X").empty());
}

TEST_F(Trace, QueueLengthIsACounter) {
    const uint32_t device = trace.add_device("PoCL");
    trace.add_queue_length(device, "shadow rays", 2000, 17);
    EXPECT_EQ(events("C"),
              std::vector<Json>{Json::parse(
                  R"({"ph": "C", "name": "shadow rays", "pid": 2, "ts": 2, "args": {"queued": 17}})")});
}

TEST_F(Trace, NamesWithQuotesAndForeignBytesStayValid) {
    trace.add_device("the \"fast\" one\\\n\xff");
    EXPECT_EQ(row_names().at("2:-1"), "the \"fast\" one\\\n\xef\xbf\xbd");
}

}  // namespace
}  // namespace obscura
