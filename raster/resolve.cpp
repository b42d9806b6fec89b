#include "obscura/raster/resolve.h"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "obscura/raster/resolve.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "obscura/raster/shade-inl.h"

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

// One row of depth, position and triangle ids.
HWY_INLINE void storeVisible(const View& view, VF key, VU id, int x, int y, GBuffer& out) {
  const DF d;
  const DI di;
  const DU du;
  const VF infinity = hn::Set(d, std::numeric_limits<float>::infinity()), zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const MF covered = hn::RebindMask(d, hn::Ne(id, hn::Set(du, kNoTriangle)));
  // 0 - key: a plain negation would give two kinds of zero.
  const VF zView = view.perspective ? hn::Div(one, key) : hn::Sub(zero, key);
  if (!out.triangle.empty()) hn::StoreU(id, du, out.triangle.row(y) + x);
  if (!out.depth.empty()) hn::StoreU(hn::IfThenElse(covered, zView, infinity), d, out.depth.row(y) + x);
  if (out.position[0].empty()) return;
  const VF xc = hn::ConvertTo(d, hn::Add(hn::Set(di, view.xCenterSub(x)), hn::ShiftLeft<kSubBits>(hn::Iota(di, 0))));
  VF px = hn::Div(hn::Sub(xc, hn::Set(d, view.xShiftSub)), hn::Set(d, view.xScaleSub));
  VF py = hn::Div(hn::Set(d, float(view.yCenterSub(y)) - view.yShiftSub), hn::Set(d, view.yScaleSub));
  if (view.perspective) {
    px = hn::Mul(px, zView);
    py = hn::Mul(py, zView);
  }
  hn::StoreU(hn::IfThenElseZero(covered, px), d, out.position[0].row(y) + x);
  hn::StoreU(hn::IfThenElseZero(covered, py), d, out.position[1].row(y) + x);
  hn::StoreU(hn::IfThenElseZero(covered, hn::Sub(zero, zView)), d, out.position[2].row(y) + x);
}

// The lines that four rows of depth and ids will fill.
HWY_INLINE void fetchRows(const TileBuffers& tile, int top, GBuffer& out) {
  constexpr int kLine = 16;  // pixels
  for (int row = top; row < std::min(top + kBlock, tile.height); ++row)
    for (int x = tile.x; x < tile.x + tile.width; x += kLine) {
      if (!out.depth.empty()) __builtin_prefetch(out.depth.row(tile.y + row) + x, 1);
      if (!out.triangle.empty()) __builtin_prefetch(out.triangle.row(tile.y + row) + x, 1);
    }
}

// Depth, position and triangle ids need nothing but the visibility: whole rows, as memory likes it.
HWY_INLINE void storeVisibility(const View& view, const TileBuffers& tile, GBuffer& out) {
  const DF d;
  const DU du;
  fetchRows(tile, 0, out);
  for (int top = 0; top < tile.height; top += kBlock) {
    fetchRows(tile, top + kBlock, out);
    const int rows = std::min(kBlock, tile.height - top);
    for (int column = 0; column < tile.width; column += int(hn::Lanes(d))) {
      const int at = tile.at(column, top), x = tile.x + column, y = tile.y + top;
      VF keys[kBlock];
      VU ids[kBlock];
      rowsOfBlocks(d, tile.key + at, keys);
      rowsOfBlocks(du, tile.id + at, ids);
      storeVisible(view, keys[0], ids[0], x, y, out);  // not a loop, which would keep them in memory
      if (rows > 1) storeVisible(view, keys[1], ids[1], x, y + 1, out);
      if (rows > 2) storeVisible(view, keys[2], ids[2], x, y + 2, out);
      if (rows > 3) storeVisible(view, keys[3], ids[3], x, y + 3, out);
    }
  }
}

