// SPDX-License-Identifier: Apache-2.0
// Embree asks for denormals to be flushed to zero while it traces, because they are slow.
#pragma once

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace obscura {

// Restores the thread's mode, which belongs to the caller.
class FlushDenormals {
  public:
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;
#if defined(__SSE__)
    FlushDenormals() : saved_(_mm_getcsr()) {
        _mm_setcsr(saved_ | FLUSH_TO_ZERO | DENORMALS_ARE_ZERO);
    }
    ~FlushDenormals() {
        _mm_setcsr(saved_);
    }

  private:
    static constexpr unsigned int FLUSH_TO_ZERO = 0x8000;
    static constexpr unsigned int DENORMALS_ARE_ZERO = 0x0040;
    unsigned int saved_;
#else
    FlushDenormals() = default;
#endif
};

}  // namespace obscura
