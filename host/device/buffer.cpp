// SPDX-License-Identifier: Apache-2.0
// See buffer.h.
#include "device/buffer.h"

#include <sys/mman.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "base/error.h"
#include "base/units.h"
#include "device/error.h"

namespace obscura {

namespace {

// What an empty buffer holds, so that it has a handle.
constexpr uint64_t SMALLEST_ALLOCATION_BYTES = 16;

uint64_t allocation_bytes(uint64_t bytes) {
    return std::max(bytes, SMALLEST_ALLOCATION_BYTES);
}

// Of x86-64 and of most ARM systems.
constexpr uint64_t HUGE_PAGE_BYTES = 2u << 20u;

// Asks the system for huge pages under a buffer whose memory is the host's own and not yet touched. Everything works without
// them, too, so nothing that fails here is an error.
void ask_for_huge_pages(const Device& device, const cl::Buffer& buffer, uint64_t bytes) {
#ifdef MADV_HUGEPAGE
    if (!device.info().is_cpu || bytes < 2 * HUGE_PAGE_BYTES) return;
    cl_int code = CL_SUCCESS;
    void* const memory = device.queue().enqueueMapBuffer(buffer, CL_TRUE, CL_MAP_WRITE_INVALIDATE_REGION, 0,
                                                         bytes, nullptr, nullptr, &code);
    if (code != CL_SUCCESS) return;
    void* start = memory;
    size_t room = bytes;
    std::align(HUGE_PAGE_BYTES, HUGE_PAGE_BYTES, start, room);
    madvise(start, room / HUGE_PAGE_BYTES * HUGE_PAGE_BYTES, MADV_HUGEPAGE);
    device.queue().enqueueUnmapMemObject(buffer, memory);
#endif
}

}  // namespace

Buffer::Buffer(Device& device, std::string name, std::string category, uint64_t bytes, Pages pages)
    : name_(std::move(name)), category_(std::move(category)), bytes_(bytes) {
    const DeviceInfo& info = device.info();
    if (bytes > info.max_allocation_bytes)
        throw DeviceError(
            "The buffer \"{}\" needs {} ({} bytes), but {} allows at most {} ({} bytes) in one buffer.",
            name_, bytes_text(bytes), bytes, device.name(), bytes_text(info.max_allocation_bytes),
            info.max_allocation_bytes);
    cl_int code = CL_SUCCESS;
    handle_ = cl::Buffer(device.context(), CL_MEM_READ_WRITE, allocation_bytes(bytes), nullptr, &code);
    if (code != CL_SUCCESS)
        throw DeviceError(
            "The buffer \"{}\" of {} can't be allocated on {} ({} are in use): clCreateBuffer failed with {} "
            "({}).",
            name_, bytes_text(bytes), device.name(), bytes_text(device.memory().current_bytes()),
            error_name(code), code);
    if (pages == Pages::huge) ask_for_huge_pages(device, handle_, bytes);
    device_ = &device;
    device.memory().add(category_, allocation_bytes(bytes));
}

Buffer::~Buffer() {
    release();
}

Buffer::Buffer(Buffer&& other) noexcept
    : device_(std::exchange(other.device_, nullptr)),
      name_(std::move(other.name_)),
      category_(std::move(other.category_)),
      bytes_(std::exchange(other.bytes_, 0)),
      handle_(std::exchange(other.handle_, cl::Buffer())) {}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
    if (this != &other) {
        release();
        device_ = std::exchange(other.device_, nullptr);
        name_ = std::move(other.name_);
        category_ = std::move(other.category_);
        bytes_ = std::exchange(other.bytes_, 0);
        handle_ = std::exchange(other.handle_, cl::Buffer());
    }
    return *this;
}

void Buffer::release() noexcept {
    if (device_ != nullptr) device_->memory().remove(category_, allocation_bytes(bytes_));
    device_ = nullptr;
    handle_ = cl::Buffer();
}

void Buffer::check_range(uint64_t offset, uint64_t size) const {
    OBSCURA_CHECK(device_ != nullptr, "buffer without memory");
    OBSCURA_CHECK(offset <= bytes_ && size <= bytes_ - offset, "buffer \"{}\" of {} bytes, range {} + {}",
                  name_, bytes_, offset, size);
}

cl::Event* Buffer::event_if_logged(cl::Event& event) const {
    return device_->commands() != nullptr ? &event : nullptr;
}

void Buffer::log(const char* what, uint64_t bytes, const cl::Event& event) const {
    CommandLog* const commands = device_->commands();
    if (commands == nullptr) return;
    commands->add(TraceCategory::transfer, fmt::format("{} {}", what, name_), {"bytes", bytes}, event);
}

void Buffer::write(std::span<const std::byte> source, uint64_t offset, Transfer transfer) {
    check_range(offset, source.size());
    if (source.empty()) return;
    const cl_bool blocking = transfer == Transfer::blocking ? CL_TRUE : CL_FALSE;
    cl::Event event;
    check(device_->queue().enqueueWriteBuffer(handle_, blocking, offset, source.size(), source.data(),
                                              nullptr, event_if_logged(event)),
          "clEnqueueWriteBuffer", fmt::format("uploading \"{}\"", name_), device_->name());
    log("upload", source.size(), event);
}

void Buffer::read(std::span<std::byte> target, uint64_t offset, Transfer transfer) const {
    check_range(offset, target.size());
    if (target.empty()) return;
    const cl_bool blocking = transfer == Transfer::blocking ? CL_TRUE : CL_FALSE;
    cl::Event event;
    check(device_->queue().enqueueReadBuffer(handle_, blocking, offset, target.size(), target.data(), nullptr,
                                             event_if_logged(event)),
          "clEnqueueReadBuffer", fmt::format("downloading \"{}\"", name_), device_->name());
    log("download", target.size(), event);
}

Buffer::Mapping::Mapping(const Buffer& mapped, uint64_t bytes) : buffer(mapped) {
    cl_int code = CL_SUCCESS;
    cl::Event event;
    memory = mapped.device_->queue().enqueueMapBuffer(mapped.handle_, CL_TRUE, CL_MAP_READ, 0, bytes, nullptr,
                                                      mapped.event_if_logged(event), &code);
    check(code, "clEnqueueMapBuffer", fmt::format("reading \"{}\"", mapped.name_), mapped.device_->name());
    mapped.log("map", bytes, event);
}

Buffer::Mapping::~Mapping() {
    if (memory != nullptr) buffer.device_->queue().enqueueUnmapMemObject(buffer.handle_, memory);
}

void Buffer::Mapping::close() {
    check(buffer.device_->queue().enqueueUnmapMemObject(buffer.handle_, std::exchange(memory, nullptr)),
          "clEnqueueUnmapMemObject", fmt::format("reading \"{}\"", buffer.name_), buffer.device_->name());
}

void Buffer::clear() {
    check_range(0, 0);
    if (bytes_ == 0) return;
    // The pattern is one byte, so that any size is a whole number of patterns.
    cl::Event event;
    check(
        device_->queue().enqueueFillBuffer(handle_, cl_uchar{0}, 0, bytes_, nullptr, event_if_logged(event)),
        "clEnqueueFillBuffer", fmt::format("clearing \"{}\"", name_), device_->name());
    log("clear", bytes_, event);
}

}  // namespace obscura