// Four rows of the cell: a block after the other for each plane, as in the tile's memory.
struct Strip {
  static constexpr int kPixels = kCell * kBlock;
  HWY_ALIGN float normal[3][kPixels], albedo[3][kPixels], emissive[3][kPixels];
  HWY_ALIGN uint32_t instance[kPixels], material[kPixels];
};

template <class T>
HWY_INLINE void storePlane(const T* blocks, int x, int y, int rows, Plane<T>& plane) {
  const hn::Rebind<T, DF> d;
  if (plane.empty()) return;
  for (int column = 0; column < kCell; column += int(hn::MaxLanes(d))) {
    hn::Vec<decltype(d)> row[kBlock];
    rowsOfBlocks(d, blocks + elementOf(column), row);
    T* to = plane.row(y) + x + column;
    const size_t stride = plane.stride();
    hn::StoreU(row[0], d, to);
    if (rows > 1) hn::StoreU(row[1], d, to + stride);
    if (rows > 2) hn::StoreU(row[2], d, to + 2 * stride);
    if (rows > 3) hn::StoreU(row[3], d, to + 3 * stride);
  }
}

// x, y: of the image; rows: that are inside of it.
HWY_INLINE void storeStrip(const Strip& s, const Wanted& wanted, int x, int y, int rows, GBuffer& out) {
  for (int c = 0; c < 3 && wanted.surfaces(); ++c) {
    storePlane(s.normal[c], x, y, rows, out.normal[c]);
    storePlane(s.albedo[c], x, y, rows, out.albedo[c]);
    storePlane(s.emissive[c], x, y, rows, out.emissive[c]);
  }
  storePlane(s.instance, x, y, rows, out.instance);
  storePlane(s.material, x, y, rows, out.material);
}

HWY_INLINE void keep(const V3& v, float planes[3][Strip::kPixels], int at) {
  const DF d;
  hn::Store(v.x, d, planes[0] + at);
  hn::Store(v.y, d, planes[1] + at);
  hn::Store(v.z, d, planes[2] + at);
}

HWY_INLINE void keepDraws(const VectorTriangles& t, Strip& strip, int at) {
  const DU d;
  VU instance = hn::Set(d, kNoTriangle), material = instance;
  for (int k = 0; k < t.count; ++k) {
    const auto mine = hn::RebindMask(d, t.shows(k));
    instance = hn::IfThenElse(mine, hn::Set(d, t.draw(k).instance), instance);
    material = hn::IfThenElse(mine, hn::Set(d, t.draw(k).materialIndex), material);
  }
  hn::Store(instance, d, strip.instance + at);
  hn::Store(material, d, strip.material + at);
}

// The lines of memory that a cell's planes will fill; cells jump from row to row, which no prefetcher follows.
HWY_INLINE void fetchCell(const TileBuffers& tile, int x, int y, GBuffer& out) {
  if (x >= tile.width) return;
  const int rows = std::min(kCell, tile.height - y);
  for (auto* planes : {out.normal, out.albedo, out.emissive})
    for (int c = 0; c < 3 && !planes[0].empty(); ++c)
      for (int row = 0; row < rows; ++row) __builtin_prefetch(planes[c].row(tile.y + y + row) + tile.x + x, 1);
}

