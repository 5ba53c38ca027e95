// SPDX-License-Identifier: Apache-2.0
// From kernel source to kernel: embedding, includes, build errors, and a cache that survives what disks do to
// it.
#include "device/program.h"

#include <algorithm>
#include <fstream>

#include "base/error.h"
#include "base/file.h"
#include "device/kernel_source.h"
#include "device/launch.h"
#include "support/device.h"
#include "support/temporary_folder.h"

namespace obscura {
namespace {

using test::ScopedVariable;
namespace fs = std::filesystem;

constexpr const char* SCALE_SOURCE = R"(#include "lib/factor.clh"
kernel void scale(global float* values, uint count) {
    const uint i = (uint)get_global_id(0);
    if (i >= count)
        return;
    values[i] *= factor();
}
)";

// A folder of kernels and a cache of its own, in place of the user's.
class KernelFolder {
  public:
    KernelFolder() {
        fs::create_directories(path("lib"));
        write("scale.cl", SCALE_SOURCE);
        write("lib/factor.clh", "inline float factor(void) {\n    return 3.0f;\n}\n");
    }
    fs::path path(const std::string& name) const { return folder_.path() / "kernels" / name; }
    fs::path cache() const { return folder_.path() / "cache"; }
    void write(const std::string& name, const std::string& text) const { write_text(path(name), text); }

    // The cache's only entry.
    fs::path cache_entry() const {
        const auto paths = cache_entries();
        OBSCURA_CHECK(paths.size() == 1, "{} entries", paths.size());
        return paths.front();
    }
    std::vector<fs::path> cache_entries() const {
        std::vector<fs::path> paths;
        for (const auto& entry : fs::directory_iterator(cache()))
            paths.push_back(entry.path());
        return paths;
    }

  private:
    test::TemporaryFolder folder_;
    ScopedVariable kernels_{"OBSCURA_KERNEL_DIR", path("").string()};
    ScopedVariable cache_variable_{"OBSCURA_CACHE_DIR", cache().string()};
};

class ProgramLibraryOnDevice : public test::DeviceTest {
  protected:
    // What the kernel "scale" makes of 2.
    float scaled_two(ProgramLibrary& library, const std::string& options = {}) {
        const cl::Kernel kernel = library.kernel("scale", options);
        const Buffer buffer = Buffer::holding(device(), "values", "scene", std::vector<float>{2.0f});
        launch(device(), kernel, "scale", 1, library.local_size(), buffer, 1u);
        return buffer.contents<float>().front();
    }

    void expect_rebuilt_and_replaced(const KernelFolder& folder) {
        ProgramLibrary rebuilding(device());
        EXPECT_EQ(scaled_two(rebuilding), 6.0f);
        EXPECT_EQ(rebuilding.compiled_count(), 1);
        EXPECT_EQ(rebuilding.cache_hit_count(), 0);
        ProgramLibrary reading(device());
        EXPECT_EQ(scaled_two(reading), 6.0f);
        EXPECT_EQ(reading.compiled_count(), 0);
        EXPECT_EQ(reading.cache_hit_count(), 1);
        EXPECT_EQ(folder.cache_entries().size(), 1u);
    }
};

template <typename Error, typename Function>
std::string message_of(Function function) {
    try {
        function();
    } catch (const Error& error) {
        return error.what();
    }
    return "no such exception";
}

TEST(KernelSource, EmbeddedFilesAreThoseOfTheFolder) {
    const fs::path folder = fs::path(OBSCURA_SOURCE_DIR) / "kernels";
    size_t count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file() || entry.path().extension() == ".md") continue;
        ++count;
        EXPECT_EQ(kernel_text(fs::relative(entry.path(), folder).string()), read_text(entry.path()));
    }
    EXPECT_EQ(embedded_kernel_files().size(), count);
    EXPECT_TRUE(std::ranges::is_sorted(embedded_kernel_files(), {}, &EmbeddedFile::path));
}

TEST(KernelSource, IncludesAreExpandedWithLineDirectives) {
    const KernelFolder folder;
    folder.write("lib/outer.clh",
                 "int before;\n  #  include \"lib/factor.clh\" // twice nested\nint after;\n");
    EXPECT_EQ(expand_kernel_text("test", "#include <cstdint>\n#include \"lib/outer.clh\"\nint last;"),
              "#line 1 \"test\"\n#include <cstdint>\n"
              "#line 1 \"kernels/lib/outer.clh\"\nint before;\n"
              "#line 1 \"kernels/lib/factor.clh\"\ninline float factor(void) {\n    return 3.0f;\n}\n"
              "#line 3 \"kernels/lib/outer.clh\"\nint after;\n"
              "#line 3 \"test\"\nint last;\n");
}

