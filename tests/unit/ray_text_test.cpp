// SPDX-License-Identifier: Apache-2.0
// Rays in reports: the file's coordinates wherever the scene was moved, and the same floats when read again.
#include "reference/ray_text.h"

#include "reference/hard_rays.h"
#include "reference/meshes.h"
#include "support/errors.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <sstream>
#include <vector>

namespace obscura {
namespace {

constexpr float INF = std::numeric_limits<float>::infinity();

std::vector<long double> numbers_of(const std::string& text) {
    std::vector<long double> numbers;
    std::istringstream words(text);
    for (std::string word; std::getline(words, word, ',');)
        numbers.push_back(std::stold(word));
    return numbers;
}

Scene framed(const V3d& origin, double unit) {
    Scene scene = icosphere(2);
    scene.origin = origin;
    scene.unit = unit;
    return scene;
}

TEST(RayText, UsualSceneHasTheDigitsOfFloats) {
    EXPECT_EQ(ray_text(Scene(), {{{0.1f, 1, 2}, {0, -1, 0}, INF}}), "0.100000001,1,2,0,-1,0,inf");
    EXPECT_EQ(ray_text(Scene(), {{{1, 2, 3}, {0, -1, 0}, 4}, V3f(0, 0.5f, 0)}), "1,2,3,0,-1,0,4,0,0.5,0");
    EXPECT_EQ(hit_text(Scene(), TraceHit{1, 0.5f, 0.25f, 7}), "triangle 7 at 1, u 0.5, v 0.25");
    EXPECT_EQ(hit_text(Scene(), TraceHit{1, 0, 0, NO_PRIMITIVE}), "no hit");
    EXPECT_EQ(hit_text(Scene(), BruteHit()), "no hit");
}

TEST(RayText, TellsTheFilesCoordinates) {
    const Scene moved = framed({1e6, 0, -3}, 1);
    EXPECT_EQ(ray_text(moved, {{{0.5f, 1, 2}, {0, -1, 0}, 4}}), "1000000.5,1,-1,0,-1,0,4");
    const Scene large = framed({0, 0, 0}, 1024);
    EXPECT_EQ(ray_text(large, {{{0.5f, 1, 2}, {0, -1, 0}, 4}}), "512,1024,2048,0,-1,0,4096");
    EXPECT_EQ(hit_text(large, TraceHit{0.5f, 0.5f, 0.25f, 7}), "triangle 7 at 512, u 0.5, v 0.25");
    BruteHit hit;
    hit.t = 0.5;
    hit.primitive = 7;
    hit.edge_distance = {1, 2, 3};
    EXPECT_EQ(hit_text(large, hit), "triangle 7 at 512, u 0, v 0, 1.02e+03 inside its nearest edge");
}

TEST(RayText, IsReadBackToTheBit) {
    for (const Scene& scene : {framed({0, 0, 0}, 1), framed({1e6, -3e5, 0}, 1), framed({0, 0, 0}, 0x1p-60),
                               framed({0x1p70, 0x1p66, 0x3p65}, 0x1p64)}) {
        for (TraceRay ray : random_rays(scene, 1000, 1)) {
            for (const float t_max : {INF, 0.1f}) {
                ray.t_max = t_max;
                const V3f start = 1e-5f * ray.direction;
                const std::string text = ray_text(scene, {ray, start});
                const GivenRay again = ray_of_numbers(scene, numbers_of(text));
                ASSERT_EQ(std::memcmp(&ray, &again.ray, sizeof ray), 0) << text << "\n"
                                                                        << ray_text(scene, again);
                ASSERT_EQ(again.start, start) << text;
                EXPECT_FALSE(ray_of_numbers(scene, numbers_of(ray_text(scene, {ray}))).start);
            }
        }
    }
}

TEST(RayText, RefusesWhatFloatsOrEmbreeCannotTrace) {
    constexpr long double ENDLESS = std::numeric_limits<long double>::infinity();
    constexpr long double NAN_VALUE = std::numeric_limits<long double>::quiet_NaN();
    const std::vector<std::vector<long double>> wrong{
        {3e18L, 0, 0, 0, 0, 1, 1},           {0, -ENDLESS, 0, 0, 0, 1, 1},
        {0, 0, NAN_VALUE, 0, 0, 1, 1},       {0, 0, 0, 0, 0, 0, 1},
        {0, 0, 0, 0, 0, 1e-38L, ENDLESS},    {0, 0, 0, 0, 3e18L, 0, ENDLESS},
        {0, 0, 0, 1, NAN_VALUE, 0, ENDLESS}, {0, 0, 0, 0, 0, 1, 0},
        {0, 0, 0, 0, 0, 1, NAN_VALUE},       {0, 0, 0, 0, 0, 1},
        {0, 0, 0, 0, 0, 1, 1, 0, 0},         {0, 0, 0, 0, 0, 1, 1, 0, 0, NAN_VALUE}};
    for (const std::vector<long double>& numbers : wrong)
        EXPECT_INPUT_ERROR(ray_of_numbers(Scene(), numbers), "--ray");
    // What counts is the scene's own frame.
    EXPECT_NO_THROW(ray_of_numbers(framed({0, 0, 0}, 0x1p64), {wrong[0]}));
    EXPECT_THROW(ray_of_numbers(framed({0, 0, 0}, 0x1p-60), std::vector<long double>{2, 0, 0, 0, 0, 1, 1}),
                 InputError);
    for (const long double length : {2e-18L, 0.9e18L})
        EXPECT_NO_THROW(
            ray_of_numbers(Scene(), std::vector<long double>{1e18L, 0, 0, 0, 0, length, ENDLESS}));
}

}  // namespace
}  // namespace obscura