// Attributes of the cell whose first pixel is (left, top) of the tile.
HWY_INLINE void resolveCell(const SurfaceContext& context, const TileBuffers& tile, int left, int top, const Wanted& wanted,
                            CellTriangles& cell, GBuffer& out) {
  const DF d;
  const DI di;
  const DU du;
  const CellBlocks blocks = blocksOf(tile, left, top);
  findTriangles(context, tile, blocks, cell);
  describeTriangles(context, wanted.surfaces(), wanted.normal, tile.x + left, tile.y + top, cell);
  int vector = 0, slot = 0;
  Strip strip;
  for (int row = 0; row < blocks.rows; ++row) {
    for (int column = 0; column < blocks.columns; ++column)
      for (int first = 0; first < kBlock * kBlock; first += int(hn::Lanes(d))) {
        const int dx = column * kBlock + first % kBlock, dy = row * kBlock + (first >> kBlockBits);  // from the cell's first pixel
        const int count = cell.slotEnd[vector] - slot, at = column * kBlock * kBlock + first;
        const VU id = hn::Load(du, tile.id + firstOfBlock(tile, blocks.x + column, blocks.y + row) + first);
        const VectorTriangles t{cell, cell.slot + slot, count, cell.oneDraw ? std::min(count, 1) : count, id};
        ++vector;
        slot += count;
        if (wanted.draws) keepDraws(t, strip, at);
        if (!wanted.surfaces()) continue;
        const VI lx = hn::And(hn::Iota(di, 0), hn::Set(di, kBlock - 1)), ly = hn::ShiftRight<kBlockBits>(hn::Iota(di, 0));
        const Shaded s = shade(context, wanted, t, hn::RebindMask(d, hn::Ne(id, hn::Set(du, kNoTriangle))),
                               hn::ConvertTo(d, hn::Add(lx, hn::Set(di, dx))), hn::ConvertTo(d, hn::Add(ly, hn::Set(di, dy))));
        if (wanted.normal) keep(s.normal, strip.normal, at);
        if (wanted.albedo) keep(s.albedo, strip.albedo, at);
        if (wanted.emissive) keep(s.emissive, strip.emissive, at);
      }
    const int y = top + row * kBlock;
    storeStrip(strip, wanted, tile.x + left, tile.y + y, std::min(kBlock, tile.height - y), out);
  }
}

template <class T>
HWY_INLINE void fill(const TileBuffers& tile, Plane<T>& plane, T value) {
  const hn::Rebind<T, DF> d;
  constexpr int kAhead = 8, kLine = 64 / int(sizeof(T));
  if (plane.empty()) return;
  for (int row = 0; row < tile.height; ++row) {
    for (int x = 0; row + kAhead < tile.height && x < tile.width; x += kLine)
      __builtin_prefetch(plane.row(tile.y + row + kAhead) + tile.x + x, 1);
    for (int x = 0; x < tile.width; x += int(hn::Lanes(d))) hn::StoreU(hn::Set(d, value), d, plane.row(tile.y + row) + tile.x + x);
  }
}

void ResolveEmpty(const TileBuffers& tile, GBuffer& out) {
  fill(tile, out.depth, std::numeric_limits<float>::infinity());
  for (int c = 0; c < 3; ++c)
    for (Plane<float>* p : {&out.normal[c], &out.albedo[c], &out.emissive[c], &out.position[c]}) fill(tile, *p, 0.0f);
  for (Plane<uint32_t>* p : {&out.triangle, &out.instance, &out.material}) fill(tile, *p, kNoTriangle);
}

void ResolveTile(const SurfaceContext& context, const TileBuffers& tile, GBuffer& out) {
  storeVisibility(*context.view, tile, out);
  const Wanted wanted(out);
  if (!wanted.surfaces() && !wanted.draws) return;
  CellTriangles cell;
  for (int y = 0; y < tile.height; y += kCell) {
    fetchCell(tile, 0, y, out);
    for (int x = 0; x < tile.width; x += kCell) {
      fetchCell(tile, x + kCell, y, out);
      resolveCell(context, tile, x, y, wanted, cell, out);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "obscura/raster/dispatch.h"

namespace obscura::raster {

HWY_EXPORT(ResolveEmpty);
HWY_EXPORT(ResolveTile);

void resolveTile(const SurfaceContext& context, const TileBuffers& tile, bool covered, GBuffer& out, Target target) {
  if (covered) OBSCURA_DISPATCH(ResolveTile, target)(context, tile, out);
  else OBSCURA_DISPATCH(ResolveEmpty, target)(tile, out);
}

}  // namespace obscura::raster
#endif
