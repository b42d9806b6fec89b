#include "obscura/raster/tile.h"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "obscura/raster/tile.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "obscura/raster/surface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::raster {
namespace HWY_NAMESPACE {

// The part of `covered` where the triangle's alpha reaches the material's cutoff.
HWY_NOINLINE MF alphaTest(const SurfaceContext& context, const Draw& draw, uint32_t id, VI x, int y, MF covered) {
  const DF d;
  const DI di;
  const View& view = *context.view;
  const VI xc = hn::Add(hn::ShiftLeft<kSubBits>(x), hn::Set(di, view.xCenterSub(0)));
  const Seen s = seePixel(view, draw, hn::Set(di, int32_t(id - draw.firstTriangle)), hn::ConvertTo(d, xc),
                          hn::Set(d, float(view.yCenterSub(y))));
  return hn::And(covered, hn::Ge(baseColor(context, draw, s).a, hn::Set(d, draw.material->alphaCutoff)));
}

// A triangle as the pixel loop sees it, in one tile: edge functions at (x0, y0), all in 32 bits.
struct Clipped {
  int32_t e[3], a[3], b[3];
  int x0, y0, x1, y1;  // inclusive, image pixels
  float key0, xGradient, yGradient, keyMin, keyMax;
  float xFromP0, yFromP0;  // centre of (x0, y0) minus p0, exact
  uint32_t id;
  bool masked;
};

HWY_INLINE void fill(const SurfaceContext& context, const Clipped& t, TileBuffers& out) {
  const DF d;
  const DI di;
  const DU du;
  const int lanes = int(hn::Lanes(d));
  const VI iota = hn::Iota(di, 0);
  VI a[3], e[3];
  for (int i = 0; i < 3; ++i) {
    a[i] = hn::Mul(iota, hn::Set(di, t.a[i]));
    e[i] = hn::Add(hn::Set(di, t.e[i]), a[i]);
  }
  const VF key0 = hn::Set(d, t.key0), xGradient = hn::Set(d, t.xGradient);
  const VF keyMin = hn::Set(d, t.keyMin), keyMax = hn::Set(d, t.keyMax);
  const VF xIota = hn::ConvertTo(d, hn::ShiftLeft<kSubBits>(iota));
  const VU id = hn::Set(du, t.id);
  for (int y = t.y0; y <= t.y1; ++y) {
    float* keyRow = out.key + size_t(y - out.y) * TileBuffers::kStride + (t.x0 - out.x);
    uint32_t* idRow = out.id + size_t(y - out.y) * TileBuffers::kStride + (t.x0 - out.x);
    const VF yTerm = hn::Mul(hn::Set(d, t.yGradient), hn::Set(d, t.yFromP0 + float((y - t.y0) * kSub)));
    VI row[3] = {e[0], e[1], e[2]};
    for (int x = 0; x <= t.x1 - t.x0; x += lanes) {
      const MI inside = hn::Not(hn::Lt(hn::Or(hn::Or(row[0], row[1]), row[2]), hn::Zero(di)));
      if (!hn::AllFalse(di, inside)) {
        const VF fromP0 = hn::Add(xIota, hn::Set(d, t.xFromP0 + float(x * kSub)));
        VF key = hn::Add(key0, hn::Add(hn::Mul(xGradient, fromP0), yTerm));
        key = hn::IfThenElse(hn::Gt(key, keyMin), key, keyMin);
        key = hn::IfThenElse(hn::Lt(key, keyMax), key, keyMax);
        const VF oldKey = hn::LoadU(d, keyRow + x);
        const VU oldId = hn::LoadU(du, idRow + x);
        const MF nearer = hn::Or(hn::Gt(key, oldKey), hn::And(hn::Eq(key, oldKey), hn::RebindMask(d, hn::Lt(id, oldId))));
        MF wins = hn::And(nearer, hn::RebindMask(d, inside));
        if (HWY_UNLIKELY(t.masked) && !hn::AllFalse(d, wins))
          wins = alphaTest(context, drawOf(context, t.id), t.id, hn::Iota(di, t.x0 + x), y, wins);
        hn::StoreU(hn::IfThenElse(wins, key, oldKey), d, keyRow + x);
        hn::StoreU(hn::IfThenElse(hn::RebindMask(du, wins), id, oldId), du, idRow + x);
      }
      for (int i = 0; i < 3; ++i) row[i] = hn::Add(row[i], hn::Set(di, t.a[i] * lanes));
    }
    for (int i = 0; i < 3; ++i) e[i] = hn::Add(e[i], hn::Set(di, t.b[i]));
  }
}

HWY_INLINE void rasterSmall(const SurfaceContext& context, const SmallTriangle& t, TileBuffers& out) {
  Clipped c;
  c.x0 = std::max<int>(t.x, out.x);
  c.y0 = std::max<int>(t.y, out.y);
  c.x1 = std::min(t.x + t.width, out.x + out.width) - 1;
  c.y1 = std::min(t.y + t.height, out.y + out.height) - 1;
  const int dx = c.x0 - t.x, dy = c.y0 - t.y;
  c.a[0] = t.a[0], c.a[1] = t.a[1], c.a[2] = -t.a[0] - t.a[1];
  c.b[0] = t.b[0], c.b[1] = t.b[1], c.b[2] = -t.b[0] - t.b[1];
  for (int i = 0; i < 3; ++i) c.e[i] = t.e[i] + c.a[i] * dx + c.b[i] * dy;
  c.key0 = t.key0, c.xGradient = t.xGradient, c.yGradient = t.yGradient, c.keyMin = t.keyMin, c.keyMax = t.keyMax;
  c.xFromP0 = t.xFromP0 + float(dx * kSub);
  c.yFromP0 = t.yFromP0 + float(dy * kSub);
  c.id = t.id;
  c.masked = t.masked != 0;
  fill(context, c, out);
}

HWY_INLINE void rasterLarge(const SurfaceContext& context, const LargeTriangle& t, TileBuffers& out) {
  Clipped c;
  c.x0 = std::max(t.x0, out.x);
  c.y0 = std::max(t.y0, out.y);
  c.x1 = std::min(t.x1, out.x + out.width - 1);
  c.y1 = std::min(t.y1, out.y + out.height - 1);
  for (int i = 0; i < 3; ++i) {
    const int64_t e = (t.e[i] + (int64_t(t.a[i]) * c.x0 + int64_t(t.b[i]) * c.y0) * kSub) >> kSubBits;
    c.e[i] = int32_t(std::clamp(e, -kEdgeLimit, kEdgeLimit));
    c.a[i] = t.a[i];
    c.b[i] = t.b[i];
  }
  c.key0 = t.key0, c.xGradient = t.xGradient, c.yGradient = t.yGradient, c.keyMin = t.keyMin, c.keyMax = t.keyMax;
  c.xFromP0 = float(context.view->xCenterSub(c.x0) - t.p0x);
  c.yFromP0 = float(context.view->yCenterSub(c.y0) - t.p0y);
  c.id = t.id;
  c.masked = t.masked;
  fill(context, c, out);
}

void RasterTile(const SurfaceContext& context, int tile, Span<const Bins> bins, TileBuffers& out) {
  const size_t elements = size_t(out.height) * TileBuffers::kStride;
  std::fill_n(out.key, elements, -std::numeric_limits<float>::infinity());
  std::fill_n(out.id, elements, kNoTriangle);
  for (const Bins& b : bins) {
    for (uint32_t index : b.large(tile)) rasterLarge(context, b.triangle(index), out);
    for (const SmallTriangle& t : b.small(tile)) rasterSmall(context, t, out);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "obscura/raster/dispatch.h"

namespace obscura::raster {

HWY_EXPORT(RasterTile);

bool rasterTile(const SurfaceContext& context, const TileGrid& grid, int tile, Span<const Bins> bins, TileBuffers& out,
                Target target) {
  out.x = (tile % grid.columns) << grid.tileBits;
  out.y = (tile / grid.columns) << grid.tileBits;
  out.width = std::min(1 << grid.tileBits, grid.width - out.x);
  out.height = std::min(1 << grid.tileBits, grid.height - out.y);
  const bool any = std::any_of(bins.begin(), bins.end(), [&](const Bins& b) { return !b.small(tile).empty() || !b.large(tile).empty(); });
  if (any) OBSCURA_DISPATCH(RasterTile, target)(context, tile, bins, out);
  return any;
}

}  // namespace obscura::raster
#endif
