// SPDX-License-Identifier: Apache-2.0
// Asks every OpenCL platform for its devices and every device for what obscura needs. A platform or device
// that answers with an error becomes a row that says so; it never hides the others.
#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <utility>

#include "base/error.h"
#include "device/error.h"
#include "device/opencl.h"
#include "device/selector.h"

namespace obscura {

namespace {

// Reads properties of one platform or device and remembers the first failure.
template <typename Object>
class Properties {
  public:
    explicit Properties(const Object& object) : object_(object) {}

    template <typename T>
    T get(cl_uint property) {
        T value{};
        const cl_int code = object_.getInfo(property, &value);
        if (code != CL_SUCCESS && first_failure_ == CL_SUCCESS) first_failure_ = code;
        return value;
    }
    cl_int first_failure() const { return first_failure_; }

  private:
    const Object& object_;
    cl_int first_failure_ = CL_SUCCESS;
};

// "OpenCL 1.2 pocl" and "OpenCL C 1.2 pocl" -> 102. 0 if the text is not of that form.
int version_number(const std::string& text) {
    const size_t digits = text.find_first_of("0123456789");
    int major = 0, minor = 0;
    if (digits == std::string::npos || std::sscanf(text.c_str() + digits, "%d.%d", &major, &minor) != 2)
        return 0;
    return 100 * major + minor;
}

// What obscura requires, in the order in which the first miss is reported. Empty if all is there.
std::string missing_requirement(Properties<cl::Device>& device, const DeviceInfo& info) {
    const auto profile = device.get<cl::string>(CL_DEVICE_PROFILE);
    const auto language = device.get<cl::string>(CL_DEVICE_OPENCL_C_VERSION);
    const auto address_bits = device.get<cl_uint>(CL_DEVICE_ADDRESS_BITS);
    const bool available = device.get<cl_bool>(CL_DEVICE_AVAILABLE) != CL_FALSE;
    const bool has_compiler = device.get<cl_bool>(CL_DEVICE_COMPILER_AVAILABLE) != CL_FALSE;
    const bool little_endian = device.get<cl_bool>(CL_DEVICE_ENDIAN_LITTLE) != CL_FALSE;

    if (device.first_failure() != CL_SUCCESS)
        return fmt::format("its driver fails when asked about it ({})", error_name(device.first_failure()));
    if (!available) return "the device is not available";
    if (version_number(info.opencl_version) < 102 || version_number(language) < 102)
        return fmt::format("OpenCL 1.2 is needed, the device has {} with {}", info.opencl_version, language);
    if (profile != "FULL_PROFILE")
        return fmt::format("OpenCL's full profile is needed, the device has {}", profile);
    if (!has_compiler) return "the driver has no compiler for kernels";
    if (address_bits != 64)
        return fmt::format("64-bit addresses are needed, the device has {} bits", address_bits);
    if (!little_endian) return "the device is big-endian";
    return {};
}

std::vector<std::string> float_features(cl_device_fp_config config) {
    constexpr std::pair<cl_device_fp_config, const char*> NAMES[] = {
        {CL_FP_DENORM, "denormals"},
        {CL_FP_INF_NAN, "infinity and NaN"},
        {CL_FP_ROUND_TO_NEAREST, "round to nearest"},
        {CL_FP_ROUND_TO_ZERO, "round to zero"},
        {CL_FP_ROUND_TO_INF, "round to infinity"},
        {CL_FP_FMA, "fma"},
        {CL_FP_SOFT_FLOAT, "in software"},
        {CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT, "correctly rounded division and square root"},
    };
    std::vector<std::string> features;
    for (const auto& [bit, name] : NAMES)
        if ((config & bit) != 0) features.emplace_back(name);
    return features;
}

// The kind of split that open_devices() asks for.
uint32_t max_sub_devices(Properties<cl::Device>& device) {
    const auto kinds = device.get<std::vector<cl_device_partition_property>>(CL_DEVICE_PARTITION_PROPERTIES);
    const bool by_counts = std::ranges::find(kinds, CL_DEVICE_PARTITION_BY_COUNTS) != kinds.end();
    const auto most = device.get<cl_uint>(CL_DEVICE_PARTITION_MAX_SUB_DEVICES);
    return by_counts && most > 1 ? most : 0;
}

DeviceInfo describe_device(const cl::Device& handle, const DeviceInfo& platform, int device_index) {
    Properties device(handle);
    DeviceInfo info = platform;
    info.device_index = device_index;
    info.name = device.get<cl::string>(CL_DEVICE_NAME);
    info.driver_version = device.get<cl::string>(CL_DRIVER_VERSION);
    info.opencl_version = device.get<cl::string>(CL_DEVICE_VERSION);
    info.compute_units = device.get<cl_uint>(CL_DEVICE_MAX_COMPUTE_UNITS);
    info.memory_bytes = device.get<cl_ulong>(CL_DEVICE_GLOBAL_MEM_SIZE);
    info.max_allocation_bytes = device.get<cl_ulong>(CL_DEVICE_MAX_MEM_ALLOC_SIZE);
    info.float_features = float_features(device.get<cl_device_fp_config>(CL_DEVICE_SINGLE_FP_CONFIG));
    info.is_cpu = (device.get<cl_device_type>(CL_DEVICE_TYPE) & CL_DEVICE_TYPE_CPU) != 0;
    info.reason = missing_requirement(device, info);
    info.usable = info.reason.empty();
    info.max_sub_devices = max_sub_devices(device);
    return info;
}

// The ICD loader drops drivers that it can't load without a word. This finds them: the library named in
// icd_file. Returns the reason, or nothing if the library loads.
std::string driver_load_failure(const std::filesystem::path& icd_file) {
    std::string library;
    std::getline(std::ifstream(icd_file) >> std::ws, library);
    library.erase(library.find_last_not_of(" \t\r\n") + 1);
    if (library.empty()) return "the file names no driver library";
    // It stays loaded: PoCL registers options with LLVM when it is loaded, and twice ends the program.
    void* const loaded = dlopen(library.c_str(), RTLD_LAZY | RTLD_LOCAL | RTLD_NODELETE);
    if (loaded == nullptr) return dlerror();
    const bool is_driver = dlsym(loaded, "clGetExtensionFunctionAddress") != nullptr;
    dlclose(loaded);
    return is_driver ? "" : fmt::format("{} is no OpenCL driver", library);
}

// One row per driver file that the loader had to skip.
void append_broken_drivers(std::vector<DeviceInfo>& rows) {
    namespace fs = std::filesystem;
    const char* const vendors = std::getenv("OCL_ICD_VENDORS");
    const fs::path place = vendors != nullptr && *vendors != '\0' ? vendors : "/etc/OpenCL/vendors";
    std::error_code ignored;
    std::vector<fs::path> files;
    if (place.extension() == ".icd") files.push_back(place);
    for (fs::directory_iterator entry(place, ignored), end; entry != end; entry.increment(ignored))
        if (entry->path().extension() == ".icd") files.push_back(entry->path());

    for (const fs::path& file : files) {
        const std::string failure = driver_load_failure(file);
        if (failure.empty()) continue;
        DeviceInfo row;
        row.platform = file.string();
        row.reason = fmt::format("the driver can't be loaded: {}", failure);
        rows.push_back(std::move(row));
    }
}

std::string no_device_reason(const DeviceInfo& platform) {
    // PoCL hides its devices when it can't write to its cache.
    if (platform.platform == POCL_PLATFORM_NAME)
        return "the platform has no device; PoCL needs a folder to write to (POCL_CACHE_DIR, else "
               "~/.cache/pocl)";
    return "the platform has no device";
}

}  // namespace

std::vector<DeviceInfo> list_devices() {
    std::vector<DeviceInfo> rows;
    std::vector<cl::Platform> platforms;
    const cl_int found = cl::Platform::get(&platforms);
    int next_index = 0;
    for (size_t p = 0; p < platforms.size(); ++p) {
        Properties platform(platforms[p]);
        DeviceInfo row;
        row.platform_index = static_cast<int>(p);
        row.platform = platform.get<cl::string>(CL_PLATFORM_NAME);
        row.platform_version = platform.get<cl::string>(CL_PLATFORM_VERSION);

        std::vector<cl::Device> devices;
        const cl_int code = platforms[p].getDevices(CL_DEVICE_TYPE_ALL, &devices);
        for (size_t d = 0; d < devices.size(); ++d) {
            rows.push_back(describe_device(devices[d], row, static_cast<int>(d)));
            rows.back().index = next_index++;
        }
        if (devices.empty()) {
            row.reason = code == CL_SUCCESS || code == CL_DEVICE_NOT_FOUND
                             ? no_device_reason(row)
                             : fmt::format("the platform's driver fails with {}", error_name(code));
            rows.push_back(std::move(row));
        }
    }
    append_broken_drivers(rows);
    if (rows.empty()) {
        DeviceInfo row;
        row.platform = "no platform";
        row.reason =
            fmt::format("no OpenCL driver is installed ({}); PoCL runs on any processor", error_name(found));
        rows.push_back(std::move(row));
    }
    return rows;
}

}  // namespace obscura
