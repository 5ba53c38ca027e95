// SPDX-License-Identifier: Apache-2.0
// What a scene needs becomes build options: nothing else is compiled.
#include "wavefront/features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <set>
#include <sstream>

namespace obscura {
namespace {

// The names NAME of "-D NEED_NAME=1", in lower case as in needs.h.
std::set<std::string> defined_needs(const std::string& options) {
    std::set<std::string> names;
    std::istringstream words(options);
    for (std::string word; words >> word;) {
        if (!word.starts_with("NEED_")) continue;
        std::string name = word.substr(5, word.find('=') - 5);
        std::ranges::transform(name, name.begin(),
                               [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        names.insert(name);
    }
    return names;
}

Needs everything(FalloffKind falloff) {
    RenderSettings settings;
    settings.needs = NeedsMode::all;
    settings.falloff.kind = falloff;
    return analyse_needs(Scene{}, settings);
}

TEST(Features, StageDefinesOnlyWhatItDependsOn) {
    for (const StageInfo& info : STAGES) {
        std::istringstream words{std::string(info.features)};
        std::set<std::string> own(std::istream_iterator<std::string>(words), {});
        if (own.erase("falloff") > 0) own.insert("falloff_cbrt");
        EXPECT_EQ(defined_needs(stage_options(info.stage, everything(FalloffKind::cbrt), false, false)), own)
            << info.name;
    }
}

TEST(Features, SceneThatNeedsNothingDefinesNothingButItsFalloff) {
    Needs needs;
    needs.falloff = FalloffKind::step;
    for (const StageInfo& info : STAGES) {
        const char* options = info.stage == Stage::obscurance ? " -D NEED_FALLOFF_STEP=1" : "";
        EXPECT_EQ(stage_options(info.stage, needs, false, false), options) << info.name;
    }
}

TEST(Features, TraceIsTheSameForEveryScene) {
    EXPECT_EQ(stage_options(Stage::trace, everything(FalloffKind::exp), true, false), "");
}

TEST(Features, OneFalloffIsCompiledUnlessAllAreWanted) {
    Needs needs;
    needs.falloff = FalloffKind::sqrt;
    EXPECT_EQ(defined_needs(stage_options(Stage::obscurance, needs, false, false)),
              std::set<std::string>{"falloff_sqrt"});
    EXPECT_EQ(defined_needs(stage_options(Stage::obscurance, needs, true, false)),
              (std::set<std::string>{"falloff_step", "falloff_linear", "falloff_sqrt", "falloff_cbrt",
                                     "falloff_exp", "falloff_expjump", "falloff_pow"}));
}

TEST(Features, PortableIsPassedToEveryStage) {
    for (const StageInfo& info : STAGES) {
        EXPECT_NE(stage_options(info.stage, {}, false, true).find("-D OBSCURA_PORTABLE"), std::string::npos)
            << info.name;
        EXPECT_EQ(stage_options(info.stage, {}, false, false).find("PORTABLE"), std::string::npos)
            << info.name;
    }
}

}  // namespace
}  // namespace obscura