TEST(KernelSource, MissingIncludeNamesFileAndLine) {
    const KernelFolder folder;
    folder.write("scale.cl", "\n\n#include \"lib/absent.clh\"\n");
    EXPECT_EQ(message_of<InputError>([] { expand_kernel_file("scale.cl"); }),
              "kernels/scale.cl:3: there is no \"lib/absent.clh\" to include.");
}

TEST(KernelSource, FileThatIncludesItselfIsRefused) {
    const KernelFolder folder;
    folder.write("lib/a.clh", "#include \"lib/b.clh\"\n");
    folder.write("lib/b.clh", "\n#include \"lib/a.clh\"\n");
    EXPECT_EQ(message_of<InputError>([] { expand_kernel_text("test", "#include \"lib/a.clh\"\n"); }),
              "kernels/lib/b.clh:2: \"lib/a.clh\" includes itself.");
}

TEST(KernelSource, UnknownEmbeddedFileIsRefused) {
    EXPECT_NE(
        message_of<InputError>([] { kernel_text("no_such_stage.cl"); }).find("kernels/no_such_stage.cl"),
        std::string::npos);
}

TEST(ProgramCacheHash, EqualsPublishedValuesOfFnv1a128) {
    EXPECT_EQ(hash_text(""), "6c62272e07bb014262b821756295c58d");
    EXPECT_EQ(hash_text("a"), "d228cb696f1a8caf78912b704e4a8964");
    EXPECT_EQ(hash_text("foobar"), "343e1662793c64bf6f0d3597ba446f18");
}

TEST_F(ProgramLibraryOnDevice, KernelFromFolderRuns) {
    const KernelFolder folder;
    ProgramLibrary library(device());
    EXPECT_EQ(scaled_two(library), 6.0f);
    EXPECT_EQ(library.compiled_count(), 1);
}

TEST_F(ProgramLibraryOnDevice, SecondLibraryTakesProgramFromCache) {
    const KernelFolder folder;
    expect_rebuilt_and_replaced(folder);
}

TEST_F(ProgramLibraryOnDevice, SecondRequestTakesProgramFromMemory) {
    const KernelFolder folder;
    ProgramLibrary library(device());
    scaled_two(library);
    fs::remove_all(folder.cache());
    EXPECT_EQ(scaled_two(library), 6.0f);
    EXPECT_EQ(library.compiled_count(), 1);
    EXPECT_EQ(library.cache_hit_count(), 0);
}

TEST_F(ProgramLibraryOnDevice, SourceHeaderOptionAndLocalSizeEachGiveAnEntry) {
    const KernelFolder folder;
    ProgramLibrary first(device());
    scaled_two(first);
    EXPECT_EQ(scaled_two(first, "-D FEATURE_UNUSED"), 6.0f);
    EXPECT_EQ(folder.cache_entries().size(), 2u);
    folder.write("lib/factor.clh", "inline float factor(void) { return 4.0f; }\n");
    ProgramLibrary second(device());
    EXPECT_EQ(scaled_two(second), 8.0f);
    EXPECT_EQ(folder.cache_entries().size(), 3u);
    ProgramLibrary third(device(), 16);
    EXPECT_EQ(scaled_two(third), 8.0f);
    EXPECT_EQ(folder.cache_entries().size(), 4u);
}

TEST_F(ProgramLibraryOnDevice, DamagedCacheEntryIsRebuiltAndReplaced) {
    const KernelFolder folder;
    ProgramLibrary library(device());
    scaled_two(library);
    const fs::path entry = folder.cache_entry();
    const std::string whole = read_text(entry);
    std::string flipped = whole;
    flipped[whole.size() / 2] = static_cast<char>(flipped[whole.size() / 2] ^ 1);
    for (const std::string& damaged : {std::string(), whole.substr(0, 20), whole.substr(0, whole.size() - 1),
                                       whole + "x", flipped, std::string(whole.size(), '\0')}) {
        std::ofstream(entry, std::ios::binary) << damaged;
        expect_rebuilt_and_replaced(folder);
    }
}

TEST_F(ProgramLibraryOnDevice, CacheEntryOfAnotherKeyIsRebuilt) {
    const KernelFolder folder;
    ProgramLibrary library(device());
    scaled_two(library);
    const fs::path entry = folder.cache_entry();
    scaled_two(library, "-D FEATURE_UNUSED");
    for (const fs::path& other : folder.cache_entries())
        if (other != entry) fs::rename(other, entry);
    expect_rebuilt_and_replaced(folder);
}

