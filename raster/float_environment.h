// Private: the floating-point state that every task computes in.
#pragma once

#include <cfenv>
#include <cstdint>

#if defined(__SSE2_MATH__)
#include <xmmintrin.h>
#endif

namespace obscura::raster {

// Rounds to nearest, keeps denormals, masks exceptions while it lives, and restores what the host had: a host that
// flushes denormals or rounds towards zero gets the same image as any other.
class FloatEnvironment {
 public:
#if defined(__SSE2_MATH__)  // nothing is computed by the x87, whose state takes far longer to save and to load
  FloatEnvironment() : saved_(_mm_getcsr()) { _mm_setcsr(0x1F80); }  // the default: no flush-to-zero, no denormals-are-zero
  ~FloatEnvironment() { _mm_setcsr(saved_); }
#else
  FloatEnvironment() {
    std::fegetenv(&saved_);
    std::fesetenv(FE_DFL_ENV);
#if defined(__aarch64__)
    asm volatile("msr fpcr, %0" : : "r"(uint64_t(0)));
#endif
  }
  ~FloatEnvironment() { std::fesetenv(&saved_); }  // includes FPCR
#endif
  FloatEnvironment(const FloatEnvironment&) = delete;
  FloatEnvironment& operator=(const FloatEnvironment&) = delete;

 private:
#if defined(__SSE2_MATH__)
  unsigned saved_;
#else
  std::fenv_t saved_;
#endif
};

}  // namespace obscura::raster
