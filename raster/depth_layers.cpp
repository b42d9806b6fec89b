#include "obscura/raster/depth_layers.h"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "obscura/raster/depth_layers.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "obscura/raster/rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::raster {
namespace HWY_NAMESPACE {

// Depth of a key and key of a depth: the same formula. 0 - k: a plain negation would give two kinds of zero.
HWY_INLINE VF turned(const View& view, VF k) {
  const DF d;
  return view.perspective ? hn::Div(hn::Set(d, 1.0f), k) : hn::Sub(hn::Zero(d), k);
}

void LimitTile(const View& view, const TileBuffers& first, LayerBehind layer, float separation, TileBuffers& out) {
  const DF d;
  const VF nothing = hn::Set(d, -std::numeric_limits<float>::infinity());
  for (size_t i = 0; i < first.pixels(); i += hn::Lanes(d)) {
    const VF key = hn::Load(d, first.key + i);
    const MF empty = hn::Eq(key, nothing);
    if (layer == LayerBehind::Back) {
      hn::Store(hn::IfThenElse(empty, hn::Neg(nothing), key), d, out.limit + i);
      continue;
    }
    const VF zView = turned(view, key);
    const VF wanted = hn::Add(zView, hn::Set(d, separation)), least = hn::Mul(zView, hn::Set(d, 1.0f + kLeastSeparation));
    const VF behind = hn::IfThenElse(hn::Gt(wanted, least), wanted, least);
    hn::Store(hn::IfThenElse(empty, nothing, turned(view, behind)), d, out.limit + i);
  }
}

void StoreTileDepth(const View& view, const TileBuffers& tile, bool covered, Plane<float>& out) {
  const DF d;
  const VF infinity = hn::Set(d, std::numeric_limits<float>::infinity());
  for (int top = 0; top < tile.height; top += kBlock)
    for (int column = 0; column < tile.width; column += int(hn::Lanes(d))) {
      VF keys[kBlock];
      if (covered) rowsOfBlocks(d, tile.key + tile.at(column, top), keys);
      for (int row = 0; row < std::min(kBlock, tile.height - top); ++row) {
        const VF zView = covered ? hn::IfThenElse(hn::Eq(keys[row], hn::Neg(infinity)), infinity, turned(view, keys[row])) : infinity;
        storeRow(d, zView, tile.x + column, tile.y + top + row, out);
      }
    }
  hwy::FlushStream();
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "obscura/raster/dispatch.h"

namespace obscura::raster {

HWY_EXPORT(LimitTile);
HWY_EXPORT(StoreTileDepth);

void limitTile(const View& view, const TileBuffers& first, bool covered, LayerBehind layer, float separation,
               TileBuffers& out, Target target) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  if (covered) OBSCURA_DISPATCH(LimitTile, target)(view, first, layer, separation, out);
  else std::fill_n(out.limit, first.pixels(), layer == LayerBehind::Back ? kInfinity : -kInfinity);
}

void storeTileDepth(const View& view, const TileBuffers& tile, bool covered, Plane<float>& out, Target target) {
  OBSCURA_DISPATCH(StoreTileDepth, target)(view, tile, covered, out);
}

}  // namespace obscura::raster
#endif
