// Per-target: blocks of 4 x 4 pixels, the unit in which tiles are rasterized.
#if defined(OBSCURA_BLOCK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef OBSCURA_BLOCK_INL_H_
#undef OBSCURA_BLOCK_INL_H_
#else
#define OBSCURA_BLOCK_INL_H_
#endif

#include <algorithm>

#include <hwy/highway.h>

#include "obscura/raster/surface-inl.h"
#include "obscura/raster/tile.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::raster {
namespace HWY_NAMESPACE {

constexpr int kBlockPixels = kBlock * kBlock;
constexpr int kVectors = kBlockPixels / int(hn::MaxLanes(DF()));  // that a block is made of

// Column and row, in its block, of each pixel of vector `k`; alike of each block among sixteen, four in a row.
HWY_INLINE VI columnOf(int k) { return hn::And(hn::Iota(DI(), k * int(hn::MaxLanes(DI()))), hn::Set(DI(), kBlock - 1)); }
HWY_INLINE VI rowOf(int k) { return hn::ShiftRight<kBlockBits>(hn::Iota(DI(), k * int(hn::MaxLanes(DI())))); }

// A triangle whose alpha decides per pixel; its weight planes are those of the last cell.
class MaskedTriangle {
 public:
  MaskedTriangle(const SurfaceContext& context, uint32_t id) : context_(context), draw_(drawOf(context, id)) {
    for (int i = 0; i < 3; ++i) vertex_[i] = draw_.mesh->indices[size_t(id - draw_.firstTriangle) * 3 + size_t(i)];
  }

  // The part of `covered` where alpha reaches the material's cutoff, in vector k of the block at pixel (x, y) of the image.
  HWY_NOINLINE MF test(int x, int y, int k, MF covered) {
    const DF d;
    const DI di;
    const int cellX = x - x % kCell, cellY = y - y % kCell;
    if (cellX != cellX_ || cellY != cellY_) planes_ = weightPlanes(*context_.view, draw_, vertex_, cellX_ = cellX, cellY_ = cellY);
    const VI dx = hn::Add(columnOf(k), hn::Set(di, x - cellX)), dy = hn::Add(rowOf(k), hn::Set(di, y - cellY));
    const Seen s = seeTriangle(planes_, vertex_, hn::ConvertTo(d, dx), hn::ConvertTo(d, dy));
    return hn::And(covered, hn::Ge(baseColor(context_, draw_, s).a, hn::Set(d, draw_.material->alphaCutoff)));
  }

