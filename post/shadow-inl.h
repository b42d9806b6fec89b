// Per-target: the part of a light that reaches a vector of points, by its shadow maps; see direct_light.h.
#if defined(OBSCURA_SHADOW_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef OBSCURA_SHADOW_INL_H_
#undef OBSCURA_SHADOW_INL_H_
#else
#define OBSCURA_SHADOW_INL_H_
#endif

#include <cmath>

#include "obscura/post/punctual-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::post {
namespace HWY_NAMESPACE {

constexpr float kTurn = 1.0f / 16;   // t
constexpr float kGrazing = 1.0f / 1024;
constexpr float kSnap = 1.0f / 256;  // of a texel or pixel

// How far a point may lie off the plane of its triangle: s.
HWY_INLINE VF offPlane(const PunctualLight& light, const Projector& projector, const Points& at) {
  const DF d;
  const float perPixel = (std::fabs(projector.xInverse) + std::fabs(projector.yInverse)) * kSnap;
  VF width = hn::Set(d, perPixel);
  if (projector.perspective) width = hn::Mul(width, at.depth);
  const VF size = hn::Add(hn::Add(hn::Abs(at.p.x), hn::Abs(at.p.y)), at.depth);
  const float shift = std::fabs(light.origin.x) + std::fabs(light.origin.y) + std::fabs(light.origin.z);
  const VF rounding = hn::Mul(hn::Add(hn::Mul(size, hn::Set(d, light.worldFromView)), hn::Set(d, shift)), hn::Set(d, 0x1p-20f));
  return hn::Add(hn::Mul(width, hn::Set(d, light.worldFromView)), rounding);
}

// How one map sees vectors of planes: the key at the point and how it grows.
struct PlaneInMap {
  VF key, perX, perY;  // key: bias included
};

template <bool kPerspective>
HWY_INLINE PlaneInMap planeIn(const ShadowMap& map, const V3& q, const V3& n, VF slack) {
  const DF d;
  const VF one = hn::Set(d, 1.0f), t = hn::Set(d, kTurn);
  const float reach = 1.5f * std::sqrt(map.projector.xInverse * map.projector.xInverse + map.projector.yInverse * map.projector.yInverse);
  const VF signedD = kPerspective ? dot(n, q) : n.z, v = kPerspective ? hn::Sqrt(dot(q, q)) : one;
  const auto atLeast = [](VF x, VF least) HWY_ATTR { return hn::IfThenElse(hn::Gt(x, least), x, least); };
  const VF size = atLeast(hn::Abs(signedD), hn::Mul(hn::Set(d, kGrazing), v));
  const VF turning = atLeast(size, hn::Mul(hn::Set(d, 2 * kTurn), v)), turned = hn::Mul(t, v);
  const VF divisor = hn::IfThenElse(hn::Lt(signedD, hn::Zero(d)), hn::Neg(size), size);
  PlaneInMap out;
  out.perX = hn::Div(hn::Mul(n.x, hn::Set(d, map.projector.xInverse)), divisor);
  out.perY = hn::Div(hn::Mul(n.y, hn::Set(d, map.projector.yInverse)), divisor);
  out.key = kPerspective ? hn::Div(one, q.z) : hn::Neg(q.z);
  const VF snapped = hn::Mul(hn::Add(hn::Abs(out.perX), hn::Abs(out.perY)), hn::Set(d, kSnap));
  const VF bent = hn::Div(hn::Mul(hn::Set(d, reach * kTurn), hn::Add(turning, v)), hn::Mul(turning, hn::Sub(turning, turned)));
  VF off = hn::Div(slack, size);
  if (kPerspective) off = hn::Mul(off, out.key);
  out.key = hn::Add(out.key, hn::Add(snapped, hn::Add(bent, off)));
  return out;
}

// The first of three texels along one axis, the first one's centre less the point, and how much of each counts.
struct Taps {
  VI first;
  VF offset, weight[3];  // weights: in 1/16, their sum is 32
};

HWY_INLINE Taps tapsAt(VF texel, int size) {
  const DF d;
  const VF zero = hn::Zero(d), most = hn::Set(d, float(size - 3)), from = hn::Sub(texel, hn::Set(d, 1.0f));
  const VF kept = hn::IfThenElseZero(hn::Gt(from, zero), hn::IfThenElse(hn::Lt(from, most), from, most));
  Taps t;
  t.first = truncated(kept);
  const VF part = hn::Sub(kept, hn::ConvertTo(d, t.first)), sixteen = hn::Set(d, 16.0f);
  t.offset = hn::Sub(hn::Set(d, -0.5f), part);
  t.weight[2] = hn::ConvertTo(d, truncated(hn::Mul(part, sixteen)));
  t.weight[1] = sixteen;
  t.weight[0] = hn::Sub(sixteen, t.weight[2]);
  return t;
}

// q, n: a point and the unit normal of its triangle, in the map's space. Lanes outside of the map read its rim.
template <bool kPerspective>
HWY_INLINE VF litPart(const ShadowMap& map, const V3& q, const V3& n, VF slack) {
  const DF d;
  const DI di;
  const Projector& p = map.projector;
  const raster::Plane<float>& depth = *map.depth;
  const PlaneInMap plane = planeIn<kPerspective>(map, q, n, slack);
  const VF x = kPerspective ? hn::Div(q.x, q.z) : q.x, y = kPerspective ? hn::Div(q.y, q.z) : q.y;
  const Taps u = tapsAt(hn::Add(hn::Mul(x, hn::Set(d, p.xScale)), hn::Set(d, p.xCenter)), depth.width());
  const Taps v = tapsAt(hn::Add(hn::Mul(y, hn::Set(d, p.yScale)), hn::Set(d, p.yCenter)), depth.height());
  const VF one = hn::Set(d, 1.0f), zero = hn::Zero(d);
  const VI stride = hn::Set(di, int32_t(depth.stride()));
  VI at = hn::Add(hn::Mul(v.first, stride), u.first);
  VF sum = zero;
  for (int row = 0; row < 3; ++row) {
    const VF ofRow = hn::Add(plane.key, hn::Mul(plane.perY, hn::Add(v.offset, hn::Set(d, float(row)))));
    for (int column = 0; column < 3; ++column) {
      const VF key = hn::Add(ofRow, hn::Mul(plane.perX, hn::Add(u.offset, hn::Set(d, float(column)))));
      const VF stored = hn::GatherIndex(d, depth.data() + column, at);
      // 1 / stored > key, where behind the light there is nothing; -stored > key.
      const MF nearer = kPerspective ? hn::Lt(hn::Mul(stored, hn::IfThenElseZero(hn::Gt(key, zero), key)), one)
                                     : hn::Lt(stored, hn::Neg(key));
      sum = hn::Add(sum, hn::IfThenZeroElse(nearer, hn::Mul(u.weight[column], v.weight[row])));
    }
    at = hn::Add(at, stride);
  }
  return hn::Mul(sum, hn::Set(d, 1.0f / 1024));
}

// q: in light space; facet: unit normal of the triangle, camera space. 1 where a map is not there.
HWY_INLINE VF visiblePart(const PunctualLight& light, MF lit, const V3& q, const V3& facet, VF slack) {
  const DF d;
  VF part = hn::Set(d, 1.0f);
  const V3 n = turned(light.lightFromNormal, facet);
  if (light.maps == 1 && light.map[0].depth)
    part = light.map[0].projector.perspective ? litPart<true>(light.map[0], q, n, slack) : litPart<false>(light.map[0], q, n, slack);
  for (int map = 0; light.maps == 6 && map < 6; ++map) {
    const MF mine = hn::And(lit, belongsTo(map, q));
    if (light.map[map].depth && !hn::AllFalse(d, mine))
      part = hn::IfThenElse(mine, litPart<true>(light.map[map], inMap(map, q), inMap(map, n), slack), part);
  }
  return part;
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::post
HWY_AFTER_NAMESPACE();
#endif
