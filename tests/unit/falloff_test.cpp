// SPDX-License-Identifier: Apache-2.0
// The falloff functions and the --rho and --dmax settings.
#include "scene/scene.h"
#include "scene/settings.h"
#include "support/errors.h"

#include <gtest/gtest.h>

#include <cmath>

namespace obscura {
namespace {

const std::vector<std::string> ALL_FALLOFFS{"step",     "linear", "sqrt",    "cbrt",    "exp",
                                            "exp:0.25", "exp:5",  "expjump", "pow:0.3", "pow:2"};

TEST(Falloff, ValuesAreTheClosedForms) {
    const double e = std::exp(1.0);
    EXPECT_EQ(falloff_value(parse_falloff("step"), 0.99), 0);
    EXPECT_EQ(falloff_value(parse_falloff("linear"), 0.25), 0.25);
    EXPECT_EQ(falloff_value(parse_falloff("sqrt"), 0.25), 0.5);
    EXPECT_NEAR(falloff_value(parse_falloff("cbrt"), 0.125), 0.5, 1e-15);
    EXPECT_NEAR(falloff_value(parse_falloff("exp"), 0.5), (1 - 1 / std::sqrt(e)) / (1 - 1 / e), 1e-15);
    EXPECT_NEAR(falloff_value(parse_falloff("exp:2"), 0.5), (1 - 1 / e) / (1 - 1 / (e * e)), 1e-15);
    EXPECT_NEAR(falloff_value(parse_falloff("expjump"), 0.5), 1 - 1 / std::sqrt(e), 1e-15);
    EXPECT_NEAR(falloff_value(parse_falloff("pow:2"), 0.5), 0.25, 1e-15);
}

TEST(Falloff, TinyDistanceKeepsItsDigits) {
    // 1 - exp(-t) would be 0 or a multiple of 1e-16 here.
    EXPECT_NEAR(falloff_value(parse_falloff("expjump"), 1e-18) / 1e-18, 1, 1e-14);
    EXPECT_NEAR(falloff_value(parse_falloff("exp"), 1e-18) / 1e-18, 1 / (1 - std::exp(-1.0)), 1e-14);
}

TEST(Falloff, FromMaxDistanceOnIsOpen) {
    for (const std::string& text : ALL_FALLOFFS)
        EXPECT_EQ(falloff_value(parse_falloff(text), 1), 1) << text;
}

TEST(Falloff, RisesMonotonicallyWithinUnitRange) {
    for (const std::string& text : ALL_FALLOFFS) {
        const Falloff falloff = parse_falloff(text);
        double previous = 0;
        for (int i = 0; i <= 1000; ++i) {
            const double value = falloff_value(falloff, i / 1000.0);
            EXPECT_GE(value, previous) << text << " at " << i;
            EXPECT_LE(value, 1) << text << " at " << i;
            previous = value;
        }
    }
}

TEST(Falloff, TextSurvivesRoundTrip) {
    for (const std::string& text : ALL_FALLOFFS)
        EXPECT_EQ(falloff_text(parse_falloff(text)), text);
    EXPECT_EQ(falloff_text(parse_falloff("exp:1")), "exp");
    EXPECT_EQ(falloff_text(Falloff{}), "exp");
}

TEST(Falloff, UnknownNameListsTheKnownOnes) {
    for (const char* text : {"", "Exp", "square", "exp ", "pow", "linear:2"})
        EXPECT_INPUT_ERROR(parse_falloff(text), "step, linear, sqrt, cbrt, exp");
}

TEST(Falloff, BadParameterIsAnError) {
    for (const char* text : {"exp:", "exp:0", "exp:-1", "exp:nan", "pow:inf", "pow:0", "pow:1x", "pow:1e999"})
        EXPECT_INPUT_ERROR(parse_falloff(text), "must be a positive number");
}

TEST(MaxDistance, TextGivesUnitAndValue) {
    EXPECT_EQ(parse_max_distance("1.5").value, 1.5);
    EXPECT_EQ(parse_max_distance("1.5").unit, MaxDistance::Unit::metres);
    EXPECT_EQ(parse_max_distance("50%").value, 50);
    EXPECT_EQ(parse_max_distance("50%").unit, MaxDistance::Unit::percent);
    EXPECT_EQ(parse_max_distance("inf").unit, MaxDistance::Unit::infinite);
    for (const char* text : {"1.5", "50%", "inf"})
        EXPECT_EQ(max_distance_text(parse_max_distance(text)), text);
}

TEST(MaxDistance, NoPositiveLengthIsAnError) {
    for (const char* text : {"0", "-1", "nan", "", "%", "0%", "1m", "-inf", "1e999"})
        EXPECT_INPUT_ERROR(parse_max_distance(text), "expected a positive length");
}

Scene scene_within(const V3f& low, const V3f& high, double unit = 1) {
    Scene scene;
    scene.bounds = Box3f(low, high);
    scene.unit = unit;
    return scene;
}

TEST(MaxDistance, PercentIsOfTheDiagonal) {
    const Scene scene = scene_within({1, 1, 1}, {3, 4, 7});  // diagonal 7
    EXPECT_DOUBLE_EQ(resolve_max_distance(parse_max_distance("50%"), scene), 3.5);
    EXPECT_DOUBLE_EQ(resolve_max_distance(parse_max_distance("2"), scene), 2);
    EXPECT_TRUE(std::isinf(resolve_max_distance(parse_max_distance("inf"), scene)));
    EXPECT_INPUT_ERROR(resolve_max_distance(parse_max_distance("50%"), Scene()), "no extent");
    const Scene huge = scene_within({1, 1, 1}, {3, 4, 7}, 1024);
    EXPECT_DOUBLE_EQ(resolve_max_distance(parse_max_distance("50%"), huge), 3.5 * 1024);
}

TEST(MaxDistance, UnusualShareOfTheSceneWarns) {
    const Scene scene = scene_within({0, 0, 0}, {3, 4, 0});
    for (const auto& [text, warns] :
         {std::pair{"0.01", true}, {"1", false}, {"5", false}, {"6", true}, {"inf", false}}) {
        testing::internal::CaptureStderr();
        resolve_max_distance(parse_max_distance(text), scene);
        const std::string said = testing::internal::GetCapturedStderr();
        EXPECT_EQ(said.find("diagonal") != std::string::npos, warns) << text << ": " << said;
    }
}

TEST(MaxDistance, ReachBelowTheRoundingOfCoordinatesIsWarnedOf) {
    const Scene far = scene_within({9000, 0, 0}, {9010, 1, 1});
    const auto said_of = [&](const char* text) {
        testing::internal::CaptureStderr();
        resolve_max_distance(parse_max_distance(text), far);
        return testing::internal::GetCapturedStderr();
    };
    const std::string warning = "less than 1 % of the scene's farthest coordinate, 9010 m";
    EXPECT_EQ(said_of("91").find(warning), std::string::npos);
    EXPECT_NE(said_of("90").find(warning), std::string::npos);
}

}  // namespace
}  // namespace obscura
