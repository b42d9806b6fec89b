#include "obscura/raster/setup.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "obscura/raster/setup.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "obscura/raster/facing-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::raster {
namespace HWY_NAMESPACE {

constexpr int kList = int(Clusters::kMaxTriangles) + 16;  // lists are written a vector at a time

// Appends the lanes of `v` where `mask` is true; writes a whole vector.
HWY_INLINE void append(VI v, MI mask, int32_t* list, int& count) {
  const DI d;
  hn::StoreU(hn::Compress(v, mask), d, list + count);
  count += int(hn::CountTrue(d, mask));
}

// Three corners of a vector of triangles, gathered.
struct Corners {
  VI i[3], x[3], y[3];
};

HWY_INLINE Corners gatherCorners(const TransformedVertices& v, VI packed) {
  const DI d;
  Corners c;
  c.i[0] = hn::And(packed, hn::Set(d, 255));
  c.i[1] = hn::And(hn::ShiftRight<8>(packed), hn::Set(d, 255));
  c.i[2] = hn::ShiftRight<16>(packed);
  for (int k = 0; k < 3; ++k) {
    if (v.packed) {
      const VI xy = hn::GatherIndex(d, v.xy, c.i[k]);
      c.x[k] = hn::Add(hn::And(xy, hn::Set(d, 0xFFFF)), hn::Set(d, v.xLeast));
      c.y[k] = hn::Add(hn::BitCast(d, hn::ShiftRight<16>(hn::BitCast(DU(), xy))), hn::Set(d, v.yLeast));
    } else {
      c.x[k] = hn::GatherIndex(d, v.xSub, c.i[k]);
      c.y[k] = hn::GatherIndex(d, v.ySub, c.i[k]);
    }
  }
  return c;
}

// The pixels whose centres lie in the bounding box, within the window, and its extents.
struct Box {
  VI x0, y0, x1, y1;
  VI xExtent, yExtent;
};

HWY_INLINE Box boundingBox(const View& view, const Corners& c) {
  const DI d;
  auto min3 = [](const VI v[3]) HWY_ATTR { return hn::Min(hn::Min(v[0], v[1]), v[2]); };
  auto max3 = [](const VI v[3]) HWY_ATTR { return hn::Max(hn::Max(v[0], v[1]), v[2]); };
  const VI minX = min3(c.x), maxX = max3(c.x), minY = min3(c.y), maxY = max3(c.y);
  auto first = [&](VI v, int32_t firstSub) HWY_ATTR {
    return hn::Max(hn::ShiftRight<kSubBits>(hn::Add(v, hn::Set(d, kSub / 2 - 1 - firstSub))), hn::Zero(d));
  };
  auto last = [&](VI v, int32_t firstSub, int size) HWY_ATTR {
    return hn::Min(hn::ShiftRight<kSubBits>(hn::Add(v, hn::Set(d, -kSub / 2 - firstSub))), hn::Set(d, size - 1));
  };
  return {first(minX, view.xFirstSub), first(minY, view.yFirstSub), last(maxX, view.xFirstSub, view.width),
          last(maxY, view.yFirstSub, view.height), hn::Sub(maxX, minX), hn::Sub(maxY, minY)};
}

// Edge functions at the centre of pixel (x, y), at most a block away from the box; see triangle.h. Only for small
// triangles.
struct Edges {
  VI e[3], a[3], b[3];
};

HWY_INLINE Edges edgeFunctions(const View& view, const Corners& c, VI x, VI y, VI area) {
  const DI d;
  const MI clockwise = hn::Gt(area, hn::Zero(d));
  const VI px[3] = {c.x[0], hn::IfThenElse(clockwise, c.x[1], c.x[2]), hn::IfThenElse(clockwise, c.x[2], c.x[1])};
  const VI py[3] = {c.y[0], hn::IfThenElse(clockwise, c.y[1], c.y[2]), hn::IfThenElse(clockwise, c.y[2], c.y[1])};
  const VI cx = hn::Add(hn::ShiftLeft<kSubBits>(x), hn::Set(d, kSub / 2 + view.xFirstSub));
  const VI cy = hn::Add(hn::ShiftLeft<kSubBits>(y), hn::Set(d, kSub / 2 + view.yFirstSub));
  Edges out;
  for (int p = 0; p < 3; ++p) {
    const int q = p == 2 ? 0 : p + 1;
    const VI a = hn::Sub(py[p], py[q]), b = hn::Sub(px[q], px[p]);
    const VI value = hn::Add(hn::Mul(a, hn::Sub(cx, px[p])), hn::Mul(b, hn::Sub(cy, py[p])));
    const MI topLeft = hn::Or(hn::Gt(a, hn::Zero(d)), hn::And(hn::Eq(a, hn::Zero(d)), hn::Gt(b, hn::Zero(d))));
    const VI biased = hn::Sub(value, hn::IfThenZeroElse(topLeft, hn::Set(d, 1)));
    out.e[p] = hn::ShiftRight<kSubBits>(biased);
    out.a[p] = a;
    out.b[p] = b;
  }
  return out;
}

// No centre of the 2 x 2 pixels from (x, y) is inside.
HWY_INLINE MI missesFour(const Edges& e) {
  const DI d;
  VI best = hn::Set(d, -1);  // its sign is set as long as every pixel has had a negative edge
  for (int corner = 0; corner < 4; ++corner) {
    VI any = hn::Zero(d);
    for (int i = 0; i < 3; ++i) {
      VI value = e.e[i];
      if (corner & 1) value = hn::Add(value, e.a[i]);
      if (corner & 2) value = hn::Add(value, e.b[i]);
      any = hn::Or(any, value);
    }
    best = hn::And(best, any);
  }
  return hn::Lt(best, hn::Zero(d));
}

HWY_INLINE VI doubledArea(const Corners& c) {
  return hn::Sub(hn::Mul(hn::Sub(c.x[1], c.x[0]), hn::Sub(c.y[2], c.y[0])),
                 hn::Mul(hn::Sub(c.x[2], c.x[0]), hn::Sub(c.y[1], c.y[0])));
}

// Which of the triangles `mask` lie behind what has been drawn, as far as boxes of two blocks a side at most tell.
HWY_INLINE MI hiddenBoxes(const OcclusionMap& occlusion, const Box& box, VF nearestKey, MI mask) {
  const DF d;
  const DI di;
  const VI one = hn::Set(di, 1), stride = hn::Set(di, occlusion.stride());
  auto block = [&](VI pixel) HWY_ATTR { return hn::ShiftRight<kBlockBits>(pixel); };
  const MI wide = hn::Gt(hn::Sub(block(box.x1), block(box.x0)), one), high = hn::Gt(hn::Sub(block(box.y1), block(box.y0)), one);
  const MI small = hn::AndNot(hn::Or(wide, high), mask);
  auto blockIn = [&](VI pixel) HWY_ATTR { return hn::IfThenElseZero(small, block(pixel)); };
  const VI x0 = blockIn(box.x0), x1 = blockIn(box.x1);
  const VI row0 = hn::Mul(blockIn(box.y0), stride), row1 = hn::Mul(blockIn(box.y1), stride);
  auto behind = [&](VI row, VI x) HWY_ATTR { return hn::Gt(hn::GatherIndex(d, occlusion.farthest(), hn::Add(row, x)), nearestKey); };
  MF all = hn::And(hn::RebindMask(d, small), behind(row0, x0));
  if (hn::AllFalse(d, all)) return hn::RebindMask(di, all);
  all = hn::And(hn::And(all, behind(row1, x1)), hn::And(behind(row0, x1), behind(row1, x0)));
  return hn::RebindMask(di, all);
}

// Up to a vector of surviving triangles: field by field what their records are to hold, in the order of SmallTriangle, and
// what the depth gradients are made of.
struct Survivors {
  enum Field {
    kE0, kE1, kE2, kAB0, kAB1, kAB2, kBlock, kBlocks, kKey0, kXGradient, kYGradient, kXFromP0, kYFromP0, kKeyMin, kKeyMax, kId,
    kFields
  };
  HWY_ALIGN int32_t field[kFields][16];
  HWY_ALIGN int32_t dx1[16], dy1[16], dx2[16], dy2[16], area[16];
  HWY_ALIGN float key0[16], key1[16], key2[16];
};
static_assert(sizeof(SmallTriangle) == Survivors::kFields * sizeof(int32_t) && offsetof(SmallTriangle, ab) == Survivors::kAB0 * 4 &&
              offsetof(SmallTriangle, block) == Survivors::kBlock * 4 && offsetof(SmallTriangle, key0) == Survivors::kKey0 * 4 &&
              offsetof(SmallTriangle, xFromP0) == Survivors::kXFromP0 * 4 && offsetof(SmallTriangle, keyMin) == Survivors::kKeyMin * 4 &&
              offsetof(SmallTriangle, id) == Survivors::kId * 4);

// Depth gradients, in double: the products of a 24-bit key and a 15-bit extent are exact there.
HWY_INLINE void depthGradients(Survivors& s, int count) {
  const hn::CappedTag<double, 8> d;
  const hn::Rebind<float, decltype(d)> df;
  const hn::Rebind<int32_t, decltype(d)> di;
  for (int i = 0; i < count; i += int(hn::Lanes(d))) {
    auto real = [&](const float* p) HWY_ATTR { return hn::PromoteTo(d, hn::LoadU(df, p + i)); };
    auto integer = [&](const int32_t* p) HWY_ATTR { return hn::PromoteTo(d, hn::LoadU(di, p + i)); };
    const auto key0 = real(s.key0);
    const auto d1 = hn::Sub(real(s.key1), key0), d2 = hn::Sub(real(s.key2), key0);
    const auto perArea = hn::Div(hn::Set(d, 1.0), integer(s.area));
    const auto gx = hn::Sub(hn::Mul(d1, integer(s.dy2)), hn::Mul(d2, integer(s.dy1)));
    const auto gy = hn::Sub(hn::Mul(d2, integer(s.dx1)), hn::Mul(d1, integer(s.dx2)));
    auto store = [&](auto v, int32_t* p) HWY_ATTR { hn::StoreU(hn::BitCast(di, hn::DemoteTo(df, hn::Mul(v, perArea))), di, p + i); };
    store(gx, s.field[Survivors::kXGradient]);
    store(gy, s.field[Survivors::kYGradient]);
  }
}

void SetupCluster(const View& view, const Draw& draw, const Cluster& cluster, const TransformedVertices& vertices,
                  const OcclusionMap* occlusion, Bins& bins, Statistics& statistics) {
  const DF d;
  const DI di;
  const int lanes = int(hn::Lanes(d));
  const Clusters& all = *draw.clusters;
  const uint32_t* corners = all.corners.data() + cluster.firstTriangle;
  const uint32_t* triangles = all.triangle.data() + cluster.firstTriangle;
  const auto packedCorners = [&](VI index) HWY_ATTR {
    return hn::GatherIndex(di, reinterpret_cast<const int32_t*>(corners), index);
  };

  // First pass: keep what faces the eye and covers a pixel centre, as far as boxes tell, and the centres of tiny ones.
  HWY_ALIGN int32_t visible[kList];
  int visibleCount = 0;
  const Facing facing(draw, cluster);
  uint64_t facingCount = 0;
  for (int i = 0; i < int(cluster.triangleCount); i += lanes) {
    const VI index = hn::Iota(di, i);
    const MI valid = facing.of(i, hn::Lt(index, hn::Set(di, int32_t(cluster.triangleCount))));
    const uint64_t validCount = hn::CountTrue(di, valid);
    if (validCount == 0) continue;
    facingCount += validCount;
    const Corners c = gatherCorners(vertices, hn::LoadU(di, reinterpret_cast<const int32_t*>(corners) + i));
    const Box box = boundingBox(view, c);
    MI single = hn::Or(hn::Gt(box.xExtent, hn::Set(di, kSmallExtentSub)), hn::Gt(box.yExtent, hn::Set(di, kSmallExtentSub)));
    MI gone = hn::Or(hn::Gt(box.x0, box.x1), hn::Gt(box.y0, box.y1));
    if (HWY_UNLIKELY(vertices.anyCode & kNeedsClip)) {
      const VI c0 = hn::GatherIndex(di, vertices.code, c.i[0]), c1 = hn::GatherIndex(di, vertices.code, c.i[1]);
      const VI c2 = hn::GatherIndex(di, vertices.code, c.i[2]);
      const MI clip = hn::Ne(hn::And(hn::Or(hn::Or(c0, c1), c2), hn::Set(di, kNeedsClip)), hn::Zero(di));
      single = hn::Or(single, clip);
      gone = hn::AndNot(clip, gone);
    }
    const MI toSingle = hn::And(hn::AndNot(gone, single), valid);
    if (HWY_UNLIKELY(!hn::AllFalse(di, toSingle))) {
      HWY_ALIGN int32_t which[16 + 16];
      int n = 0;
      append(index, toSingle, which, n);
      for (int k = 0; k < n; ++k) setupSingle(view, draw, triangles[which[k]], bins, statistics);
    }
    const VI area = doubledArea(c);
    const MI wrong = draw.material->doubleSided ? hn::Eq(area, hn::Zero(di))
                     : draw.mirrored != draw.away ? hn::Not(hn::Gt(area, hn::Zero(di)))
                                                : hn::Not(hn::Lt(area, hn::Zero(di)));
    const MI candidates = hn::AndNot(hn::Or(gone, single), valid);
    const MI turned = hn::And(candidates, wrong);
    MI keep = hn::AndNot(wrong, candidates);
    // A box of at most 2 x 2 pixels: is any centre inside?
    const Edges edges = edgeFunctions(view, c, box.x0, box.y0, area);
    const MI tiny = hn::Not(hn::Or(hn::Gt(hn::Sub(box.x1, box.x0), hn::Set(di, 1)), hn::Gt(hn::Sub(box.y1, box.y0), hn::Set(di, 1))));
    keep = hn::AndNot(hn::And(tiny, missesFour(edges)), keep);
    const int before = visibleCount;
    append(index, keep, visible, visibleCount);
    const uint64_t turnedCount = hn::CountTrue(di, turned);
    statistics.facingAway += turnedCount;
    statistics.outside += validCount - turnedCount - hn::CountTrue(di, toSingle) - uint64_t(visibleCount - before);
  }
  statistics.facingAway += cluster.triangleCount - facingCount;
  for (int i = visibleCount; i < visibleCount + lanes && i < kList; ++i) visible[i] = 0;  // the last vector's rest

  // Second pass: records of the rest.
  const bool masked = draw.material->alphaMode == AlphaMode::Mask;
  Survivors s;
  uint64_t hiddenHere = 0;
  for (int i = 0; i < visibleCount; i += lanes) {
    const int count = std::min(lanes, visibleCount - i);
    const VI index = hn::Load(di, visible + i);
    const Corners c = gatherCorners(vertices, packedCorners(index));
    const Box box = boundingBox(view, c);
    const VI area = doubledArea(c);
    const VI bx = hn::ShiftRight<kBlockBits>(box.x0), by = hn::ShiftRight<kBlockBits>(box.y0);
    const VI x = hn::ShiftLeft<kBlockBits>(bx), y = hn::ShiftLeft<kBlockBits>(by);
    const Edges edges = edgeFunctions(view, c, x, y, area);
    const VF key0 = hn::GatherIndex(d, vertices.key, c.i[0]), key1 = hn::GatherIndex(d, vertices.key, c.i[1]);
    const VF key2 = hn::GatherIndex(d, vertices.key, c.i[2]);
    const VF nearest = hn::Max(hn::Max(key0, key1), key2);
    uint32_t rest = (1u << count) - 1;  // to be written
    if (occlusion) {
      const MI hidden = hiddenBoxes(*occlusion, box, nearest, hn::Lt(hn::Iota(di, 0), hn::Set(di, count)));
      const size_t hiddenCount = hn::CountTrue(di, hidden);
      hiddenHere += hiddenCount;
      if (hiddenCount == size_t(count)) continue;
      if (hiddenCount > 0) {
        uint8_t bits[8] = {};
        hn::StoreMaskBits(di, hidden, bits);
        rest &= ~(uint32_t(bits[0]) | uint32_t(bits[1]) << 8);
      }
    }
    auto pair = [&](VI lower, VI upper) HWY_ATTR {
      return hn::Or(hn::And(lower, hn::Set(di, 0xFFFF)), hn::ShiftLeft<16>(upper));
    };
    auto put = [&](VI v, Survivors::Field f) HWY_ATTR { hn::Store(v, di, s.field[f]); };
    auto putReal = [&](VF v, Survivors::Field f) HWY_ATTR { put(hn::BitCast(di, v), f); };
    for (int k = 0; k < 3; ++k) {
      put(edges.e[k], Survivors::Field(Survivors::kE0 + k));
      put(pair(edges.a[k], edges.b[k]), Survivors::Field(Survivors::kAB0 + k));
    }
    put(pair(bx, by), Survivors::kBlock);
    const VI columns = hn::Sub(hn::ShiftRight<kBlockBits>(box.x1), bx), rows = hn::Sub(hn::ShiftRight<kBlockBits>(box.y1), by);
    put(pair(hn::Or(columns, hn::Set(di, masked ? SmallTriangle::kMaskedBit : 0)), rows), Survivors::kBlocks);
    const VI cx = hn::Add(hn::ShiftLeft<kSubBits>(x), hn::Set(di, kSub / 2 + view.xFirstSub));
    const VI cy = hn::Add(hn::ShiftLeft<kSubBits>(y), hn::Set(di, kSub / 2 + view.yFirstSub));
    putReal(hn::ConvertTo(d, hn::Sub(cx, c.x[0])), Survivors::kXFromP0);
    putReal(hn::ConvertTo(d, hn::Sub(cy, c.y[0])), Survivors::kYFromP0);
    putReal(key0, Survivors::kKey0);
    putReal(hn::Min(hn::Min(key0, key1), key2), Survivors::kKeyMin);
    putReal(nearest, Survivors::kKeyMax);
    const VI number = hn::GatherIndex(di, reinterpret_cast<const int32_t*>(triangles), index);
    put(hn::Add(number, hn::Set(di, int32_t(draw.firstTriangle))), Survivors::kId);
    hn::Store(hn::Sub(c.x[1], c.x[0]), di, s.dx1);
    hn::Store(hn::Sub(c.y[1], c.y[0]), di, s.dy1);
    hn::Store(hn::Sub(c.x[2], c.x[0]), di, s.dx2);
    hn::Store(hn::Sub(c.y[2], c.y[0]), di, s.dy2);
    hn::Store(area, di, s.area);
    hn::Store(key0, d, s.key0);
    hn::Store(key1, d, s.key1);
    hn::Store(key2, d, s.key2);
    depthGradients(s, count);
    for (; rest != 0; rest &= rest - 1) {
      const int k = int(hwy::Num0BitsBelowLS1Bit_Nonzero32(rest));
      const int32_t block = s.field[Survivors::kBlock][k], blocks = s.field[Survivors::kBlocks][k];
      const Bins::Kind kind = bins.kindOf(block, blocks);
      SmallTriangle& t = bins.add(kind, block);
      for (int f = 0; f < Survivors::kFields; ++f) std::memcpy(reinterpret_cast<char*>(&t) + f * 4, &s.field[f][k], 4);
      if (kind == Bins::kAnySize) bins.spread(t);
    }
  }
  statistics.hidden += hiddenHere;
  statistics.drawn += uint64_t(visibleCount) - hiddenHere;
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "obscura/raster/dispatch.h"

namespace obscura::raster {

HWY_EXPORT(SetupCluster);

void setupCluster(const View& view, const Draw& draw, const Cluster& cluster, const TransformedVertices& vertices,
                  const OcclusionMap* occlusion, Bins& bins, Statistics& statistics, Target target) {
  OBSCURA_DISPATCH(SetupCluster, target)(view, draw, cluster, vertices, occlusion, bins, statistics);
}

}  // namespace obscura::raster
#endif
