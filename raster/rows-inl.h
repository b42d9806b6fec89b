// Per-target: from blocks of 4 x 4 pixels, as tiles keep them, to the rows of planes.
#if defined(OBSCURA_ROWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef OBSCURA_ROWS_INL_H_
#undef OBSCURA_ROWS_INL_H_
#else
#define OBSCURA_ROWS_INL_H_
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "obscura/raster/plane.h"
#include "obscura/raster/tile.h"
#include "obscura/raster/transform-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::raster {
namespace HWY_NAMESPACE {

// Pixels side by side, one vector for each of the four rows of the blocks that it takes to fill them; at: element of the
// first. No temporary: a vector that is loaded from what four stores have just written waits for all of them.
template <class D, class T>
HWY_INLINE void rowsOfBlocks(D d, const T* at, hn::Vec<D> rows[kBlock]) {
  constexpr int kLanes = int(hn::MaxLanes(D()));
#if HWY_TARGET == HWY_AVX3
  // Blocks are vectors; what is wanted are their transposed quarters.
  const auto quarters = [&](int block) HWY_ATTR { return hn::BitCast(DI(), hn::Load(d, at + block * kBlock * kBlock)).raw; };
  const __m512i b0 = quarters(0), b1 = quarters(1), b2 = quarters(2), b3 = quarters(3);
  const __m512i lower01 = _mm512_shuffle_i32x4(b0, b1, 0x44), upper01 = _mm512_shuffle_i32x4(b0, b1, 0xEE);
  const __m512i lower23 = _mm512_shuffle_i32x4(b2, b3, 0x44), upper23 = _mm512_shuffle_i32x4(b2, b3, 0xEE);
  rows[0] = hn::BitCast(d, VI{_mm512_shuffle_i32x4(lower01, lower23, 0x88)});
  rows[1] = hn::BitCast(d, VI{_mm512_shuffle_i32x4(lower01, lower23, 0xDD)});
  rows[2] = hn::BitCast(d, VI{_mm512_shuffle_i32x4(upper01, upper23, 0x88)});
  rows[3] = hn::BitCast(d, VI{_mm512_shuffle_i32x4(upper01, upper23, 0xDD)});
#elif HWY_TARGET == HWY_AVX2
  static_assert(kLanes == 2 * kBlock, "a vector holds two rows of a block");
  for (int half = 0; half < 2; ++half) {
    const auto b0 = hn::Load(d, at + half * kLanes), b1 = hn::Load(d, at + kBlock * kBlock + half * kLanes);
    rows[2 * half] = hn::ConcatLowerLower(d, b1, b0);
    rows[2 * half + 1] = hn::ConcatUpperUpper(d, b1, b0);
  }
#else
  static_assert(kLanes <= kBlock, "a vector lies in a row of a block");
  for (int row = 0; row < kBlock; ++row) rows[row] = hn::Load(d, at + row * kBlock);
#endif
}

// Element, in a row of blocks, of the first pixel of column `column`.
constexpr int elementOf(int column) { return ((column >> kBlockBits) << (2 * kBlockBits)) + (column & (kBlock - 1)); }

// Pixels x ... of row y of a plane; x is a multiple of the vector's length. Past the caches: a plane is written once, in whole
// lines, which then need not be read before. FlushStream() follows before anybody else may look.
template <class D, class T>
HWY_INLINE void storeRow(D d, hn::Vec<D> v, int x, int y, Plane<T>& plane) {
  hn::Stream(v, d, plane.row(y) + x);
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::raster
HWY_AFTER_NAMESPACE();
#endif
