// SPDX-License-Identifier: Apache-2.0
// obscura merge: crops from files into one file, with a preview.
#include "cli/merge.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "film/image.h"
#include "support/command.h"
#include "support/errors.h"
#include "support/images.h"
#include "support/temporary_folder.h"

namespace obscura {
namespace {

using test::make_image;
using test::TemporaryFolder;

const std::vector<Layer> LAYERS = {{"", {"R", "G", "B", "A"}, {}}, {"ao", {"Y"}, {}}};

// A 10 x 8 picture in three crops.
std::vector<Image> make_parts() {
    return {make_image(10, 8, {0, 4, 0, 8}, LAYERS), make_image(10, 8, {4, 10, 0, 3}, LAYERS),
            make_image(10, 8, {4, 10, 3, 8}, LAYERS)};
}

class MergeCommand : public testing::Test {
  protected:
    // The parts are written to p0.exr, p1.exr, p2.exr; count of them are merged.
    test::CommandResult merge(size_t count, std::vector<std::string> options) const {
        const std::vector<Image> parts = make_parts();
        for (size_t i = count; i-- > 0;) {
            const std::string path = file("p" + std::to_string(i) + ".exr");
            write_exr(parts[i], path);
            options.insert(options.begin(), path);
        }
        options.insert(options.begin(), "merge");
        return test::run_command(add_merge_command, options);
    }
    std::string file(const std::string& name) const { return folder_.file(name); }

    TemporaryFolder folder_;
};

TEST_F(MergeCommand, WritesTheWholePicture) {
    const auto result = merge(3, {"-o", file("whole.exr")});
    EXPECT_EQ(result.exit_code, ExitCode::ok);
    EXPECT_NE(result.err.find("Merged 3 parts into"), std::string::npos) << result.err;
    const Image whole = make_image(10, 8, {0, 10, 0, 8}, LAYERS);
    EXPECT_EQ(read_exr(file("whole.exr")).layers[0].pixels, whole.layers[0].pixels);
}

TEST_F(MergeCommand, OnePartThatIsAllIsMerged) {
    write_exr(make_image(10, 8, {0, 10, 0, 8}, LAYERS), file("all.exr"));
    const auto result =
        test::run_command(add_merge_command, {"merge", file("all.exr"), "-o", file("whole.exr")});
    EXPECT_NE(result.err.find("Merged 1 part into"), std::string::npos) << result.err;
}

TEST_F(MergeCommand, PreviewAndExposureAreUsed) {
    merge(3, {"-o", file("a.exr"), "--preview", file("a.png")});
    merge(3, {"-o", file("b.exr"), "--preview", file("b.png"), "--exposure", "-8"});
    const test::Png plain = test::read_png(file("a.png"));
    const test::Png darker = test::read_png(file("b.png"));
    EXPECT_EQ(plain.width, 10u);
    EXPECT_LT(darker.at(9, 0)[0], plain.at(9, 0)[0]);
}

TEST_F(MergeCommand, FailuresWriteNothing) {
    EXPECT_INPUT_ERROR(merge(2, {"-o", file("whole.exr")}), "the parts leave 30 pixels");
    EXPECT_INPUT_ERROR(merge(3, {"-o", file("no/whole.exr")}), "does not exist");
    EXPECT_INPUT_ERROR(merge(3, {"-o", file("whole.exr"), "--preview", file("no/a.png")}), "does not exist");
    EXPECT_FALSE(std::filesystem::exists(file("whole.exr")));
    EXPECT_INPUT_ERROR(merge(3, {"-o", file("p1.exr")}), "p1.exr: it is the input");
    EXPECT_INPUT_ERROR(
        merge(3, {"-o", file("x"), "--preview", file("../") + folder_.path().filename().string() + "/x"}),
        "it is the same file as that of --output");
    EXPECT_THROW(merge(3, {"-o", "x", "--preview", "y", "--exposure", "nan"}), CLI::ValidationError);
    EXPECT_THROW(merge(3, {}), CLI::ParseError);
    EXPECT_THROW(merge(3, {"-o", file("whole.exr"), "--exposure", "1"}), CLI::ParseError);
}

}  // namespace
}  // namespace obscura
