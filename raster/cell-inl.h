// Per-target: the triangles seen in a cell, each once, with what its pixels need of it. A triangle of a fine mesh shows
// in several pixels; what is the same in all of them is computed and gathered once.
#if defined(OBSCURA_CELL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef OBSCURA_CELL_INL_H_
#undef OBSCURA_CELL_INL_H_
#else
#define OBSCURA_CELL_INL_H_
#endif

#include <algorithm>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "obscura/raster/normal-inl.h"
#include "obscura/raster/tile.h"
#include "obscura/raster/wanted-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::raster {
namespace HWY_NAMESPACE {

constexpr int kCellPixels = kCell * kCell;

struct CellTriangles {
  static constexpr int kRoom = kCellPixels + 16;  // written a vector at a time
  int count = 0;
  HWY_ALIGN uint32_t id[kRoom];
  HWY_ALIGN int32_t vertex[3][kRoom];
  HWY_ALIGN float c[3][kRoom], gx[3][kRoom], gy[3][kRoom];  // weight planes
  HWY_ALIGN float normal[9][kRoom];  // x, y, z of corner 0, of corner 1 - corner 0, of corner 2 - corner 0; camera space
  HWY_ALIGN float facet[3][kRoom];   // alike: the triangle's own
  const Draw* draw[kRoom];
  bool oneDraw = true;               // all triangles are of the same
  // Vectors of pixels in the order of the tile's memory: numbers of the triangles that each shows.
  uint16_t slot[kCellPixels];
  uint16_t slotEnd[kCellPixels];  // end in `slot` of each vector's numbers
};

// Looks a triangle's number up by its id, or gives it the next one.
class CellTable {
 public:
  CellTable() { std::fill_n(slotOf_, kSize, kFree); }
  int find(CellTriangles& cell, uint32_t id) {
    uint32_t at = (id * 0x9E3779B1u) >> (32 - kBits);
    while (slotOf_[at] != kFree && cell.id[slotOf_[at]] != id) at = (at + 1) % kSize;
    if (slotOf_[at] == kFree) {
      slotOf_[at] = uint16_t(cell.count);
      cell.id[cell.count++] = id;
    }
    return slotOf_[at];
  }

