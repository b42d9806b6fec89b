#include "obscura/raster/tile.h"

#include <algorithm>
#include <limits>
#include <optional>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "obscura/raster/tile.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "obscura/raster/block-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::raster {
namespace HWY_NAMESPACE {

template <Keep kKeep>
HWY_NOINLINE void fillApart(const SurfaceContext& context, bool masked, const Blocks& t, const TileBuffers& out) {
  std::optional<MaskedTriangle> triangle;
  if (masked) triangle.emplace(context, t.plane.id);
  fillBlocks<kKeep>(masked ? &*triangle : nullptr, t, out);
}

// Where ids are kept the loops are there twice for each caller, with masks and without; elsewhere once, which compiles in
// half of the time.
template <Keep kKeep>
HWY_INLINE void fill(const SurfaceContext& context, bool masked, const Blocks& t, const TileBuffers& out) {
  if constexpr (kKeep != Keep::Visibility) {
    fillApart<kKeep>(context, masked, t, out);
  } else if (HWY_LIKELY(!masked)) {
    fillBlocks<kKeep>(nullptr, t, out);
  } else {
    MaskedTriangle triangle(context, t.plane.id);
    fillBlocks<kKeep>(&triangle, t, out);
  }
}

template <Keep kKeep>
HWY_NOINLINE void rasterSmall(const SurfaceContext& context, const SmallTriangle& t, const TileBuffers& out) {
  const int x = lowerHalf(t.block) - (out.x >> kBlockBits), y = upperHalf(t.block) - (out.y >> kBlockBits);
  if (HWY_LIKELY(t.columns() <= kBlock && t.rows() <= kBlock && !t.masked())) return fillSmall<kKeep>(t, x, y, out);
  Blocks c;
  c.x = std::max(x, 0);
  c.y = std::max(y, 0);
  c.columns = std::min(x + t.columns(), out.columns) - c.x;
  c.rows = std::min(y + t.rows(), (out.height + kBlock - 1) >> kBlockBits) - c.y;
  const int dx = (c.x - x) * kBlock, dy = (c.y - y) * kBlock;
  for (int i = 0; i < 3; ++i) {
    c.a[i] = lowerHalf(t.ab[i]);
    c.b[i] = upperHalf(t.ab[i]);
    c.e[i] = t.e[i] + c.a[i] * dx + c.b[i] * dy;
  }
  c.plane = {t.key0, t.xGradient, t.yGradient, t.keyMin, t.keyMax, t.id};
  c.xFromP0 = t.xFromP0 + float(dx * kSub);
  c.yFromP0 = t.yFromP0 + float(dy * kSub);
  fill<kKeep>(context, t.masked(), c, out);
}

// So many blocks, all in the tile.
template <Keep kKeep, int kColumns, int kRows>
HWY_INLINE void rasterFew(const SurfaceContext& context, const SmallTriangle& t, const TileBuffers& out) {
  if (HWY_UNLIKELY(t.masked())) return rasterSmall<kKeep>(context, t, out);
  fillFew<kKeep, kColumns, kRows>(t, out);
}

template <Keep kKeep>
HWY_INLINE void rasterLarge(const SurfaceContext& context, const LargeTriangle& t, const TileBuffers& out) {
  Blocks c;
  const int x0 = std::max(t.x0, out.x), y0 = std::max(t.y0, out.y);
  const int x1 = std::min(t.x1, out.x + out.width - 1), y1 = std::min(t.y1, out.y + out.height - 1);
  c.x = (x0 - out.x) >> kBlockBits;
  c.y = (y0 - out.y) >> kBlockBits;
  c.columns = ((x1 - out.x) >> kBlockBits) - c.x + 1;
  c.rows = ((y1 - out.y) >> kBlockBits) - c.y + 1;
  const int x = out.x + c.x * kBlock, y = out.y + c.y * kBlock;
  for (int i = 0; i < 3; ++i) {
    const int64_t e = (t.e[i] + (int64_t(t.a[i]) * x + int64_t(t.b[i]) * y) * kSub) >> kSubBits;
    c.e[i] = int32_t(std::clamp(e, -kEdgeLimit, kEdgeLimit));
    c.a[i] = t.a[i];
    c.b[i] = t.b[i];
  }
  c.plane = {t.key0, t.xGradient, t.yGradient, t.keyMin, t.keyMax, t.id};
  c.xFromP0 = float(context.view->xCenterSub(x) - t.p0x);
  c.yFromP0 = float(context.view->yCenterSub(y) - t.p0y);
  fill<kKeep>(context, t.masked, c, out);
}

template <Keep kKeep>
HWY_NOINLINE void rasterBins(const SurfaceContext& context, int tile, Span<const Bins> bins, const TileBuffers& buffers) {
  const TileBuffers out = buffers;  // of our own: vector stores might change any other
  for (const Bins& b : bins) {
    for (uint32_t index : b.large(tile)) rasterLarge<kKeep>(context, b.triangle(index), out);
    for (const SmallTriangle& t : b.small(Bins::kAnySize, tile)) rasterSmall<kKeep>(context, t, out);
    for (const SmallTriangle& t : b.small(Bins::kTwoByTwo, tile)) rasterFew<kKeep, 2, 2>(context, t, out);
    for (const SmallTriangle& t : b.small(Bins::kTwoAcross, tile)) rasterFew<kKeep, 2, 1>(context, t, out);
    for (const SmallTriangle& t : b.small(Bins::kTwoDown, tile)) rasterFew<kKeep, 1, 2>(context, t, out);
    for (const SmallTriangle& t : b.small(Bins::kOne, tile)) rasterFew<kKeep, 1, 1>(context, t, out);
  }
}

void ClearTile(Keep keep, const TileBuffers& tile) {
  const DF d;
  const DU du;
  const VF nothing = hn::Set(d, -std::numeric_limits<float>::infinity());
  for (size_t i = 0; i < tile.pixels(); i += hn::Lanes(d)) {
    hn::Store(nothing, d, tile.key + i);
    if (keep == Keep::Visibility) hn::Store(hn::Set(du, kNoTriangle), du, tile.id + i);
  }
}

void RasterTile(const SurfaceContext& context, int tile, Span<const Bins> bins, Keep keep, const TileBuffers& out) {
  switch (keep) {
    case Keep::Visibility: return rasterBins<Keep::Visibility>(context, tile, bins, out);
    case Keep::Key: return rasterBins<Keep::Key>(context, tile, bins, out);
    case Keep::KeyWithinLimit: return rasterBins<Keep::KeyWithinLimit>(context, tile, bins, out);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "obscura/raster/dispatch.h"

namespace obscura::raster {

HWY_EXPORT(ClearTile);
HWY_EXPORT(RasterTile);

void TileMemory::reserve(size_t tiles, int tileBits) {
  tileBits_ = tileBits;
  const size_t pixels = tiles << (2 * tileBits);
  if (pixels <= size_t(keys_.width())) return;
  keys_ = Plane<float>(int(pixels), 1);
  ids_ = Plane<uint32_t>(int(pixels), 1);
}

TileBuffers placeTile(const TileGrid& grid, int tile, TileMemory& memory, size_t place) {
  TileBuffers t;
  t.key = memory.key(place);
  t.id = memory.id(place);
  t.x = (tile % grid.columns) << grid.tileBits;
  t.y = (tile / grid.columns) << grid.tileBits;
  t.width = std::min(1 << grid.tileBits, grid.width - t.x);
  t.height = std::min(1 << grid.tileBits, grid.height - t.y);
  t.columns = (1 << grid.tileBits) >> kBlockBits;
  return t;
}

void clearTile(Keep keep, TileBuffers& tile, Target target) { OBSCURA_DISPATCH(ClearTile, target)(keep, tile); }

void rasterTile(const SurfaceContext& context, int tile, Span<const Bins> bins, Keep keep, TileBuffers& out, Target target) {
  OBSCURA_DISPATCH(RasterTile, target)(context, tile, bins, keep, out);
}

}  // namespace obscura::raster
#endif
