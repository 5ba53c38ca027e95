// SPDX-License-Identifier: Apache-2.0
// obscura compare: the table, the JSON, the heat map, and the exit code that scripts rely on.
#include "cli/compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/file.h"
#include "film/attributes.h"
#include "support/command.h"
#include "support/errors.h"
#include "support/images.h"
#include "support/temporary_folder.h"

namespace obscura {
namespace {

using test::make_row;
using test::TemporaryFolder;

// Two files: beauty differs by 0.25 in one of six values, ao by 0.5 everywhere, N not at all.
class CompareCommand : public testing::Test {
  protected:
    CompareCommand() {
        reference_ = make_row({{0.5f, 0.5f, 0.5f}, {0, 0, 0}});
        reference_.layers.push_back({"N", {"X"}, {1, 1}});
        reference_.layers.push_back({"ao", {"Y"}, {0.25f, 0.25f}});
        image_ = reference_;
        image_.layers[0].pixels[0] = 0.75f;
        image_.layers[2].pixels = {0.75f, 0.75f};
    }

    test::CommandResult compare(std::vector<std::string> options = {}) const {
        write_exr(image_, file("a.exr"));
        write_exr(reference_, file("b.exr"));
        options.insert(options.begin(), {"compare", file("a.exr"), file("b.exr")});
        return test::run_command(add_compare_command, options);
    }
    std::string file(const std::string& name) const { return folder_.file(name); }

