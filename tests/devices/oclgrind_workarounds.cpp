// SPDX-License-Identifier: Apache-2.0
// Loaded before Oclgrind's runtime, so that its check for uninitialised memory knows what OpenCL guarantees. Version
// 21.10 keeps a record per buffer of which bytes were written (src/plugins/Uninitialized.cpp), which each write by the
// host replaces by one of that write's size. That goes wrong twice:
//   - A fill counts as a write per pattern, so that one pattern's bytes are left. Here it is one write of the range.
//   - A released buffer's record stays, and is taken for that of the next buffer at the same address. Here the last act
//     on a buffer is a write of nothing: an empty record is taken for none.
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <dlfcn.h>

#include <cstring>
#include <vector>

namespace {

void forget_contents(cl_mem buffer) {
    cl_context context = nullptr;
    cl_device_id device = nullptr;
    clGetMemObjectInfo(buffer, CL_MEM_CONTEXT, sizeof(context), &context, nullptr);
    clGetContextInfo(context, CL_CONTEXT_DEVICES, sizeof(device), &device, nullptr);
    cl_command_queue queue = clCreateCommandQueue(context, device, 0, nullptr);
    clEnqueueWriteBuffer(queue, buffer, CL_TRUE, 0, 0, "", 0, nullptr, nullptr);
    clReleaseCommandQueue(queue);
}

}  // namespace

extern "C" {

cl_int clEnqueueFillBuffer(cl_command_queue queue, cl_mem buffer, const void* pattern, size_t pattern_bytes,
                           size_t offset, size_t bytes, cl_uint wait_count, const cl_event* wait,
                           cl_event* event) {
    std::vector<unsigned char> filled(bytes);
    for (size_t i = 0; i < bytes; i += pattern_bytes)
        std::memcpy(filled.data() + i, pattern, pattern_bytes);
    return clEnqueueWriteBuffer(queue, buffer, CL_TRUE, offset, bytes, filled.data(), wait_count, wait,
                                event);
}

cl_int clReleaseMemObject(cl_mem buffer) {
    cl_uint references = 0;
    clGetMemObjectInfo(buffer, CL_MEM_REFERENCE_COUNT, sizeof(references), &references, nullptr);
    if (references == 1) forget_contents(buffer);
    static const auto release =
        reinterpret_cast<decltype(&clReleaseMemObject)>(dlsym(RTLD_NEXT, "clReleaseMemObject"));
    return release(buffer);
}
}