 private:
  static constexpr int kBits = 9, kSize = 1 << kBits;  // at most half full
  static constexpr uint16_t kFree = 0xFFFF;
  uint16_t slotOf_[kSize];
};

// Blocks of a cell that lie in the tile's part of the image.
struct CellBlocks {
  int x, y, columns, rows;  // in blocks from the tile's first
};

// Of the cell whose first pixel is (left, top) of the tile.
HWY_INLINE CellBlocks blocksOf(const TileBuffers& tile, int left, int top) {
  constexpr int kBlocks = kCell / kBlock;
  const int x = left >> kBlockBits, y = top >> kBlockBits;
  const int columns = ((tile.width - 1) >> kBlockBits) + 1, rows = ((tile.height - 1) >> kBlockBits) + 1;
  return {x, y, std::min(kBlocks, columns - x), std::min(kBlocks, rows - y)};
}

// Element of the first pixel of a block.
HWY_INLINE int firstOfBlock(const TileBuffers& tile, int x, int y) { return (y * tile.columns + x) << (2 * kBlockBits); }

// With the draw and, on the way, the vertex indices of each.
HWY_INLINE void findTriangles(const SurfaceContext& context, const TileBuffers& tile, const CellBlocks& blocks,
                              CellTriangles& cell) {
  const DU d;
  const VU none = hn::Set(d, kNoTriangle);
  CellTable table;
  cell.count = 0;
  cell.oneDraw = true;
  const Draw* last = nullptr;
  int vectors = 0, slots = 0;
  for (int y = 0; y < blocks.rows; ++y)
    for (int x = 0; x < blocks.columns; ++x) {
      const uint32_t* block = tile.id + firstOfBlock(tile, blocks.x + x, blocks.y + y);
      for (int first = 0; first < kBlock * kBlock; first += int(hn::Lanes(d))) {
        const VU id = hn::Load(d, block + first);
        auto rest = hn::Ne(id, none);
        while (!hn::AllFalse(d, rest)) {
          const uint32_t one = block[first + int(hn::FindKnownFirstTrue(d, rest))];
          const int before = cell.count, slot = table.find(cell, one);
          cell.slot[slots++] = uint16_t(slot);
          if (slot == before) {
            cell.draw[slot] = last = &drawOf(context, one, last);
            cell.oneDraw &= last == cell.draw[0];
            hwy::Prefetch(last->mesh->indices.data() + size_t(one - last->firstTriangle) * 3);
          }
          rest = hn::AndNot(hn::Eq(id, hn::Set(d, one)), rest);
        }
        cell.slotEnd[vectors++] = uint16_t(slots);
      }
    }
}

// Coefficients of the weight planes, by the vector form of weightPlanes(), of 16 triangles at most.
struct PlaneInput {
  HWY_ALIGN float x[3][16], y[3][16], z[3][16];  // corners, object space
};
struct PlaneOutput {
  HWY_ALIGN float c[3][16], gx[3][16], gy[3][16];
};

HWY_INLINE void weightPlanesOf(const View& view, const Draw& draw, const PlaneInput& in, int x, int y, PlaneOutput& out) {
  const hn::CappedTag<double, 8> d;
  const hn::Rebind<float, decltype(d)> df;
  using V = hn::Vec<decltype(d)>;
  const V xc = hn::Set(d, double(view.xCenterSub(x)) - double(view.xShiftSub));
  const V yc = hn::Set(d, double(view.yCenterSub(y)) - double(view.yShiftSub));
  const V xScale = hn::Set(d, double(view.xScaleSub)), yScale = hn::Set(d, double(view.yScaleSub));
  const V perPixel = hn::Set(d, double(kSub));
  for (int t = 0; t < int(hn::Lanes(DF())); t += int(hn::Lanes(d))) {
    auto real = [&](const float* p) HWY_ATTR { return hn::PromoteTo(d, hn::Load(df, p + t)); };
    V w[3], hx[3], hy[3], c[3], gx[3], gy[3];
    for (int i = 0; i < 3; ++i) {
      const V px = real(in.x[i]), py = real(in.y[i]), pz = real(in.z[i]);
      auto row = [&](const float m[4]) HWY_ATTR {
        const V sum = hn::Add(hn::Add(hn::Mul(hn::Set(d, m[0]), px), hn::Mul(hn::Set(d, m[1]), py)), hn::Mul(hn::Set(d, m[2]), pz));
        return hn::Add(sum, hn::Set(d, m[3]));
      };
      w[i] = view.perspective ? hn::Neg(row(draw.viewFromObject[2])) : hn::Set(d, 1.0);
      hx[i] = hn::Sub(hn::Mul(row(draw.viewFromObject[0]), xScale), hn::Mul(w[i], xc));
      hy[i] = hn::Sub(hn::Mul(row(draw.viewFromObject[1]), yScale), hn::Mul(w[i], yc));
    }
    V largest = hn::Zero(d);
    auto grow = [&](V v) HWY_ATTR { largest = hn::IfThenElse(hn::Gt(hn::Abs(v), largest), hn::Abs(v), largest); };
    for (int i = 0; i < 3; ++i) {
      const int j = i == 2 ? 0 : i + 1, k = i == 0 ? 2 : i - 1;
      c[i] = hn::Sub(hn::Mul(hx[j], hy[k]), hn::Mul(hy[j], hx[k]));
      gx[i] = hn::Mul(hn::Sub(hn::Mul(w[k], hy[j]), hn::Mul(w[j], hy[k])), perPixel);
      gy[i] = hn::Mul(hn::Sub(hn::Mul(w[j], hx[k]), hn::Mul(w[k], hx[j])), perPixel);
      grow(c[i]);
      grow(gx[i]);
      grow(gy[i]);
    }
    const V scale = hn::Div(hn::Set(d, 1.0), largest);
    auto store = [&](V v, float* p) HWY_ATTR { hn::Store(hn::DemoteTo(df, hn::Mul(v, scale)), df, p + t); };
    for (int i = 0; i < 3; ++i) {
      store(c[i], out.c[i]);
      store(gx[i], out.gx[i]);
      store(gy[i], out.gy[i]);
    }
  }
}

// The triangles `mine` of the vector from number `first`, all of `draw`.
HWY_INLINE void describeVector(const View& view, const Draw& draw, const Wanted& wanted, int x, int y, int first, MI mine,
                               CellTriangles& cell) {
  const DF d;
  const DI di;
  const MF lanes = hn::RebindMask(d, mine);
  const VI id = hn::Load(di, reinterpret_cast<const int32_t*>(cell.id) + first);
  const VI triangle = hn::IfThenElseZero(mine, hn::Sub(id, hn::Set(di, int32_t(draw.firstTriangle))));
  Seen s;
  s.one = false;
  gatherVertices(draw, triangle, s);
  const V3 object[3] = {corner3(s, draw.mesh->positions, 0), corner3(s, draw.mesh->positions, 1), corner3(s, draw.mesh->positions, 2)};
  PlaneInput in;
  PlaneOutput planes;
  for (int i = 0; i < 3; ++i) {
    hn::Store(object[i].x, d, in.x[i]);
    hn::Store(object[i].y, d, in.y[i]);
    hn::Store(object[i].z, d, in.z[i]);
  }
  weightPlanesOf(view, draw, in, x, y, planes);
  for (int i = 0; i < 3; ++i) {
    hn::BlendedStore(s.index[i], mine, di, cell.vertex[i] + first);
    hn::BlendedStore(hn::Load(d, planes.c[i]), lanes, d, cell.c[i] + first);
    hn::BlendedStore(hn::Load(d, planes.gx[i]), lanes, d, cell.gx[i] + first);
    hn::BlendedStore(hn::Load(d, planes.gy[i]), lanes, d, cell.gy[i] + first);
  }
  V3 n[3];
  if (wanted.facet) {
    const V3 f = flatNormal(draw, object);
    hn::BlendedStore(f.x, lanes, d, cell.facet[0] + first);
    hn::BlendedStore(f.y, lanes, d, cell.facet[1] + first);
    hn::BlendedStore(f.z, lanes, d, cell.facet[2] + first);
  }
  if (!wanted.normal) return;
  const bool smooth = !draw.mesh->normals.empty();
  if (!smooth) n[0] = flatNormal(draw, object);
  for (int i = 0; i < 3; ++i) n[i] = smooth ? rotate(draw.normalToView, corner3(s, draw.mesh->normals, i)) : n[0];
  n[1] = sub(n[1], n[0]);
  n[2] = sub(n[2], n[0]);
  for (int i = 0; i < 3; ++i) {
    hn::BlendedStore(n[i].x, lanes, d, cell.normal[3 * i] + first);
    hn::BlendedStore(n[i].y, lanes, d, cell.normal[3 * i + 1] + first);
    hn::BlendedStore(n[i].z, lanes, d, cell.normal[3 * i + 2] + first);
  }
}

// Fills what findTriangles left open; x, y: the cell's first pixel.
HWY_INLINE void describeTriangles(const SurfaceContext& context, const Wanted& wanted, int x, int y, CellTriangles& cell) {
  const DI di;
  const DU du;
  const int lanes = int(hn::Lanes(di));
  if (!wanted.surfaces()) return;
  for (int k = 0; k < cell.count; ++k) {
    const Draw& draw = *cell.draw[k];
    const size_t triangle = cell.id[k] - draw.firstTriangle;
    for (int i = 0; i < 3; ++i) {
      const uint32_t v = draw.mesh->indices[triangle * 3 + size_t(i)];
      hwy::Prefetch(draw.mesh->positions.data() + v);
      if (!draw.mesh->normals.empty()) hwy::Prefetch(draw.mesh->normals.data() + v);
    }
  }
  for (int first = 0; first < cell.count; first += lanes) {
    const VU id = hn::Load(du, cell.id + first);
    MI rest = hn::Lt(hn::Iota(di, first), hn::Set(di, cell.count));
    do {  // usually one draw; each round takes all of the first one's
      const Draw& draw = *cell.draw[first + int(hn::FindKnownFirstTrue(di, rest))];
      const VU offset = hn::Sub(id, hn::Set(du, draw.firstTriangle));
      const MI mine = hn::And(rest, hn::RebindMask(di, hn::Lt(offset, hn::Set(du, draw.triangleCount))));
      describeVector(*context.view, draw, wanted, x, y, first, mine, cell);
      rest = hn::AndNot(mine, rest);
    } while (!hn::AllFalse(di, rest));
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::raster
HWY_AFTER_NAMESPACE();
#endif
