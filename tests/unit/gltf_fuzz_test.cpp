// SPDX-License-Identifier: Apache-2.0
// One small file with everything that the glTF reader follows, broken in every place: whatever the change, it
// is read or refused with an InputError. Under the address sanitizer this finds reads out of bounds.
#include "scene/gltf.h"

#include "scene/radiometry.h"
#include "support/errors.h"
#include "support/gltf_builder.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

namespace obscura {
namespace {

using test::rich_file;
using test::TemporaryFolder;

// Loads a mutated file; whatever loads must also be usable.
void expect_loads_or_refuses(const std::string& path) {
    try {
        const Scene scene = load_gltf(path);
        compute_radiometry(scene);
    } catch (const InputError& error) {
        EXPECT_FALSE(std::string(error.what()).empty());
    }
}

TEST(GltfFuzz, RichFileIsValid) {
    const TemporaryFolder folder;
    const Scene scene = load_gltf(rich_file().write_glb(folder.file("a.glb")));
    EXPECT_EQ(scene.triangles.size(), 2u);
    EXPECT_EQ(scene.textures.size(), 1u);
    EXPECT_EQ(scene.lights.size(), 1u);
    EXPECT_FLOAT_EQ(scene.bounds.min.z, -0.5f);  // from the sparse vertex
}

TEST(GltfFuzz, EveryTruncationLoadsOrIsRefused) {
    const TemporaryFolder folder;
    const std::vector<uint8_t> binary = rich_file().glb_bytes();
    const std::string text = rich_file().gltf_text();
    const std::string path = folder.file("fuzzed.glb");
    testing::internal::CaptureStderr();
    for (size_t size = 0; size < binary.size(); ++size) {
        test::write_file(path, {binary.begin(), binary.begin() + static_cast<std::ptrdiff_t>(size)});
        EXPECT_THROW(load_gltf(path), InputError) << size;
    }
    for (size_t size = 0; size < text.size(); ++size) {
        test::write_file(path, {text.begin(), text.begin() + static_cast<std::ptrdiff_t>(size)});
        EXPECT_THROW(load_gltf(path), InputError) << size;
    }
    testing::internal::GetCapturedStderr();
}

TEST(GltfFuzz, EveryChangedByteLoadsOrIsRefused) {
    const TemporaryFolder folder;
    const std::string text = rich_file().gltf_text();
    const std::string path = folder.file("fuzzed.glb");
    testing::internal::CaptureStderr();
    for (const std::vector<uint8_t>& good : {rich_file().glb_bytes(), {text.begin(), text.end()}}) {
        for (size_t i = 0; i < good.size(); ++i) {
            for (const int change : {0x01, 0x80, 0x10}) {
                std::vector<uint8_t> bytes = good;
                bytes[i] = static_cast<uint8_t>(bytes[i] ^ change);
                test::write_file(path, bytes);
                expect_loads_or_refuses(path);
            }
        }
    }
    testing::internal::GetCapturedStderr();
}

// Digits are what offsets, counts and indices are made of.
TEST(GltfFuzz, EveryChangedNumberLoadsOrIsRefused) {
    const TemporaryFolder folder;
    const std::string good = rich_file().gltf_text();
    const std::string path = folder.file("fuzzed.gltf");
    testing::internal::CaptureStderr();
    for (size_t i = 0; i < good.size(); ++i) {
        if (good[i] < '0' || good[i] > '9' || (i > 0 && good[i - 1] >= '0' && good[i - 1] <= '9')) continue;
        size_t end = i;
        while (good[end] >= '0' && good[end] <= '9')
            ++end;
        for (const char* number : {"-1", "0", "1", "3", "255", "5126", "65536", "2147483647", "2147483648",
                                   "4294967295", "18446744073709551615", "1e300", "null", "\"x\"", "[]"}) {
            const std::string text = good.substr(0, i) + number + good.substr(end);
            test::write_file(path, {text.begin(), text.end()});
            expect_loads_or_refuses(path);
        }
    }
    testing::internal::GetCapturedStderr();
}

}  // namespace
}  // namespace obscura
