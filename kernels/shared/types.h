// SPDX-License-Identifier: Apache-2.0
// The 16-byte members that structs shared by host and device are made of. Included by C++20 and OpenCL C.
#ifndef OBSCURA_SHARED_TYPES_H
#define OBSCURA_SHARED_TYPES_H

#ifdef __cplusplus
#include <cstdint>

namespace obscura {

struct alignas(16) f32x4 {
    float x, y, z, w;
};
struct alignas(16) u32x4 {
    uint32_t x, y, z, w;
};

}  // namespace obscura
#else
typedef float4 f32x4;
typedef uint4 u32x4;
#endif

#endif
