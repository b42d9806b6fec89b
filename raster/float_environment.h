// Private: the floating-point state that every task computes in.
#pragma once

#include <cfenv>
#include <cstdint>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace obscura::raster {

// Rounds to nearest, keeps denormals, masks exceptions while it lives, and restores what the host had: a host that
// flushes denormals or rounds towards zero gets the same image as any other.
class FloatEnvironment {
 public:
  FloatEnvironment() {
    std::fegetenv(&saved_);
    std::fesetenv(FE_DFL_ENV);
#if defined(__SSE__)
    _mm_setcsr(0x1F80);  // the default of MXCSR: no flush-to-zero, no denormals-are-zero
#elif defined(__aarch64__)
    asm volatile("msr fpcr, %0" : : "r"(uint64_t(0)));
#endif
  }
  ~FloatEnvironment() { std::fesetenv(&saved_); }  // includes MXCSR and FPCR
  FloatEnvironment(const FloatEnvironment&) = delete;
  FloatEnvironment& operator=(const FloatEnvironment&) = delete;

 private:
  std::fenv_t saved_;
};

}  // namespace obscura::raster