 private:
  const SurfaceContext& context_;
  const Draw& draw_;
  uint32_t vertex_[3];
  WeightPlanes planes_;
  int cellX_ = -1, cellY_ = -1;
};

// What a triangle's depth is made of, see triangle.h, and who it is.
struct Plane3 {
  float key0, xGradient, yGradient, keyMin, keyMax;
  uint32_t id;
};

// The vector's keys at (x, y) from p0, sub-pixels.
HWY_INLINE VF keyAt(const Plane3& t, VF x, VF y) {
  const DF d;
  const VF least = hn::Set(d, t.keyMin), most = hn::Set(d, t.keyMax);
  VF key = hn::Add(hn::Set(d, t.key0), hn::Add(hn::Mul(hn::Set(d, t.xGradient), x), hn::Mul(hn::Set(d, t.yGradient), y)));
#if HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR
  return hn::Min(hn::Max(key, least), most);  // one instruction each, and where the first operand is NaN it is the second
#else
  key = hn::IfThenElse(hn::Gt(key, least), key, least);
  return hn::IfThenElse(hn::Lt(key, most), key, most);
#endif
}

// Depth test of a vector of pixels, at element `at` of the tile, where the signs of `outside` are not set. masked: null
// where coverage is all that counts; x, y: the block's first pixel in the image, k: the vector in the block.
template <Keep kKeep>
HWY_INLINE void fillVector(MaskedTriangle* masked, int x, int y, int k, uint32_t triangle, VF key, VI outside, size_t at,
                           const TileBuffers& out) {
  const DF d;
  const DI di;
  const DU du;
  const MI inside = hn::Not(hn::Lt(outside, hn::Zero(di)));
  const VU id = hn::Set(du, triangle);
  const VF oldKey = hn::Load(d, out.key + at);
  VU oldId = id;
  MF nearer;
  if constexpr (kKeep == Keep::Visibility) {
    oldId = hn::Load(du, out.id + at);
    nearer = hn::Or(hn::Gt(key, oldKey), hn::And(hn::Eq(key, oldKey), hn::RebindMask(d, hn::Lt(id, oldId))));
  } else {
    nearer = hn::Gt(key, oldKey);
    if constexpr (kKeep == Keep::KeyWithinLimit) nearer = hn::And(nearer, hn::Le(key, hn::Load(d, out.limit + at)));
  }
  MF wins = hn::And(nearer, hn::RebindMask(d, inside));
  if (masked && !hn::AllFalse(d, wins)) wins = masked->test(x, y, k, wins);
  hn::Store(hn::IfThenElse(wins, key, oldKey), d, out.key + at);
  if constexpr (kKeep == Keep::Visibility) hn::Store(hn::IfThenElse(hn::RebindMask(du, wins), id, oldId), du, out.id + at);
}

// A triangle as the block loop sees it: edge functions at the upper left pixel of its first block in the tile.
struct Blocks {
  int32_t e[3], a[3], b[3];
  int x, y, columns, rows;  // blocks, from the tile's first; at most 16 a row
  Plane3 plane;
  float xFromP0, yFromP0;   // that pixel's centre minus p0, exact
};

// The bits of a mask's lanes, from bit `first` on.
HWY_INLINE uint32_t bitsFrom(int first, MI mask) {
  uint8_t bits[8] = {};
  hn::StoreMaskBits(DI(), mask, bits);
  return (uint32_t(bits[0]) | uint32_t(bits[1]) << 8) << first;
}

// Edge functions in sixteen blocks, four in a row.
struct SixteenBlocks {
  uint32_t touched, partly;              // bits: no edge function is negative in all four corners; one is in any
  HWY_ALIGN int32_t e[3][kBlockPixels];  // at each block's first pixel
};

// Block (column, row) of the box is the first of the sixteen; those outside of the box are not touched. step: a dx + b dy of
// every pixel of a block, and four times that of the blocks of sixteen.
HWY_INLINE void findTouched(const Blocks& t, const VI step[3][kVectors], int column, int row, SixteenBlocks& out) {
  const DI di;
  constexpr int kLanes = int(hn::MaxLanes(DI()));
  out.touched = out.partly = 0;
  const auto edge = [&](int i, int k, VI& outside, VI& partly) HWY_ATTR {
    const int32_t first = t.e[i] + (t.a[i] * column + t.b[i] * row) * kBlock;
    const VI e = hn::Add(hn::Set(di, first), hn::ShiftLeft<kBlockBits>(step[i][k]));
    hn::Store(e, di, out.e[i] + k * kLanes);
    const int32_t across = (kBlock - 1) * t.a[i], down = (kBlock - 1) * t.b[i];
    outside = hn::Or(outside, hn::Add(e, hn::Set(di, (across > 0 ? across : 0) + (down > 0 ? down : 0))));
    partly = hn::Or(partly, hn::Add(e, hn::Set(di, (across < 0 ? across : 0) + (down < 0 ? down : 0))));
  };
  for (int k = 0; k < kVectors; ++k) {
    VI outside = hn::Or(hn::Sub(hn::Set(di, t.columns - 1 - column), columnOf(k)), hn::Sub(hn::Set(di, t.rows - 1 - row), rowOf(k)));
    VI partly = hn::Zero(di);
    edge(0, k, outside, partly);  // not a loop, which g++ would not unroll
    edge(1, k, outside, partly);
    edge(2, k, outside, partly);
    out.touched |= bitsFrom(k * kLanes, hn::Not(hn::Lt(outside, hn::Zero(di))));
    out.partly |= bitsFrom(k * kLanes, hn::Lt(partly, hn::Zero(di)));
  }
  out.partly &= out.touched;
}

// Vector k of block (column, row) of the box; x0, y0: the pixels' centres in the first block, minus p0.
template <Keep kKeep>
HWY_INLINE void fillBlock(MaskedTriangle* masked, const Blocks& t, int column, int row, int k, VF x0, VF y0, VI outside,
                          const TileBuffers& out) {
  const DF d;
  const VF x = hn::Add(x0, hn::Set(d, float(column * kBlock * kSub))), y = hn::Add(y0, hn::Set(d, float(row * kBlock * kSub)));
  const int blockX = t.x + column, blockY = t.y + row;
  const size_t at = size_t((blockY * out.columns + blockX) * kBlockPixels + k * int(hn::MaxLanes(d)));
  fillVector<kKeep>(masked, out.x + blockX * kBlock, out.y + blockY * kBlock, k, t.plane.id, keyAt(t.plane, x, y), outside, at, out);
}

// Sixteen blocks from block (column, row) of the box.
template <Keep kKeep>
HWY_INLINE void fillSixteen(MaskedTriangle* masked, const Blocks& t, const VI step[3][kVectors], int column, int row,
                            const TileBuffers& out) {
  const DF d;
  const DI di;
  SixteenBlocks some;
  findTouched(t, step, column, row, some);
  for (int k = 0; k < kVectors; ++k) {
    const VF x0 = hn::Add(hn::ConvertTo(d, hn::ShiftLeft<kSubBits>(columnOf(k))), hn::Set(d, t.xFromP0));
    const VF y0 = hn::Add(hn::ConvertTo(d, hn::ShiftLeft<kSubBits>(rowOf(k))), hn::Set(d, t.yFromP0));
    for (uint32_t rest = some.touched & ~some.partly; rest != 0; rest &= rest - 1) {
      const int block = int(hwy::Num0BitsBelowLS1Bit_Nonzero32(rest));
      fillBlock<kKeep>(masked, t, column + (block & (kBlock - 1)), row + (block >> kBlockBits), k, x0, y0, hn::Zero(di), out);
    }
    for (uint32_t rest = some.partly; rest != 0; rest &= rest - 1) {
      const int block = int(hwy::Num0BitsBelowLS1Bit_Nonzero32(rest));
      auto edge = [&](int i) HWY_ATTR { return hn::Add(step[i][k], hn::Set(di, some.e[i][block])); };
      fillBlock<kKeep>(masked, t, column + (block & (kBlock - 1)), row + (block >> kBlockBits), k, x0, y0,
                       hn::Or(hn::Or(edge(0), edge(1)), edge(2)), out);
    }
  }
}

template <Keep kKeep>
HWY_INLINE void fillBlocks(MaskedTriangle* masked, const Blocks& t, const TileBuffers& out) {
  const DI di;
  VI step[3][kVectors];
  const auto stepOf = [&](int i, int k) HWY_ATTR {
    return hn::Add(hn::Mul(columnOf(k), hn::Set(di, t.a[i])), hn::Mul(rowOf(k), hn::Set(di, t.b[i])));
  };
  for (int k = 0; k < kVectors; ++k) step[0][k] = stepOf(0, k), step[1][k] = stepOf(1, k), step[2][k] = stepOf(2, k);
  for (int row = 0; row < t.rows; row += kBlock)
    for (int column = 0; column < t.columns; column += kBlock) fillSixteen<kKeep>(masked, t, step, column, row, out);
}

// a dx + b dy, each of them a pair of 16 bits: a and dx lower, b and dy upper.
HWY_INLINE VI stepOfPair(int32_t ab, VI distance) {
  const DI di;
#if HWY_TARGET == HWY_SCALAR
  const auto lower = [&](VI pair) HWY_ATTR { return hn::ShiftRight<16>(hn::ShiftLeft<16>(pair)); };
  const VI pair = hn::Set(di, ab);
  return hn::Add(hn::Mul(lower(distance), lower(pair)), hn::Mul(hn::ShiftRight<16>(distance), hn::ShiftRight<16>(pair)));
#else
  const hn::Repartition<int16_t, DI> d16;
  VI none = hn::Zero(di);
  const VI sum = hn::ReorderWidenMulAccumulate(di, hn::BitCast(d16, hn::Set(di, ab)), hn::BitCast(d16, distance), hn::Zero(di), none);
  return hn::RearrangeToOddPlusEven(sum, none);
#endif
}

// Up to four by four blocks from block (x, y) of the tile, where they lie in it; as fillBlocks(), but all from pairs.
template <Keep kKeep>
HWY_INLINE void fillSmall(const SmallTriangle& t, int x, int y, const TileBuffers& out) {
  const DF d;
  const DI di;
  constexpr int kLanes = int(hn::MaxLanes(DI()));
  // Of each block: pixels from the first block's.
  HWY_ALIGN static constexpr float kXSub[kBlockPixels] = {0, 1024, 2048, 3072, 0, 1024, 2048, 3072, 0, 1024, 2048, 3072, 0, 1024, 2048, 3072};
  HWY_ALIGN static constexpr float kYSub[kBlockPixels] = {0, 0, 0, 0, 1024, 1024, 1024, 1024, 2048, 2048, 2048, 2048, 3072, 3072, 3072, 3072};
  static_assert(kBlock * kSub == 1024);
  HWY_ALIGN int32_t edges[3][kBlockPixels];
  const int rows = (out.height + kBlock - 1) >> kBlockBits;
  const VI first[2] = {hn::Set(di, std::max(-x, 0)), hn::Set(di, std::max(-y, 0))};
  const VI last[2] = {hn::Set(di, std::min(t.columns(), out.columns - x) - 1), hn::Set(di, std::min(t.rows(), rows - y) - 1)};
  uint32_t touched = 0;
  VI step[3][kVectors];
  for (int k = 0; k < kVectors; ++k) {
    const VI column = columnOf(k), row = rowOf(k);
    VI outside = hn::Or(hn::Or(hn::Sub(column, first[0]), hn::Sub(last[0], column)), hn::Or(hn::Sub(row, first[1]), hn::Sub(last[1], row)));
    const auto edge = [&](int i) HWY_ATTR {
      const VI across = stepOfPair(t.ab[i], hn::Set(di, kBlock - 1)), down = stepOfPair(t.ab[i], hn::Set(di, (kBlock - 1) << 16));
      step[i][k] = stepOfPair(t.ab[i], hn::Or(column, hn::ShiftLeft<16>(row)));
      const VI e = hn::Add(hn::Set(di, t.e[i]), hn::ShiftLeft<kBlockBits>(step[i][k])), zero = hn::Zero(di);
      hn::Store(e, di, edges[i] + k * kLanes);
      outside = hn::Or(outside, hn::Add(e, hn::Add(hn::Max(across, zero), hn::Max(down, zero))));
    };
    edge(0);
    edge(1);
    edge(2);
    touched |= bitsFrom(k * kLanes, hn::Not(hn::Lt(outside, hn::Zero(di))));
  }
  const Plane3 plane{t.key0, t.xGradient, t.yGradient, t.keyMin, t.keyMax, t.id};
  for (int k = 0; k < kVectors; ++k) {
    const VF x0 = hn::Add(hn::ConvertTo(d, hn::ShiftLeft<kSubBits>(columnOf(k))), hn::Set(d, t.xFromP0));
    const VF y0 = hn::Add(hn::ConvertTo(d, hn::ShiftLeft<kSubBits>(rowOf(k))), hn::Set(d, t.yFromP0));
    for (uint32_t rest = touched; rest != 0; rest &= rest - 1) {
      const int block = int(hwy::Num0BitsBelowLS1Bit_Nonzero32(rest));
      auto edge = [&](int i) HWY_ATTR { return hn::Add(step[i][k], hn::Set(di, edges[i][block])); };
      const VF key = keyAt(plane, hn::Add(x0, hn::Set(d, kXSub[block])), hn::Add(y0, hn::Set(d, kYSub[block])));
      const int at = ((y + (block >> kBlockBits)) * out.columns + x + (block & (kBlock - 1))) * kBlockPixels + k * kLanes;
      fillVector<kKeep>(nullptr, 0, 0, k, t.id, key, hn::Or(hn::Or(edge(0), edge(1)), edge(2)), size_t(at), out);
    }
  }
}

// So many blocks, all in the tile.
template <Keep kKeep, int kColumns, int kRows>
HWY_INLINE void fillFew(const SmallTriangle& t, const TileBuffers& out) {
  const DF d;
  const DI di;
  const Plane3 plane{t.key0, t.xGradient, t.yGradient, t.keyMin, t.keyMax, t.id};
  const int x = lowerHalf(t.block) - (out.x >> kBlockBits), y = upperHalf(t.block) - (out.y >> kBlockBits);
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column)
      for (int k = 0; k < kVectors; ++k) {
        const VI dx = hn::Add(columnOf(k), hn::Set(di, column * kBlock)), dy = hn::Add(rowOf(k), hn::Set(di, row * kBlock));
        const VI distance = hn::Or(dx, hn::ShiftLeft<16>(dy));
        auto edge = [&](int i) HWY_ATTR { return hn::Add(stepOfPair(t.ab[i], distance), hn::Set(di, t.e[i])); };
        auto from = [&](VI pixel, int block, float fromP0) HWY_ATTR {
          return hn::Add(hn::ConvertTo(d, hn::ShiftLeft<kSubBits>(hn::Add(pixel, hn::Set(di, block * kBlock)))), hn::Set(d, fromP0));
        };
        const VF key = keyAt(plane, from(columnOf(k), column, t.xFromP0), from(rowOf(k), row, t.yFromP0));
        const size_t at = size_t(((y + row) * out.columns + x + column) * kBlockPixels + k * int(hn::MaxLanes(d)));
        fillVector<kKeep>(nullptr, 0, 0, k, t.id, key, hn::Or(hn::Or(edge(0), edge(1)), edge(2)), at, out);
      }
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::raster
HWY_AFTER_NAMESPACE();
#endif
