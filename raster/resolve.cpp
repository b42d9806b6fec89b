#include "obscura/raster/resolve.h"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "obscura/raster/resolve.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "obscura/raster/rows-inl.h"
#include "obscura/raster/shade-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::raster {
namespace HWY_NAMESPACE {

// One row of depth, position and triangle ids.
HWY_INLINE void storeVisible(const View& view, VF key, VU id, int x, int y, GBuffer& out) {
  const DF d;
  const DI di;
  const DU du;
  const VF infinity = hn::Set(d, std::numeric_limits<float>::infinity()), zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const MF covered = hn::RebindMask(d, hn::Ne(id, hn::Set(du, kNoTriangle)));
  // 0 - key: a plain negation would give two kinds of zero.
  const VF zView = view.perspective ? hn::Div(one, key) : hn::Sub(zero, key);
  if (!out.triangle.empty()) storeRow(du, id, x, y, out.triangle);
  if (!out.depth.empty()) storeRow(d, hn::IfThenElse(covered, zView, infinity), x, y, out.depth);
  if (out.position[0].empty()) return;
  const VF xc = hn::ConvertTo(d, hn::Add(hn::Set(di, view.xCenterSub(x)), hn::ShiftLeft<kSubBits>(hn::Iota(di, 0))));
  VF px = hn::Div(hn::Sub(xc, hn::Set(d, view.xShiftSub)), hn::Set(d, view.xScaleSub));
  VF py = hn::Div(hn::Set(d, float(view.yCenterSub(y)) - view.yShiftSub), hn::Set(d, view.yScaleSub));
  if (view.perspective) {
    px = hn::Mul(px, zView);
    py = hn::Mul(py, zView);
  }
  storeRow(d, hn::IfThenElseZero(covered, px), x, y, out.position[0]);
  storeRow(d, hn::IfThenElseZero(covered, py), x, y, out.position[1]);
  storeRow(d, hn::IfThenElseZero(covered, hn::Sub(zero, zView)), x, y, out.position[2]);
}

// Depth, position and triangle ids need nothing but the visibility: whole rows, as memory likes it.
HWY_INLINE void storeVisibility(const View& view, const TileBuffers& tile, GBuffer& out) {
  const DF d;
  const DU du;
  for (int top = 0; top < tile.height; top += kBlock) {
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
  HWY_ALIGN float normal[3][kPixels], facet[3][kPixels], albedo[3][kPixels], emissive[3][kPixels], metallic[kPixels], roughness[kPixels];
  HWY_ALIGN uint32_t instance[kPixels], material[kPixels];
};

template <class T>
HWY_INLINE void storePlane(const T* blocks, int x, int y, int rows, Plane<T>& plane) {
  const hn::Rebind<T, DF> d;
  if (plane.empty()) return;
  for (int column = 0; column < kCell; column += int(hn::MaxLanes(d))) {
    hn::Vec<decltype(d)> row[kBlock];
    rowsOfBlocks(d, blocks + elementOf(column), row);
    storeRow(d, row[0], x + column, y, plane);
    if (rows > 1) storeRow(d, row[1], x + column, y + 1, plane);
    if (rows > 2) storeRow(d, row[2], x + column, y + 2, plane);
    if (rows > 3) storeRow(d, row[3], x + column, y + 3, plane);
  }
}

// x, y: of the image; rows: that are inside of it.
HWY_INLINE void storeStrip(const Strip& s, const Wanted& wanted, int x, int y, int rows, GBuffer& out) {
  for (int c = 0; c < 3 && wanted.surfaces(); ++c) {
    storePlane(s.normal[c], x, y, rows, out.normal[c]);
    storePlane(s.facet[c], x, y, rows, out.facet[c]);
    storePlane(s.albedo[c], x, y, rows, out.albedo[c]);
    storePlane(s.emissive[c], x, y, rows, out.emissive[c]);
  }
  storePlane(s.metallic, x, y, rows, out.metallic);
  storePlane(s.roughness, x, y, rows, out.roughness);
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

// Attributes of the cell whose first pixel is (left, top) of the tile.
HWY_INLINE void resolveCell(const SurfaceContext& context, const TileBuffers& tile, int left, int top, const Wanted& wanted,
                            CellTriangles& cell, GBuffer& out) {
  const DF d;
  const DI di;
  const DU du;
  const CellBlocks blocks = blocksOf(tile, left, top);
  findTriangles(context, tile, blocks, cell);
  describeTriangles(context, wanted, tile.x + left, tile.y + top, cell);
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
        if (wanted.facet) keep(s.facet, strip.facet, at);
        if (wanted.albedo) keep(s.albedo, strip.albedo, at);
        if (wanted.emissive) keep(s.emissive, strip.emissive, at);
        if (!wanted.gloss) continue;
        hn::Store(s.gloss.metallic, d, strip.metallic + at);
        hn::Store(s.gloss.roughness, d, strip.roughness + at);
      }
    const int y = top + row * kBlock;
    storeStrip(strip, wanted, tile.x + left, tile.y + y, std::min(kBlock, tile.height - y), out);
  }
}

template <class T>
HWY_INLINE void fill(const TileBuffers& tile, Plane<T>& plane, T value) {
  const hn::Rebind<T, DF> d;
  if (plane.empty()) return;
  for (int row = 0; row < tile.height; ++row)
    for (int x = 0; x < tile.width; x += int(hn::Lanes(d))) storeRow(d, hn::Set(d, value), tile.x + x, tile.y + row, plane);
}

void ResolveEmpty(const TileBuffers& tile, GBuffer& out) {
  fill(tile, out.depth, std::numeric_limits<float>::infinity());
  for (int c = 0; c < 3; ++c)
    for (Plane<float>* p : {&out.normal[c], &out.facet[c], &out.albedo[c], &out.emissive[c], &out.position[c]}) fill(tile, *p, 0.0f);
  for (Plane<float>* p : {&out.metallic, &out.roughness}) fill(tile, *p, 0.0f);
  for (Plane<uint32_t>* p : {&out.triangle, &out.instance, &out.material}) fill(tile, *p, kNoTriangle);
  hwy::FlushStream();
}

void ResolveTile(const SurfaceContext& context, const TileBuffers& tile, GBuffer& out) {
  storeVisibility(*context.view, tile, out);
  const Wanted wanted(out);
  if (wanted.surfaces() || wanted.draws) {
    CellTriangles cell;
    for (int y = 0; y < tile.height; y += kCell)
      for (int x = 0; x < tile.width; x += kCell) resolveCell(context, tile, x, y, wanted, cell, out);
  }
  hwy::FlushStream();
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
