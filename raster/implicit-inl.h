// Per target: f of an implicit surface at a vector of points of its object space, in double for the tracer and in float for
// the containment test. Nowhere steeper than 1.
#if defined(OBSCURA_IMPLICIT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef OBSCURA_IMPLICIT_INL_H_
#undef OBSCURA_IMPLICIT_INL_H_
#else
#define OBSCURA_IMPLICIT_INL_H_
#endif

#include <hwy/highway.h>

#include "obscura/raster/implicit.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::raster {
namespace HWY_NAMESPACE {
namespace implicit {
namespace hn = hwy::HWY_NAMESPACE;

template <class D>
struct Point {
  hn::Vec<D> x, y, z;
};

template <class D>
HWY_INLINE hn::Vec<D> set(D d, double v) {
  return hn::Set(d, hn::TFromD<D>(v));
}

template <class D>
HWY_INLINE hn::Vec<D> larger(D, hn::Vec<D> a, hn::Vec<D> b) {
  return hn::IfThenElse(hn::Gt(a, b), a, b);
}

template <class D>
HWY_INLINE hn::Vec<D> squared(D, const Point<D>& p) {
  return hn::Add(hn::Add(hn::Mul(p.x, p.x), hn::Mul(p.y, p.y)), hn::Mul(p.z, p.z));
}

template <class D>
HWY_INLINE hn::Vec<D> ball(D d, double radius, const Point<D>& p) {
  return hn::Sub(hn::Sqrt(squared(d, p)), set(d, radius));
}

template <class D>
HWY_INLINE hn::Vec<D> box(D d, const glm::dvec3& half, const Point<D>& p) {
  const hn::Vec<D> zero = hn::Zero(d);
  const Point<D> q{hn::Sub(hn::Abs(p.x), set(d, half.x)), hn::Sub(hn::Abs(p.y), set(d, half.y)), hn::Sub(hn::Abs(p.z), set(d, half.z))};
  const hn::Vec<D> largest = larger(d, larger(d, q.x, q.y), q.z);
  const hn::Vec<D> outside = hn::Sqrt(squared(d, Point<D>{larger(d, q.x, zero), larger(d, q.y, zero), larger(d, q.z, zero)}));
  return hn::Add(outside, hn::IfThenElse(hn::Lt(largest, zero), largest, zero));
}

template <class D>
HWY_INLINE hn::Vec<D> torus(D d, const ImplicitSurface& s, const Point<D>& p) {
  const hn::Vec<D> ring = hn::Sub(hn::Sqrt(hn::Add(hn::Mul(p.x, p.x), hn::Mul(p.z, p.z))), set(d, s.radius));
  return hn::Sub(hn::Sqrt(hn::Add(hn::Mul(ring, ring), hn::Mul(p.y, p.y))), set(d, s.tube));
}

template <class D>
HWY_INLINE hn::Vec<D> metaballs(D d, const ImplicitDraw& draw, const Point<D>& p) {
  hn::Vec<D> sum = hn::Zero(d);
  for (const ImplicitBall& b : draw.surface->balls) {
    const Point<D> q{hn::Sub(p.x, set(d, b.center.x)), hn::Sub(p.y, set(d, b.center.y)), hn::Sub(p.z, set(d, b.center.z))};
    const double reach = kBallReach * b.radius;
    const hn::Vec<D> field = hn::Sub(set(d, 1), hn::Mul(squared(d, q), set(d, 1 / (reach * reach))));
    const hn::Vec<D> positive = hn::IfThenElseZero(hn::Gt(field, hn::Zero(d)), field);
    sum = hn::Add(sum, hn::Mul(hn::Mul(positive, positive), positive));
  }
  return hn::Mul(hn::Sub(set(d, kBallLevel), sum), set(d, draw.perSteepness));
}

// sin(2 pi t), |t| < 2^20: the whole turns go exactly, half a turn is folded to a quarter, and there the Taylor series up to
// x^17 errs by less than 5e-14; in float some 2e-7.
template <class D>
HWY_INLINE hn::Vec<D> sineOfTurns(D d, hn::Vec<D> t) {
  const hn::Vec<D> half = set(d, 0.5), quarter = set(d, 0.25);
  hn::Vec<D> u = hn::Sub(t, hn::Floor(hn::Add(t, half)));
  const hn::Vec<D> folded = hn::Sub(hn::CopySign(half, u), u);
  u = hn::IfThenElse(hn::Gt(hn::Abs(u), quarter), folded, u);
  const hn::Vec<D> x = hn::Mul(u, set(d, 6.283185307179586)), z = hn::Mul(x, x);
  hn::Vec<D> p = set(d, 1 / 355687428096000.0);
  for (const double c : {-1 / 1307674368000.0, 1 / 6227020800.0, -1 / 39916800.0, 1 / 362880.0, -1 / 5040.0, 1 / 120.0, -1 / 6.0})
    p = hn::Add(hn::Mul(p, z), set(d, c));
  return hn::Add(x, hn::Mul(hn::Mul(x, z), p));
}

template <class D>
HWY_INLINE hn::Vec<D> gyroid(D d, const ImplicitDraw& draw, const Point<D>& p) {
  const ImplicitSurface& s = *draw.surface;
  const hn::Vec<D> turns[3] = {hn::Mul(p.x, set(d, draw.perPeriod)), hn::Mul(p.y, set(d, draw.perPeriod)), hn::Mul(p.z, set(d, draw.perPeriod))};
  hn::Vec<D> sum = hn::Zero(d);
  for (int k = 0; k < 3; ++k)
    sum = hn::Add(sum, hn::Mul(sineOfTurns(d, turns[k]), sineOfTurns(d, hn::Add(turns[(k + 1) % 3], set(d, 0.25)))));
  const hn::Vec<D> wall = hn::Sub(hn::Mul(hn::Abs(sum), set(d, draw.perSlope)), set(d, 0.5 * s.thickness));
  return larger(d, wall, s.radius > 0 ? ball(d, s.radius, p) : box(d, s.halfSize, p));
}

template <class D>
HWY_INLINE hn::Vec<D> function(D d, const ImplicitDraw& draw, const Point<D>& p) {
  using T = hn::TFromD<D>;
  HWY_ALIGN T x[hn::MaxLanes(D())], y[hn::MaxLanes(D())], z[hn::MaxLanes(D())];
  hn::Store(p.x, d, x);
  hn::Store(p.y, d, y);
  hn::Store(p.z, d, z);
  for (size_t i = 0; i < hn::Lanes(d); ++i) x[i] = T(draw.surface->function({x[i], y[i], z[i]}) * draw.perSteepness);
  return larger(d, ball(d, draw.surface->radius, p), hn::Load(d, x));  // NaN stays NaN, which is not inside
}

template <class D>
HWY_NOINLINE hn::Vec<D> value(D d, const ImplicitDraw& draw, const Point<D>& p) {
  const ImplicitSurface& s = *draw.surface;
  switch (s.shape) {
    case ImplicitShape::Sphere: return ball(d, s.radius, p);
    case ImplicitShape::Box: return box(d, s.halfSize, p);
    case ImplicitShape::Torus: return torus(d, s, p);
    case ImplicitShape::Metaballs: return metaballs(d, draw, p);
    case ImplicitShape::Gyroid: return gyroid(d, draw, p);
    case ImplicitShape::Function: break;
  }
  return function(d, draw, p);
}

}  // namespace implicit
}  // namespace HWY_NAMESPACE
}  // namespace obscura::raster
HWY_AFTER_NAMESPACE();
#endif
