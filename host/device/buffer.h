// SPDX-License-Identifier: Apache-2.0
// A buffer on the device: freed with its owner, named in error messages, its bytes counted in the device's
// ledger. An empty buffer still has a handle, so that it can be bound to a kernel.
#pragma once

#include <cstdint>
#include <ranges>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "device/device.h"

namespace obscura {

enum class Transfer {
    blocking,
    // Returns at once: the host memory stays untouched and alive until Device::finish or a blocking transfer.
    enqueued,
};

// Huge pages, where the system has them, are for what is read here and there as rays go their own ways through a large tree:
// with pages of 4 KiB they miss the TLB at most nodes. They take longer to get.
enum class Pages { any, huge };

// Trivially copyable elements, one after the other: vector, array, span, a single-element span.
template <typename R>
concept PlainRange = std::ranges::contiguous_range<R> && std::ranges::sized_range<R> &&
    std::is_trivially_copyable_v<std::ranges::range_value_t<R>>;

class Buffer {
  public:
    Buffer() = default;  // no device memory yet; can only be assigned to
    // Uninitialised memory. Throws DeviceError naming buffer and sizes where the device can't give it.
    Buffer(Device& device, std::string name, std::string category, uint64_t bytes, Pages pages = Pages::any);
    ~Buffer();
    Buffer(Buffer&& other) noexcept;
    Buffer& operator=(Buffer&& other) noexcept;

    // A buffer that holds a copy of values, uploaded before the call returns.
    template <PlainRange R>
    static Buffer holding(Device& device, std::string name, std::string category, const R& values,
                          Pages pages = Pages::any) {
        const auto bytes = std::as_bytes(std::span(values));
        Buffer buffer(device, std::move(name), std::move(category), bytes.size(), pages);
        buffer.write(bytes, 0, Transfer::blocking);
        return buffer;
    }

    // first: index of the first element of R's type in the buffer. The range must fit (OBSCURA_CHECK).
    template <PlainRange R>
    void upload(const R& values, uint64_t first = 0, Transfer transfer = Transfer::blocking) {
        write(std::as_bytes(std::span(values)), first * sizeof(std::ranges::range_value_t<R>), transfer);
    }
    template <PlainRange R>
    void download(R&& values, uint64_t first = 0, Transfer transfer = Transfer::blocking) const {
        read(std::as_writable_bytes(std::span(values)), first * sizeof(std::ranges::range_value_t<R>),
             transfer);
    }
    // The whole buffer as T, waiting for it.
    template <typename T>
    std::vector<T> contents() const {
        std::vector<T> values(bytes_ / sizeof(T));
        download(values);
        return values;
    }
    // Calls use(span of const T) with the first elements, waiting for them. They lie in the host's memory as long as that
    // takes: where that is the device's, too, in the buffer's own.
    template <typename T, typename Use>
    void read_in_place(size_t count, const Use& use) const {
        check_range(0, count * sizeof(T));
        Mapping mapping(*this, count * sizeof(T));
        use(std::span(static_cast<const T*>(mapping.memory), count));
        mapping.close();
    }
    // Sets every byte to zero, in queue order, without waiting.
    void clear();

    uint64_t bytes() const { return bytes_; }
    const std::string& name() const { return name_; }
    const std::string& category() const { return category_; }
    const cl::Buffer& handle() const { return handle_; }

  private:
    // The first bytes of a buffer, to be read.
    struct Mapping {
        Mapping(const Buffer& buffer, uint64_t bytes);
        ~Mapping();  // closes it, if an error hasn't let it be closed
        void close();
        Mapping(const Mapping&) = delete;
        Mapping& operator=(const Mapping&) = delete;

        const Buffer& buffer;
        void* memory;
    };

    void write(std::span<const std::byte> source, uint64_t offset, Transfer transfer);
    void read(std::span<std::byte> target, uint64_t offset, Transfer transfer) const;
    void check_range(uint64_t offset, uint64_t size) const;
    // Enters a transfer of so many bytes into the device's log; what: "upload".
    void log(const char* what, uint64_t bytes, const cl::Event& event) const;
    cl::Event* event_if_logged(cl::Event& event) const;
    void release() noexcept;

    Device* device_ = nullptr;
    std::string name_, category_;
    uint64_t bytes_ = 0;
    cl::Buffer handle_;
};

}  // namespace obscura
