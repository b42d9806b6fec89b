#include "obscura/raster/tile.h"

#include <algorithm>
#include <limits>
#include <optional>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "obscura/raster/tile.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "obscura/raster/surface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::raster {
namespace HWY_NAMESPACE {

// A triangle whose alpha decides per pixel; its weight planes are those of the last cell.
class MaskedTriangle {
 public:
  MaskedTriangle(const SurfaceContext& context, uint32_t id) : context_(context), draw_(drawOf(context, id)) {
    for (int i = 0; i < 3; ++i) vertex_[i] = draw_.mesh->indices[size_t(id - draw_.firstTriangle) * 3 + size_t(i)];
  }

  // The part of `covered` where alpha reaches the material's cutoff, in the block at pixel (x, y) of the image.
  HWY_NOINLINE MF test(int x, int y, VI lx, VI ly, MF covered) {
    const DF d;
    const DI di;
    const int cellX = x - x % kCell, cellY = y - y % kCell;
    if (cellX != cellX_ || cellY != cellY_) planes_ = weightPlanes(*context_.view, draw_, vertex_, cellX_ = cellX, cellY_ = cellY);
    const VI dx = hn::Add(lx, hn::Set(di, x - cellX)), dy = hn::Add(ly, hn::Set(di, y - cellY));
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

// A triangle as the block loop sees it: edge functions at the upper left pixel of its first block in the tile.
struct Blocks {
  int32_t e[3], a[3], b[3];
  int x, y, columns, rows;  // blocks, from the tile's first; at most 16 a row
  float key0, xGradient, yGradient, keyMin, keyMax;
  float xFromP0, yFromP0;   // that pixel's centre minus p0, exact
  uint32_t id;
};

// One block's pixels of the vector that begins at pixel `first` of every block.
struct PixelVector {
  int first;
  VI lx, ly;         // column and row in the block
  VI offset[3];      // edge functions in the first block
  VF xFromP0, yFromP0;
};

HWY_INLINE PixelVector pixelVector(const Blocks& t, int first) {
  const DF d;
  const DI di;
  PixelVector v;
  v.first = first;
  v.lx = hn::And(hn::Iota(di, first), hn::Set(di, kBlock - 1));
  v.ly = hn::ShiftRight<kBlockBits>(hn::Iota(di, first));
  for (int i = 0; i < 3; ++i)
    v.offset[i] = hn::Add(hn::Add(hn::Set(di, t.e[i]), hn::Mul(v.lx, hn::Set(di, t.a[i]))), hn::Mul(v.ly, hn::Set(di, t.b[i])));
  v.xFromP0 = hn::Add(hn::ConvertTo(d, hn::ShiftLeft<kSubBits>(v.lx)), hn::Set(d, t.xFromP0));
  v.yFromP0 = hn::Add(hn::ConvertTo(d, hn::ShiftLeft<kSubBits>(v.ly)), hn::Set(d, t.yFromP0));
  return v;
}

// masked: null where coverage is all that counts.
template <Keep kKeep>
HWY_INLINE void fillBlock(MaskedTriangle* masked, const Blocks& t, const PixelVector& v, int column, int row, const TileBuffers& out) {
  const DF d;
  const DI di;
  const DU du;
  auto edge = [&](int i) HWY_ATTR { return hn::Add(v.offset[i], hn::Set(di, (t.a[i] * column + t.b[i] * row) * kBlock)); };
  const MI inside = hn::Not(hn::Lt(hn::Or(hn::Or(edge(0), edge(1)), edge(2)), hn::Zero(di)));
  const size_t at = size_t(((t.y + row) * out.columns + t.x + column) * (kBlock * kBlock) + v.first);
  const VF x = hn::Add(v.xFromP0, hn::Set(d, float(column * kBlock * kSub)));
  const VF y = hn::Add(v.yFromP0, hn::Set(d, float(row * kBlock * kSub)));
  const VF keyMin = hn::Set(d, t.keyMin), keyMax = hn::Set(d, t.keyMax);
  VF key = hn::Add(hn::Set(d, t.key0), hn::Add(hn::Mul(hn::Set(d, t.xGradient), x), hn::Mul(hn::Set(d, t.yGradient), y)));
  key = hn::IfThenElse(hn::Gt(key, keyMin), key, keyMin);
  key = hn::IfThenElse(hn::Lt(key, keyMax), key, keyMax);
  const VU id = hn::Set(du, t.id);
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
  if (masked && !hn::AllFalse(d, wins))
    wins = masked->test(out.x + (t.x + column) * kBlock, out.y + (t.y + row) * kBlock, v.lx, v.ly, wins);
  hn::Store(hn::IfThenElse(wins, key, oldKey), d, out.key + at);
  if constexpr (kKeep == Keep::Visibility) hn::Store(hn::IfThenElse(hn::RebindMask(du, wins), id, oldId), du, out.id + at);
}

template <Keep kKeep>
HWY_INLINE void fillBlocks(MaskedTriangle* masked, const Blocks& t, const TileBuffers& out) {
  const DI di;
  constexpr int kLanesPerBlock = kBlock * kBlock;
  const int lanes = int(hn::Lanes(di));
  if (t.columns * t.rows <= 4) {  // most triangles of fine meshes: nearly all their blocks are touched
    for (int first = 0; first < kLanesPerBlock; first += lanes) {
      const PixelVector v = pixelVector(t, first);
      for (int row = 0; row < t.rows; ++row)
        for (int column = 0; column < t.columns; ++column) fillBlock<kKeep>(masked, t, v, column, row, out);
    }
    return;
  }
  // A row of blocks at a time: those where no edge function is negative in all four corners.
  HWY_ALIGN int32_t touched[16 + 16];
  for (int row = 0; row < t.rows; ++row) {
    int count = 0;
    for (int column = 0; column < t.columns; column += lanes) {
      const VI index = hn::Iota(di, column);
      VI outside = hn::Sub(hn::Set(di, t.columns - 1), index);
      for (int i = 0; i < 3; ++i) {
        const int32_t greatest = t.e[i] + t.b[i] * row * kBlock + (kBlock - 1) * (std::max(t.a[i], 0) + std::max(t.b[i], 0));
        outside = hn::Or(outside, hn::Add(hn::Set(di, greatest), hn::Mul(index, hn::Set(di, t.a[i] * kBlock))));
      }
      const MI may = hn::Not(hn::Lt(outside, hn::Zero(di)));
      hn::StoreU(hn::Compress(index, may), di, touched + count);
      count += int(hn::CountTrue(di, may));
    }
    for (int first = 0; count > 0 && first < kLanesPerBlock; first += lanes) {
      const PixelVector v = pixelVector(t, first);
      for (int i = 0; i < count; ++i) fillBlock<kKeep>(masked, t, v, touched[i], row, out);
    }
  }
}

template <Keep kKeep>
HWY_NOINLINE void fillApart(const SurfaceContext& context, bool masked, const Blocks& t, const TileBuffers& out) {
  std::optional<MaskedTriangle> triangle;
  if (masked) triangle.emplace(context, t.id);
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
    MaskedTriangle triangle(context, t.id);
    fillBlocks<kKeep>(&triangle, t, out);
  }
}

// So many blocks, all in the tile.
template <Keep kKeep, int kColumns, int kRows>
HWY_INLINE void rasterFew(const SurfaceContext& context, const SmallTriangle& t, const TileBuffers& out) {
  const int a0 = lowerHalf(t.a), a1 = upperHalf(t.a), b0 = lowerHalf(t.b), b1 = upperHalf(t.b);
  const int x = lowerHalf(t.block) - (out.x >> kBlockBits), y = upperHalf(t.block) - (out.y >> kBlockBits);
  const Blocks c{{t.e[0], t.e[1], t.e[2]}, {a0, a1, -a0 - a1}, {b0, b1, -b0 - b1}, x, y, kColumns, kRows,
                 t.key0, t.xGradient, t.yGradient, t.keyMin, t.keyMax, t.xFromP0, t.yFromP0, t.id};
  if (HWY_UNLIKELY(t.masked)) return fill<kKeep>(context, true, c, out);
  for (int first = 0; first < kBlock * kBlock; first += int(hn::Lanes(DF()))) {
    const PixelVector v = pixelVector(c, first);
    for (int row = 0; row < kRows; ++row)
      for (int column = 0; column < kColumns; ++column) fillBlock<kKeep>(nullptr, c, v, column, row, out);
  }
}

template <Keep kKeep>
HWY_INLINE void rasterSmall(const SurfaceContext& context, const SmallTriangle& t, const TileBuffers& out) {
  Blocks c;
  const int x = lowerHalf(t.block) - (out.x >> kBlockBits), y = upperHalf(t.block) - (out.y >> kBlockBits);
  c.x = std::max(x, 0);
  c.y = std::max(y, 0);
  c.columns = std::min(x + lowerHalf(t.blocks) + 1, out.columns) - c.x;
  c.rows = std::min(y + upperHalf(t.blocks) + 1, (out.height + kBlock - 1) >> kBlockBits) - c.y;
  const int dx = (c.x - x) * kBlock, dy = (c.y - y) * kBlock;
  c.a[0] = lowerHalf(t.a), c.a[1] = upperHalf(t.a), c.a[2] = -c.a[0] - c.a[1];
  c.b[0] = lowerHalf(t.b), c.b[1] = upperHalf(t.b), c.b[2] = -c.b[0] - c.b[1];
  for (int i = 0; i < 3; ++i) c.e[i] = t.e[i] + c.a[i] * dx + c.b[i] * dy;
  c.key0 = t.key0, c.xGradient = t.xGradient, c.yGradient = t.yGradient, c.keyMin = t.keyMin, c.keyMax = t.keyMax;
  c.xFromP0 = t.xFromP0 + float(dx * kSub);
  c.yFromP0 = t.yFromP0 + float(dy * kSub);
  c.id = t.id;
  fill<kKeep>(context, t.masked, c, out);
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
  c.key0 = t.key0, c.xGradient = t.xGradient, c.yGradient = t.yGradient, c.keyMin = t.keyMin, c.keyMax = t.keyMax;
  c.xFromP0 = float(context.view->xCenterSub(x) - t.p0x);
  c.yFromP0 = float(context.view->yCenterSub(y) - t.p0y);
  c.id = t.id;
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
