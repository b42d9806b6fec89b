// Private: picks one of the versions that Highway compiled of a kernel, by an argument instead of by a global.
#pragma once

#include <hwy/highway.h>

#include "obscura/raster/target.h"

namespace obscura::raster {

constexpr int64_t hwyTarget([[maybe_unused]] Target t) {
#if HWY_ARCH_X86
  return t == Target::Avx3   ? HWY_AVX3
         : t == Target::Avx2 ? HWY_AVX2
         : t == Target::Sse4 ? HWY_SSE4
         : t == Target::Ssse3 ? HWY_SSSE3
                              : 0;
#elif HWY_ARCH_ARM
  return t == Target::Neon ? HWY_NEON : 0;
#else
  return 0;
#endif
}

// Index into the table that HWY_EXPORT makes; `target` must come from chooseTarget().
inline size_t dispatchIndex([[maybe_unused]] Target target) {
#if (HWY_TARGETS & (HWY_TARGETS - 1)) == 0
  return 0;
#else
  return hwy::Num0BitsBelowLS1Bit_Nonzero64(
      static_cast<uint64_t>(HWY_CHOSEN_TARGET_SHIFT(hwyTarget(target)) | HWY_CHOSEN_TARGET_MASK_SCALAR));
#endif
}

#define OBSCURA_DISPATCH(FUNCTION, target) (HWY_DISPATCH_TABLE(FUNCTION)[::obscura::raster::dispatchIndex(target)])

}  // namespace obscura::raster
