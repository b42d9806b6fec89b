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

// Where a vector of pixels of a block lies: its first pixel in the image, rows of it that are inside.
struct At {
  int x, y, rows;
};

// Writes a vector of a block's pixels: up to four pixels in each of its rows.
template <class D, class T>
HWY_INLINE void storeRows(D d, hn::Vec<D> v, const At& at, Plane<T>& plane) {
#if HWY_TARGET != HWY_SCALAR  // which has no halves
  if constexpr (hn::MaxLanes(D()) > kBlock) {
    const hn::Half<D> half;
    constexpr int kRows = int(hn::MaxLanes(D())) / kBlock / 2;
    storeRows(half, hn::LowerHalf(half, v), at, plane);
    if (at.rows > kRows) storeRows(half, hn::UpperHalf(half, v), {at.x, at.y + kRows, at.rows - kRows}, plane);
    return;
  }
#endif
  hn::StoreU(v, d, plane.row(at.y) + at.x);
}

HWY_INLINE void store3(const V3& v, const At& at, Plane<float> planes[3]) {
  const DF d;
  if (planes[0].empty()) return;
  storeRows(d, v.x, at, planes[0]);
  storeRows(d, v.y, at, planes[1]);
  storeRows(d, v.z, at, planes[2]);
}

HWY_INLINE void storeDepth(const View& view, VF key, MF covered, VI lx, VI ly, const At& at, GBuffer& out) {
  const DF d;
  const DI di;
  const VF infinity = hn::Set(d, std::numeric_limits<float>::infinity()), zero = hn::Zero(d);
  // 0 - key: a plain negation would give two kinds of zero.
  const VF zView = view.perspective ? hn::Div(hn::Set(d, 1.0f), key) : hn::Sub(zero, key);
  if (!out.depth.empty()) storeRows(d, hn::IfThenElse(covered, zView, infinity), at, out.depth);
  if (out.position[0].empty()) return;
  const VF xc = hn::ConvertTo(d, hn::Add(hn::Set(di, view.xCenterSub(at.x)), hn::ShiftLeft<kSubBits>(lx)));
  const VF yc = hn::ConvertTo(d, hn::Add(hn::Set(di, view.yCenterSub(at.y)), hn::ShiftLeft<kSubBits>(ly)));
  VF px = hn::Div(hn::Sub(xc, hn::Set(d, view.xShiftSub)), hn::Set(d, view.xScaleSub));
  VF py = hn::Div(hn::Sub(yc, hn::Set(d, view.yShiftSub)), hn::Set(d, view.yScaleSub));
  if (view.perspective) {
    px = hn::Mul(px, zView);
    py = hn::Mul(py, zView);
  }
  const V3 none{zero, zero, zero};
  store3(select(covered, {px, py, hn::Sub(zero, zView)}, none), at, out.position);
}

HWY_INLINE void storeDraws(const VectorTriangles& t, const At& at, GBuffer& out) {
  const DU d;
  VU instance = hn::Set(d, kNoTriangle), material = instance;
  for (int k = 0; k < t.count; ++k) {
    const auto mine = hn::RebindMask(d, t.shows(k));
    instance = hn::IfThenElse(mine, hn::Set(d, t.draw(k).instance), instance);
    material = hn::IfThenElse(mine, hn::Set(d, t.draw(k).materialIndex), material);
  }
  if (!out.instance.empty()) storeRows(d, instance, at, out.instance);
  if (!out.material.empty()) storeRows(d, material, at, out.material);
}

HWY_INLINE void resolveCell(const SurfaceContext& context, const TileBuffers& tile, const CellBlocks& blocks, const Wanted& wanted,
                            CellTriangles& cell, GBuffer& out) {
  const DF d;
  const DI di;
  const DU du;
  const bool triangles = wanted.surfaces() || wanted.draws;
  if (triangles) {
    findTriangles(context, tile, blocks, cell);
    describeTriangles(context, wanted.surfaces(), wanted.normal, tile.x + blocks.x * kBlock, tile.y + blocks.y * kBlock, cell);
  }
  int vector = 0, slot = 0;
  for (int row = 0; row < blocks.rows; ++row)
    for (int column = 0; column < blocks.columns; ++column)
      for (int first = 0; first < kBlock * kBlock; first += int(hn::Lanes(d))) {
        const int element = firstOfBlock(tile, blocks.x + column, blocks.y + row) + first, line = first >> kBlockBits;
        const VI lx = hn::And(hn::Iota(di, 0), hn::Set(di, kBlock - 1)), ly = hn::ShiftRight<kBlockBits>(hn::Iota(di, 0));
        const int dx = column * kBlock + first % kBlock, dy = row * kBlock + line;  // from the cell's first pixel
        const At at{tile.x + blocks.x * kBlock + dx, tile.y + blocks.y * kBlock + dy, tile.height - (blocks.y * kBlock + dy)};
        const int count = triangles ? cell.slotEnd[vector] - slot : 0;
        const VU id = hn::Load(du, tile.id + element);
        const VectorTriangles t{cell, cell.slot + slot, count, cell.oneDraw ? std::min(count, 1) : count, id};
        ++vector;
        slot += count;
        if (at.rows <= 0) continue;
        const MF covered = hn::RebindMask(d, hn::Ne(id, hn::Set(du, kNoTriangle)));
        storeDepth(*context.view, hn::Load(d, tile.key + element), covered, lx, ly, at, out);
        if (!out.triangle.empty()) storeRows(du, id, at, out.triangle);
        if (wanted.draws) storeDraws(t, at, out);
        if (!wanted.surfaces()) continue;
        const Shaded s = shade(context, wanted, t, covered, hn::ConvertTo(d, hn::Add(lx, hn::Set(di, dx))),
                               hn::ConvertTo(d, hn::Add(ly, hn::Set(di, dy))));
        store3(s.normal, at, out.normal);
        store3(s.albedo, at, out.albedo);
        store3(s.emissive, at, out.emissive);
      }
}

void ResolveTile(const SurfaceContext& context, const TileBuffers& tile, GBuffer& out) {
  const Wanted wanted(out);
  CellTriangles cell;
  for (int y = 0; y < tile.height; y += kCell)
    for (int x = 0; x < tile.width; x += kCell) resolveCell(context, tile, blocksOf(tile, x, y), wanted, cell, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "obscura/raster/dispatch.h"

namespace obscura::raster {

HWY_EXPORT(ResolveTile);

namespace {

template <class T>
void fill(const TileBuffers& tile, Plane<T>& plane, T value) {
  if (plane.empty()) return;
  for (int row = 0; row < tile.height; ++row) std::fill_n(plane.row(tile.y + row) + tile.x, tile.width, value);
}

void resolveEmpty(const TileBuffers& tile, GBuffer& out) {
  fill(tile, out.depth, std::numeric_limits<float>::infinity());
  for (int c = 0; c < 3; ++c)
    for (Plane<float>* p : {&out.normal[c], &out.albedo[c], &out.emissive[c], &out.position[c]}) fill(tile, *p, 0.0f);
  for (Plane<uint32_t>* p : {&out.triangle, &out.instance, &out.material}) fill(tile, *p, kNoTriangle);
}

}  // namespace

void resolveTile(const SurfaceContext& context, const TileBuffers& tile, bool covered, GBuffer& out, Target target) {
  if (covered) OBSCURA_DISPATCH(ResolveTile, target)(context, tile, out);
  else resolveEmpty(tile, out);
}

}  // namespace obscura::raster
#endif
