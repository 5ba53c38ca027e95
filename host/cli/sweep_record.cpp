// SPDX-License-Identifier: Apache-2.0
#include "cli/sweep_record.h"

#include <algorithm>

#include "base/error.h"
#include "base/file.h"

namespace obscura {
namespace {

// The name of beauty, whose layer has none.
constexpr const char* BEAUTY = "beauty";

std::string title(const std::string& layer) {
    return layer.empty() ? BEAUTY : layer;
}

std::string layer_name(const std::string& title) {
    return title == BEAUTY ? "" : title;
}

Json to_json(const SweepResult& result) {
    Json json{{"method", result.method}, {"budget", result.budget}, {"first_seed", result.first_seed}};
    for (const SweepRun& run : result.runs) {
        Json errors;
        for (const auto& [layer, e] : run.errors)
            errors[title(layer)] = {e.mse, e.relmse, e.mape, e.bias};
        json["runs"].push_back({{"seconds", run.seconds}, {"rays", run.rays}, {"errors", errors}});
    }
    for (const auto& [layer, common] : result.common)
        json["common"][title(layer)] = {common.mse, common.relmse};
    return json;
}

SweepResult from_json(const Json& json) {
    SweepResult result{json.at("method"), json.at("budget"), json.at("first_seed"), {}, {}};
    for (const Json& stored : json.at("runs")) {
        SweepRun run{stored.at("seconds"), stored.at("rays"), {}};
        for (const auto& [layer, e] : stored.at("errors").items())
            run.errors[layer_name(layer)] = {e.at(0), e.at(1), e.at(2), e.at(3)};
        result.runs.push_back(std::move(run));
    }
    if (!json.contains("common")) return result;
    for (const auto& [layer, common] : json.at("common").items())
        result.common[layer_name(layer)] = {common.at(0), common.at(1)};
    return result;
}

void check_settings(const std::filesystem::path& file, const Json& found, const Json& wanted) {
    for (const auto& [name, value] : wanted.items()) {
        const Json other = found.value(name, Json());
        if (other == value) continue;
        throw InputError("{}: it was made with {} {}, not {}; choose another folder (-o), or remove it",
                         file.string(), name, other.dump(), value.dump());
    }
}

}  // namespace

SweepRecord::SweepRecord(std::filesystem::path file, Json settings)
    : file_(std::move(file)), settings_(std::move(settings)) {
    if (!std::filesystem::exists(file_)) return;
    try {
        const Json record = Json::parse(read_text(file_));
        check_settings(file_, record.at("settings"), settings_);
        for (const Json& result : record.at("results"))
            results_.push_back(from_json(result));
    } catch (const Json::exception& error) {
        throw InputError("{}: it is no record of a sweep ({}); remove it", file_.string(), error.what());
    }
}

bool SweepRecord::holds(const SweepTask& task) const {
    return std::ranges::any_of(results_, [&](const SweepResult& result) {
        return result.method == task.method.name && result.budget == task.budget &&
               result.first_seed == task.first_seed && result.runs.size() >= task.runs;
    });
}

void SweepRecord::add(SweepResult result) {
    std::erase_if(results_, [&](const SweepResult& other) {
        return result.method == other.method && result.budget == other.budget &&
               result.first_seed == other.first_seed;
    });
    results_.push_back(std::move(result));
}

void SweepRecord::save() const {
    Json results = Json::array();
    for (const SweepResult& result : results_)
        results.push_back(to_json(result));
    write_text(file_, Json{{"settings", settings_}, {"results", results}}.dump() + "\n");
}

}  // namespace obscura
