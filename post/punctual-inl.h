// Per-target: what of a punctual light arrives at a vector of pixels, before anything casts shadows.
#if defined(OBSCURA_PUNCTUAL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef OBSCURA_PUNCTUAL_INL_H_
#undef OBSCURA_PUNCTUAL_INL_H_
#else
#define OBSCURA_PUNCTUAL_INL_H_
#endif

#include <limits>

#include <hwy/highway.h>

#include "obscura/post/punctual_light.h"
#include "obscura/post/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::post {
namespace HWY_NAMESPACE {

HWY_INLINE V3 load3(const raster::Plane<float> planes[3], int x, int y) {
  const DF d;
  return {hn::LoadU(d, planes[0].row(y) + x), hn::LoadU(d, planes[1].row(y) + x), hn::LoadU(d, planes[2].row(y) + x)};
}

HWY_INLINE V3 set3(const glm::vec3& v) {
  const DF d;
  return {hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)};
}

HWY_INLINE V3 turned(const glm::mat3& m, const V3& v) {
  const DF d;
  const auto row = [&](int k) HWY_ATTR { return dot({hn::Set(d, m[0][k]), hn::Set(d, m[1][k]), hn::Set(d, m[2][k])}, v); };
  return {row(0), row(1), row(2)};
}

HWY_INLINE V3 toLightSpace(const PunctualLight& light, const V3& p) {
  const V3 q = turned(light.lightFromView, p), o = set3(light.origin);
  return {hn::Add(q.x, o.x), hn::Add(q.y, o.y), hn::Add(q.z, o.z)};
}

// Pixels x ... of a row: where they are in camera space, z towards the eye.
struct Points {
  MF seen;
  VF depth;
  V3 p;
};

HWY_INLINE Points pointsAt(const raster::Plane<float>& plane, const Projector& projector, int x, int y) {
  const DF d;
  const VF depth = hn::LoadU(d, plane.row(y) + x);
  const VF xPx = hn::Add(hn::ConvertTo(d, hn::Iota(DI(), projector.xFirst + x)), hn::Set(d, 0.5f));
  VF px = hn::Mul(hn::Sub(xPx, hn::Set(d, projector.xCenter)), hn::Set(d, projector.xInverse));
  VF py = hn::Set(d, (float(projector.yFirst + y) + 0.5f - projector.yCenter) * projector.yInverse);
  if (projector.perspective) px = hn::Mul(px, depth), py = hn::Mul(py, depth);
  const MF inRow = hn::Lt(hn::ConvertTo(d, hn::Iota(DI(), x)), hn::Set(d, float(plane.width())));
  return {hn::And(inRow, hn::Lt(depth, hn::Set(d, std::numeric_limits<float>::infinity()))), depth, {px, py, hn::Neg(depth)}};
}

struct Arriving {
  MF lit;
  VF cosine;   // n . l
  VF amount;   // falloff times cosine, >= 0
  V3 toLight;  // unit, camera space
  V3 q;        // the point in light space; of directional lights without maps nothing
};

HWY_INLINE Arriving arriving(const PunctualLight& light, const Points& at, const V3& n) {
  const DF d;
  const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  Arriving a{at.seen, zero, zero, set3(light.place), at.p};
  if (light.kind == LightKind::Directional) {
    a.cosine = a.amount = dot(n, a.toLight);
    a.lit = hn::And(a.lit, hn::Gt(a.amount, zero));
    if (light.maps > 0) a.q = toLightSpace(light, at.p);
    return a;
  }
  a.q = toLightSpace(light, at.p);
  const V3 way{hn::Sub(a.toLight.x, at.p.x), hn::Sub(a.toLight.y, at.p.y), hn::Sub(a.toLight.z, at.p.z)};
  const VF perLength = hn::Div(one, hn::Sqrt(dot(way, way)));
  a.toLight = {hn::Mul(way.x, perLength), hn::Mul(way.y, perLength), hn::Mul(way.z, perLength)};
  a.cosine = dot(n, a.toLight);
  const VF square = dot(a.q, a.q);
  const VF ofRange = hn::Mul(square, hn::Set(d, light.range > 0 ? 1 / (light.range * light.range) : 0));
  const VF window = hn::Sub(one, hn::Mul(ofRange, ofRange));
  a.lit = hn::And(hn::And(a.lit, hn::Gt(a.cosine, zero)), hn::And(hn::Gt(window, zero), hn::Gt(square, hn::Set(d, 1e-30f))));
  VF falloff = hn::Min(hn::Div(window, square), hn::Set(d, 1e15f));
  if (light.kind == LightKind::Spot) {
    const VF toAxis = hn::Div(dot(a.q, set3(light.axis)), hn::Sqrt(square));
    const VF s = hn::Add(hn::Mul(toAxis, hn::Set(d, light.coneScale)), hn::Set(d, light.coneOffset));
    a.lit = hn::And(a.lit, hn::Gt(s, zero));
    const VF inside = hn::Min(s, one);
    falloff = hn::Mul(falloff, hn::Mul(inside, inside));
  }
  a.amount = hn::Mul(falloff, a.cosine);
  a.lit = hn::And(a.lit, hn::Gt(a.amount, zero));  // it may underflow
  return a;
}

// Of which of six maps: that of the largest coordinate.
HWY_INLINE MF belongsTo(int map, const V3& q) {
  const DF d;
  const VF x = hn::Abs(q.x), y = hn::Abs(q.y), z = hn::Abs(q.z);
  const MF isX = hn::And(hn::Ge(x, y), hn::Ge(x, z)), isY = hn::AndNot(isX, hn::Ge(y, z));
  const MF axis = map < 2 ? isX : map < 4 ? isY : hn::Not(hn::Or(isX, isY));
  const MF against = hn::Lt(map < 2 ? q.x : map < 4 ? q.y : q.z, hn::Zero(d));
  return map % 2 ? hn::And(axis, against) : hn::AndNot(against, axis);
}

// (x, y, w) of one of six maps.
HWY_INLINE V3 inMap(int map, const V3& q) {
  const VF coordinates[3] = {q.x, q.y, q.z};
  const int axis = map / 2, next = (axis + 1) % 3, last = (axis + 2) % 3;
  return map % 2 ? V3{coordinates[next], coordinates[last], hn::Neg(coordinates[axis])}
                 : V3{coordinates[last], coordinates[next], coordinates[axis]};
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::post
HWY_AFTER_NAMESPACE();
#endif