TEST_F(ProgramLibraryOnDevice, WholeEntryThatTheDriverRefusesIsRebuilt) {
    const KernelFolder folder;
    ProgramLibrary library(device());
    scaled_two(library);
    const std::string key = folder.cache_entry().stem().string();
    const std::string garbage = "no program of any driver";
    ProgramCache(folder.cache())
        .store(key, {reinterpret_cast<const unsigned char*>(garbage.data()), garbage.size()});
    expect_rebuilt_and_replaced(folder);
}

TEST_F(ProgramLibraryOnDevice, UnusableCacheFolderIsOneWarning) {
    const KernelFolder folder;
    write_text(folder.cache(), "a file where the folder should be");
    testing::internal::CaptureStderr();
    ProgramLibrary library(device());
    EXPECT_EQ(scaled_two(library), 6.0f);
    EXPECT_EQ(scaled_two(library, "-D FEATURE_UNUSED"), 6.0f);
    const std::string output = testing::internal::GetCapturedStderr();
    const size_t first = output.find("can't be kept for the next start");
    EXPECT_NE(first, std::string::npos) << output;
    EXPECT_EQ(output.find("can't be kept for the next start", first + 1), std::string::npos) << output;
}

TEST_F(ProgramLibraryOnDevice, PrepareCountsWhatIsNotCached) {
    const KernelFolder folder;
    ProgramLibrary(device()).kernel("scale");
    folder.write("other.cl", "kernel void other(uint count) {}\n");
    const std::vector<KernelRequest> requests = {
        {.stage = "other"},
        {.stage = "scale"},
        {.stage = "scale", .options = "-D FEATURE_UNUSED"},
        {.stage = "other"},
        {.stage = "again", .file = "other.cl", .kernel = "other"},
    };
    testing::internal::CaptureStderr();
    ProgramLibrary library(device());
    EXPECT_EQ(library.kernels(requests).size(), requests.size());
    const std::string output = testing::internal::GetCapturedStderr();
    EXPECT_NE(output.find("compiling kernel 1 of 2 (other) ... "), std::string::npos) << output;
    EXPECT_NE(output.find("compiling kernel 2 of 2 (scale) ... "), std::string::npos) << output;
    EXPECT_EQ(library.compiled_count(), 2);
    EXPECT_EQ(library.cache_hit_count(), 1);
}

// Clang under PoCL writes "1 warning generated." to stderr, in the middle of the line that tells the progress.
TEST_F(ProgramLibraryOnDevice, WarningsOfACompilerAreNotForUsers) {
    const KernelFolder folder;
    // The folder's name makes it a program that PoCL's own cache doesn't have.
    folder.write("other.cl", "// " + folder.path("").string() +
                                 "\nkernel void other(uint count) {\n    if (count = 1u) return;\n}\n");
    testing::internal::CaptureStderr();
    ProgramLibrary(device()).kernel("other");
    const std::string output = testing::internal::GetCapturedStderr();
    EXPECT_EQ(output.find("warning"), std::string::npos) << output;
}

TEST_F(ProgramLibraryOnDevice, BuildErrorNamesStageFileAndLine) {
    const KernelFolder folder;
    folder.write("lib/factor.clh", "inline float factor(void) {\n    return three;\n}\n");
    const std::string message = message_of<DeviceError>([&] { ProgramLibrary(device()).kernel("scale"); });
    EXPECT_NE(message.find("scale: clBuildProgram failed with CL_BUILD_PROGRAM_FAILURE"), std::string::npos)
        << message;
    EXPECT_NE(message.find("kernels/lib/factor.clh:2"), std::string::npos) << message;
    EXPECT_NE(message.find("three"), std::string::npos) << message;
}

TEST_F(ProgramLibraryOnDevice, WrongKernelNameIsADeviceError) {
    const KernelFolder folder;
    const std::string message = message_of<DeviceError>(
        [&] { ProgramLibrary(device()).kernel(KernelRequest{.stage = "scale", .kernel = "grow"}); });
    EXPECT_NE(message.find("scale: clCreateKernel of \"grow\" failed with CL_INVALID_KERNEL_NAME"),
              std::string::npos)
        << message;
}

// Without a folder of its own: the process that dies, which starts from the test's beginning, would leave it behind.
TEST_F(ProgramLibraryOnDevice, InexactArithmeticAborts) {
    ProgramLibrary library(device());
    EXPECT_DEATH(library.kernel("film", "-cl-fast-relaxed-math"), "never built with");
}

}  // namespace
}  // namespace obscura