    TemporaryFolder folder_;
    Image image_;
    Image reference_;
};

TEST_F(CompareCommand, IdenticalImagesGiveExitCodeZero) {
    image_ = reference_;
    const auto result = compare();
    EXPECT_EQ(result.exit_code, ExitCode::ok);
    EXPECT_NE(result.out.find("The images are bit-identical."), std::string::npos) << result.out;
    EXPECT_EQ(result.err, "");
}

TEST_F(CompareCommand, OneDifferentBitGivesExitCodeOne) {
    image_ = reference_;
    image_.layers[2].pixels[1] = std::nextafter(0.25f, 1.0f);
    const auto result = compare();
    EXPECT_EQ(result.exit_code, ExitCode::check_failed);
    EXPECT_NE(result.out.find("The images differ."), std::string::npos) << result.out;
}

TEST_F(CompareCommand, TableHasARowForEachLayer) {
    const auto result = compare();
    EXPECT_EQ(result.exit_code, ExitCode::check_failed);
    EXPECT_NE(
        result.out.find("beauty         no        0.25      0.1021     0.04006      0.0817           0"),
        std::string::npos)
        << result.out;
    EXPECT_NE(result.out.find("N             yes           0"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("ao             no         0.5         0.5"), std::string::npos) << result.out;
}

TEST_F(CompareCommand, LayerBoundAndMetricDecideTheExitCode) {
    EXPECT_EQ(compare({"--layer", "N"}).exit_code, ExitCode::ok);
    EXPECT_EQ(compare({"--layer", "beauty"}).exit_code, ExitCode::check_failed);
    EXPECT_EQ(compare({"--layer", "beauty", "--bound", "0.11"}).exit_code, ExitCode::ok);  // rmse 0.102
    EXPECT_EQ(compare({"--layer", "beauty", "--bound", "0.09"}).exit_code, ExitCode::check_failed);
    EXPECT_EQ(compare({"--layer", "beauty", "--bound", "0.2", "--metric", "max_abs"}).exit_code,
              ExitCode::check_failed);
    EXPECT_EQ(compare({"--layer", "beauty", "--bound", "0.05", "--metric", "relmse"}).exit_code,
              ExitCode::ok);
    EXPECT_EQ(compare({"--layer", "beauty", "--bound", "0.05", "--metric", "mape"}).exit_code,
              ExitCode::check_failed);
    EXPECT_EQ(compare({"--bound", "0.49"}).exit_code, ExitCode::check_failed);  // ao: 0.5
    const auto result = compare({"--layer", "all", "--bound", "0.5"});
    EXPECT_EQ(result.exit_code, ExitCode::ok);
    EXPECT_NE(result.out.find("within the bound"), std::string::npos) << result.out;
}

TEST_F(CompareCommand, JsonHasTheHeadlineAndEveryLayer) {
    const auto result = compare({"--json", "-"});
    EXPECT_EQ(result.exit_code, ExitCode::check_failed);
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json.at("identical"), false);
    EXPECT_EQ(json.at("layer"), "beauty");
    EXPECT_DOUBLE_EQ(json.at("max_abs"), 0.25);
    EXPECT_DOUBLE_EQ(json.at("rmse"), 0.25 / std::sqrt(6));
    EXPECT_DOUBLE_EQ(json.at("relmse"), 0.0625 / 0.26 / 6);
    EXPECT_DOUBLE_EQ(json.at("mape"), 0.25 / 0.51 / 6);
    EXPECT_DOUBLE_EQ(std::abs(json.at("bias").get<double>()), 0.25 / 6);
    EXPECT_EQ(json.at("pixels"), 2u);
    EXPECT_EQ(json.at("differing_pixels"), 1u);
    EXPECT_EQ(json.at("within_bound"), false);
    EXPECT_EQ(json.at("layers").size(), 3u);
    EXPECT_EQ(json.at("layers").at("N").at("identical"), true);
    EXPECT_DOUBLE_EQ(json.at("layers").at("ao").at("rmse"), 0.5);

    const auto quiet = compare({"--json", file("out.json"), "--layer", "ao"});
    EXPECT_EQ(quiet.out, "");
    const auto ao = nlohmann::json::parse(read_text(file("out.json")));
    EXPECT_EQ(ao.at("layer"), "ao");
    EXPECT_DOUBLE_EQ(ao.at("max_abs"), 0.5);
    EXPECT_EQ(ao.at("layers").size(), 1u);
}

TEST_F(CompareCommand, HeatMapShowsTheChosenLayer) {
    compare({"--heatmap", file("beauty.png")});
    compare({"--heatmap", file("n.png"), "--layer", "N"});
    const test::Png beauty = test::read_png(file("beauty.png"));
    EXPECT_NE(beauty.at(0, 0), beauty.at(1, 0));
    const test::Png normals = test::read_png(file("n.png"));
    EXPECT_EQ(normals.at(0, 0), normals.at(1, 0));
}

TEST_F(CompareCommand, BeautyIsFoundAmongBlendersNames) {
    image_.layers[0].name = BLENDER_BEAUTY;
    const auto layer = compare({"--layer", "beauty", "--json", "-"});  // against the unnamed layer
    EXPECT_EQ(nlohmann::json::parse(layer.out).at("max_abs"), 0.25);
    reference_.layers[0].name = BLENDER_BEAUTY;
    reference_.layers.push_back({"ViewLayer.AO", {"R"}, {0, 0}});  // stands before Combined in the file
    image_.layers.push_back({"ViewLayer.AO", {"R"}, {1, 1}});
    const auto all = nlohmann::json::parse(compare({"--json", "-", "--heatmap", file("all.png")}).out);
    EXPECT_EQ(all.at("layer"), BLENDER_BEAUTY);
    EXPECT_EQ(all.at("max_abs"), 0.25);
    compare({"--layer", "beauty", "--heatmap", file("beauty.png")});
    EXPECT_EQ(test::read_png(file("all.png")).rgba, test::read_png(file("beauty.png")).rgba);
}

TEST_F(CompareCommand, ImagesOfDifferentSizeOrCropAreRefused) {
    reference_ = make_row({{0, 0, 0}});
    EXPECT_INPUT_ERROR(compare(), "a.exr: it is 2 x 1 pixels, but ");
    const std::vector<Layer> layers = {{"", {"R"}, {}}};
    image_ = test::make_image(4, 4, {0, 2, 0, 2}, layers);
    reference_ = test::make_image(4, 4, {2, 4, 0, 2}, layers);
    EXPECT_INPUT_ERROR(compare(), "a.exr: it holds the crop [0, 2) x [0, 2), but ");
}

TEST_F(CompareCommand, DifferentSeedsSamplesAndChannelsAreWarnedOf) {
    image_.attributes = {{attribute::SEED, int64_t{1}}, {attribute::SPP, int64_t{8}}};
    reference_.attributes = {{attribute::SEED, int64_t{2}}};
    reference_.layers.pop_back();
    const auto result = compare();
    EXPECT_NE(result.err.find("seed is 1 in " + file("a.exr") + " and 2 in "), std::string::npos)
        << result.err;
    EXPECT_NE(result.err.find("samplesPerPixel is 8 in " + file("a.exr") + " and not known in "),
              std::string::npos)
        << result.err;
    EXPECT_NE(result.err.find("Only " + file("a.exr") + " has the channel ao.Y, "), std::string::npos)
        << result.err;
}

TEST_F(CompareCommand, ImagesWithDifferentLayersAreNeitherIdenticalNorWithinABound) {
    image_ = reference_;
    image_.layers.pop_back();
    const auto result = compare({"--json", "-"});
    EXPECT_EQ(result.exit_code, ExitCode::check_failed);
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json.at("identical"), false);
    EXPECT_EQ(json.at("within_bound"), false);
    EXPECT_EQ(json.at("only_in_reference"), nlohmann::json{"ao.Y"});
    EXPECT_EQ(compare({"--bound", "1"}).exit_code, ExitCode::check_failed);
    EXPECT_NE(compare().out.find("they have different channels"), std::string::npos);
    EXPECT_EQ(compare({"--layer", "N"}).exit_code, ExitCode::ok);  // both have it

    image_ = reference_;
    image_.layers[0].channels[2] = "A";  // of a chosen layer, what both have is held to a bound
    EXPECT_EQ(compare({"--layer", "beauty"}).exit_code, ExitCode::check_failed);
    EXPECT_EQ(compare({"--layer", "beauty", "--bound", "1e-6"}).exit_code, ExitCode::ok);
}

TEST_F(CompareCommand, WrongOptionsAreRefused) {
    EXPECT_INPUT_ERROR(compare({"--layer", "nope"}), "a.exr: it has no layer nope, only beauty, N, ao");
    for (const char* bound : {"-1", "nan", "inf"})
        EXPECT_THROW(compare({"--bound", bound}), CLI::ValidationError) << bound;
    EXPECT_INPUT_ERROR(compare({"--heatmap", file("a.exr")}), "it is the input");
    EXPECT_INPUT_ERROR(compare({"--heatmap", file("x"), "--json", file("x")}),
                       "the same file as that of --heatmap");
    EXPECT_THROW(compare({"--metric", "psnr"}), CLI::ParseError);
    EXPECT_INPUT_ERROR(compare({"--json", file("no/out.json")}), "does not exist");
    image_.layers = {{"direct", {"R"}, {1, 1}}};
    EXPECT_INPUT_ERROR(compare(), "it has no channel in common with ");
}

}  // namespace
}  // namespace obscura
