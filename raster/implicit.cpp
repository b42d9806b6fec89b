#include "obscura/raster/implicit.h"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "obscura/raster/implicit.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "obscura/raster/implicit-inl.h"
#include "obscura/raster/implicit_hit.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::raster {
namespace HWY_NAMESPACE {
namespace implicit {

using DD = hn::CappedTag<double, 8>;  // a block is whole vectors
using VD = hn::Vec<DD>;
using MD = hn::Mask<DD>;
using P = Point<DD>;
constexpr size_t kMostLanes = hn::MaxLanes(DD());

// Which crossings are seen, along zView: from `from` on.
struct Sought {
  VD from;
  bool entries, exits;
};

// Where it crosses, and that it enters there; lanes of `found` alone.
struct Crossing {
  MD found, enters;
  VD z;
};

// A ray through a pixel's centre, in object space: origin + zView direction.
struct Ray {
  P origin, direction;
  HWY_INLINE P at(VD z) const {
    return {hn::Add(origin.x, hn::Mul(direction.x, z)), hn::Add(origin.y, hn::Mul(direction.y, z)),
            hn::Add(origin.z, hn::Mul(direction.z, z))};
  }
};

HWY_INLINE Ray rayOf(const View& view, const ImplicitDraw& s, VD xSub, VD ySub) {
  const DD d;
  const VD zero = hn::Zero(d), x = hn::Div(hn::Sub(xSub, set(d, view.xShiftSub)), set(d, view.xScaleSub)),
           y = hn::Div(hn::Sub(ySub, set(d, view.yShiftSub)), set(d, view.yScaleSub));
  const auto across = [&](const double m[4]) HWY_ATTR { return hn::Add(hn::Mul(set(d, m[0]), x), hn::Mul(set(d, m[1]), y)); };
  const auto origin = [&](const double m[4]) HWY_ATTR { return hn::Add(view.perspective ? zero : across(m), set(d, m[3])); };
  const auto direction = [&](const double m[4]) HWY_ATTR { return hn::Sub(view.perspective ? across(m) : zero, set(d, m[2])); };
  const auto& m = s.objectFromView;
  return {{origin(m[0]), origin(m[1]), origin(m[2])}, {direction(m[0]), direction(m[1]), direction(m[2])}};
}

// Sphere tracing, see the header.
HWY_NOINLINE Crossing trace(const View& view, const ImplicitDraw& s, const Ray& ray, const Sought& sought) {
  const DD d;
  const VD zero = hn::Zero(d);
  const auto dot = [&](const P& a, const P& b) HWY_ATTR {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
  };
  // Through the ball of the bound: a z^2 + 2 b z + c = 0.
  const P o{hn::Sub(ray.origin.x, set(d, s.bound.center.x)), hn::Sub(ray.origin.y, set(d, s.bound.center.y)),
            hn::Sub(ray.origin.z, set(d, s.bound.center.z))};
  const VD a = dot(ray.direction, ray.direction), b = dot(o, ray.direction);
  const VD c = hn::Sub(dot(o, o), set(d, s.bound.radius * s.bound.radius));
  const VD square = hn::Sub(hn::Mul(b, b), hn::Mul(a, c));
  Crossing out{hn::Gt(square, zero), hn::Lt(zero, zero), zero};
  if (hn::AllFalse(d, out.found)) return out;
  const VD root = hn::Sqrt(hn::IfThenElseZero(out.found, square)), minusB = hn::Sub(zero, b);
  VD z0 = hn::Div(hn::Sub(minusB, root), a), z1 = hn::Div(hn::Add(minusB, root), a);
  const VD from = larger(d, sought.from, set(d, view.zNear)), zFar = set(d, view.zFar);
  z0 = larger(d, z0, from);
  z1 = hn::IfThenElse(hn::Lt(z1, zFar), z1, zFar);
  MD active = hn::And(out.found, hn::Lt(z0, z1));
  out.found = out.enters;
  if (hn::AllFalse(d, active)) return out;

  const VD perLength = hn::Div(set(d, 1), hn::Sqrt(a)), least = hn::Mul(hn::Sub(z1, z0), set(d, 1.0 / kLeastSteps));
  VD z = hn::IfThenElseZero(active, z0), low = zero, high = zero;
  VD f = value(d, s, ray.at(z));
  for (int step = 0; step < 2 * kLeastSteps && !hn::AllFalse(d, active); ++step) {
    const VD free = hn::Mul(hn::Abs(f), perLength);
    const VD next = hn::IfThenElse(active, hn::Add(z, larger(d, free, least)), z);
    const VD fNext = value(d, s, ray.at(next));
    const MD wasInside = hn::Lt(f, zero), isInside = hn::Lt(fNext, zero);
    MD crossed = hn::Lt(zero, zero);
    if (sought.entries) crossed = hn::AndNot(wasInside, isInside);
    if (sought.exits) crossed = hn::Or(crossed, hn::AndNot(isInside, wasInside));
    crossed = hn::And(active, crossed);
    low = hn::IfThenElse(crossed, z, low);
    high = hn::IfThenElse(crossed, next, high);
    out.found = hn::Or(out.found, crossed);
    out.enters = hn::Or(out.enters, hn::And(crossed, isInside));
    active = hn::And(hn::AndNot(crossed, active), hn::Lt(next, z1));
    z = next;
    f = fNext;
  }
  if (hn::AllFalse(d, out.found)) return out;
  for (int k = 0; k < kHalvings; ++k) {
    const VD middle = hn::Mul(hn::Add(low, high), set(d, 0.5));
    const MD isInside = hn::Lt(value(d, s, ray.at(middle)), zero);
    const MD beyond = hn::Or(hn::And(out.enters, isInside), hn::AndNot(out.enters, hn::Not(isInside)));
    low = hn::IfThenElse(beyond, low, middle);
    high = hn::IfThenElse(beyond, middle, high);
  }
  out.z = high;
  out.found = hn::And(out.found, hn::Le(high, z1));
  return out;
}

// Unit normal in view space by central differences, outwards.
HWY_NOINLINE P normalOf(const ImplicitDraw& s, const P& p) {
  const DD d;
  const VD h = set(d, s.bound.radius * kGradientStep);
  const P g{hn::Sub(value(d, s, P{hn::Add(p.x, h), p.y, p.z}), value(d, s, P{hn::Sub(p.x, h), p.y, p.z})),
            hn::Sub(value(d, s, P{p.x, hn::Add(p.y, h), p.z}), value(d, s, P{p.x, hn::Sub(p.y, h), p.z})),
            hn::Sub(value(d, s, P{p.x, p.y, hn::Add(p.z, h)}), value(d, s, P{p.x, p.y, hn::Sub(p.z, h)}))};
  const auto& m = s.objectFromView;  // its transpose takes gradients to view space
  const auto turned = [&](int c) HWY_ATTR {
    return hn::Add(hn::Add(hn::Mul(set(d, m[0][c]), g.x), hn::Mul(set(d, m[1][c]), g.y)), hn::Mul(set(d, m[2][c]), g.z));
  };
  const P n{turned(0), turned(1), turned(2)};
  const VD square = squared(d, n), length = hn::Sqrt(square);
  const MD good = hn::And(hn::Gt(square, set(d, 1e-290)), hn::Lt(square, set(d, 1e290)));
  return {hn::IfThenElseZero(good, hn::Div(n.x, length)), hn::IfThenElseZero(good, hn::Div(n.y, length)),
          hn::IfThenElse(good, hn::Div(n.z, length), set(d, 1))};
}

// What a vector's lanes find, in memory.
struct Found {
  HWY_ALIGN double z[kMostLanes], nx[kMostLanes], ny[kMostLanes], nz[kMostLanes];
};

// zView of a key, exactly as rays count it.
HWY_INLINE VD depthOf(const View& view, VD key) {
  const DD d;
  return view.perspective ? hn::Div(set(d, 1), key) : hn::Sub(hn::Zero(d), key);
}

// Calls body(x, y, element) for the blocks of the tile that reach into the surface's screen bound; x, y: in the tile.
template <class Body>
HWY_INLINE void eachBlock(const View& view, const ImplicitDraw& s, const TileBuffers& tile, bool skip, const Body& body) {
  ScreenBound b{0, 0, view.width - 1, view.height - 1, 0};
  if (skip) b = screenBound(view, s.sphere);
  const int x0 = std::max(b.x0 - tile.x, 0) & ~(kBlock - 1), y0 = std::max(b.y0 - tile.y, 0) & ~(kBlock - 1);
  for (int y = y0; y < tile.height && y <= b.y1 - tile.y; y += kBlock)
    for (int x = x0; x < tile.width && x <= b.x1 - tile.x; x += kBlock) body(x, y, tile.at(x, y));
}

struct BlockCenters {  // of a block's pixels, from its first, sub-pixels
  HWY_ALIGN double x[kBlock * kBlock], y[kBlock * kBlock];
  BlockCenters() {
    for (int i = 0; i < kBlock * kBlock; ++i) x[i] = double((i & (kBlock - 1)) * kSub), y[i] = double((i >> kBlockBits) * kSub);
  }
};

HWY_INLINE Ray rayOf(const View& view, const ImplicitDraw& s, const TileBuffers& tile, const BlockCenters& centers, int x, int y,
                     int first) {
  const DD d;
  return rayOf(view, s, hn::Add(set(d, view.xCenterSub(tile.x + x)), hn::Load(d, centers.x + first)),
               hn::Add(set(d, view.yCenterSub(tile.y + y)), hn::Load(d, centers.y + first)));
}

void DrawImplicit(const View& view, const ImplicitDraw& s, const TileBuffers& tile, bool skip, GBuffer& out) {
  const DD d;
  const BlockCenters centers;
  Found found{};
  eachBlock(view, s, tile, skip, [&](int x, int y, int) HWY_ATTR {
    for (int first = 0; first < kBlock * kBlock; first += int(hn::Lanes(d))) {
      const Ray ray = rayOf(view, s, tile, centers, x, y, first);
      const Crossing crossing = trace(view, s, ray, {set(d, view.zNear), true, s.doubleSided});
      if (hn::AllFalse(d, crossing.found)) continue;
      hn::Store(hn::IfThenElse(crossing.found, crossing.z, set(d, std::numeric_limits<double>::infinity())), d, found.z);
      if (!out.normal[0].empty() || !out.facet[0].empty()) {
        const P n = normalOf(s, ray.at(crossing.z));
        const VD sign = hn::IfThenElse(crossing.enters, set(d, 1), set(d, -1));
        hn::Store(hn::Mul(n.x, sign), d, found.nx);
        hn::Store(hn::Mul(n.y, sign), d, found.ny);
        hn::Store(hn::Mul(n.z, sign), d, found.nz);
      }
      for (int lane = 0; lane < int(hn::Lanes(d)); ++lane) {
        if (!(found.z[lane] < std::numeric_limits<double>::infinity())) continue;
        const int column = x + ((first + lane) & (kBlock - 1)), row = y + ((first + lane) >> kBlockBits);
        const glm::vec3 normal(float(found.nx[lane]), float(found.ny[lane]), float(found.nz[lane]));
        storeHit(view, s, tile, column, row, {found.z[lane], normal}, out);
      }
    }
  });
}

void DrawImplicitBehind(const View& view, const ImplicitDraw& s, const TileBuffers& tile, bool back, bool skip) {
  const DD d;
  const BlockCenters centers;
  const hn::Rebind<float, DD> df;
  Found found{};
  const VD infinity = set(d, std::numeric_limits<double>::infinity());
  eachBlock(view, s, tile, skip, [&](int x, int y, int element) HWY_ATTR {
    for (int first = 0; first < kBlock * kBlock; first += int(hn::Lanes(d))) {
      // A limit of infinity is none.
      const VD limit = hn::PromoteTo(d, hn::Load(df, tile.limit + element + first));
      const MD none = hn::Eq(limit, infinity), nothing = hn::Eq(limit, hn::Neg(infinity));
      const VD from = hn::IfThenElse(none, set(d, view.zNear), hn::IfThenElse(nothing, infinity, depthOf(view, limit)));
      const Crossing crossing =
          trace(view, s, rayOf(view, s, tile, centers, x, y, first), {from, !back, back || s.doubleSided});
      if (hn::AllFalse(d, crossing.found)) continue;
      hn::Store(hn::IfThenElse(crossing.found, crossing.z, infinity), d, found.z);
      for (int lane = 0; lane < int(hn::Lanes(d)); ++lane)
        if (found.z[lane] < std::numeric_limits<double>::infinity()) storeKey(view, tile, element + first + lane, found.z[lane]);
    }
  });
}

}  // namespace implicit

using implicit::DrawImplicit;
using implicit::DrawImplicitBehind;

}  // namespace HWY_NAMESPACE
}  // namespace obscura::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "obscura/raster/dispatch.h"

namespace obscura::raster {

HWY_EXPORT(DrawImplicit);
HWY_EXPORT(DrawImplicitBehind);

void drawImplicits(const View& view, Span<const ImplicitDraw> surfaces, const TileBuffers& tile, bool skip, GBuffer& out,
                   Target target) {
  for (const ImplicitDraw& s : surfaces) OBSCURA_DISPATCH(DrawImplicit, target)(view, s, tile, skip, out);
}

void drawImplicitsBehind(const View& view, Span<const ImplicitDraw> surfaces, const TileBuffers& tile, bool back, bool skip,
                         Target target) {
  for (const ImplicitDraw& s : surfaces)
    if (!(back && s.doubleSided)) OBSCURA_DISPATCH(DrawImplicitBehind, target)(view, s, tile, back, skip);
}

}  // namespace obscura::raster
#endif
