// Vectors of directions into an environment cube: bilinear look-ups without seams.
#if defined(OBSCURA_POST_CUBE_LOOK_UP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef OBSCURA_POST_CUBE_LOOK_UP_INL_H_
#undef OBSCURA_POST_CUBE_LOOK_UP_INL_H_
#else
#define OBSCURA_POST_CUBE_LOOK_UP_INL_H_
#endif

#include "obscura/post/environment_cube.h"
#include "obscura/post/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::post {
namespace HWY_NAMESPACE {

HWY_INLINE V3 turned(const glm::mat3& m, const V3& v) {
  const DF d;
  const auto row = [&](int k) HWY_ATTR { return dot({hn::Set(d, m[0][k]), hn::Set(d, m[1][k]), hn::Set(d, m[2][k])}, v); };
  return {row(0), row(1), row(2)};
}

// Where a direction lies, whatever the size.
struct CubePoint {
  VI face;
  VF right, down;  // [-1, 1] but for roundings
};

// Any direction; of one without length it is some point, of which right and down may be no numbers.
HWY_INLINE CubePoint cubePointOf(const V3& v) {
  const DF d;
  const DI di;
  const VF ax = hn::Abs(v.x), ay = hn::Abs(v.y), az = hn::Abs(v.z), zero = hn::Zero(d);
  const MF isX = hn::And(hn::Ge(ax, ay), hn::Ge(ax, az)), isY = hn::AndNot(isX, hn::Ge(ay, az));
  const VF major = hn::IfThenElse(isX, v.x, hn::IfThenElse(isY, v.y, v.z));
  const MF negative = hn::Lt(major, zero);
  const VF m = hn::Abs(major);
  // Right: z, x, -x for the positive faces; of the negative ones x and z change sign, y does not. Up: y, but of y's faces z.
  const VF side = hn::IfThenElse(isX, v.z, v.x), minus = hn::Neg(side);
  const MF turned = hn::Xor(hn::AndNot(isY, negative), hn::AndNot(hn::Or(isX, isY), hn::Eq(zero, zero)));
  const VF right = hn::IfThenElse(turned, minus, side);
  const VF up = hn::IfThenElse(isY, hn::IfThenElse(negative, hn::Neg(v.z), v.z), v.y);
  const VI axis = hn::IfThenElseZero(hn::Not(hn::RebindMask(di, isX)), hn::IfThenElse(hn::RebindMask(di, isY), hn::Set(di, 2), hn::Set(di, 4)));
  return {hn::Add(axis, hn::IfThenElseZero(hn::RebindMask(di, negative), hn::Set(di, 1))), hn::Div(right, m), hn::Neg(hn::Div(up, m))};
}

// Position along a side, in texels from the centre of the border's first one: [1/2, size + 1/2]. NaN is 1/2.
HWY_INLINE VF alongSide(VF s, VF half) {
  const DF d;
  const VF least = hn::Set(d, 0.5f), most = hn::Add(hn::Add(half, half), least);
  const VF at = hn::Add(hn::Mul(s, half), hn::Add(half, least));
  const VF from = hn::IfThenElse(hn::Gt(at, least), at, least);
  return hn::IfThenElse(hn::Lt(from, most), from, most);
}

// Bilinear. Of each lane's cube: its size and its first texel.
inline HWY_NOINLINE V3 cubeLookUp(const glm::vec3* texels, const CubePoint& p, VI size, VI firstTexel) {
  const DF d;
  const DI di;
  const VF half = hn::Mul(hn::ConvertTo(d, size), hn::Set(d, 0.5f));
  const VF x = alongSide(p.right, half), y = alongSide(p.down, half);
  const VI i = truncated(x), j = truncated(y), row = hn::Add(size, hn::Set(di, 2));
  const VI texel = hn::Add(hn::Add(hn::Mul(hn::Add(hn::Mul(p.face, row), j), row), i), firstTexel);
  const VI first = hn::Add(hn::Add(texel, texel), texel), second = hn::Add(hn::Add(hn::Add(row, row), row), first);
  const VF one = hn::Set(d, 1.0f), u = hn::Sub(x, hn::ConvertTo(d, i)), w = hn::Sub(y, hn::ConvertTo(d, j));
  const VF u0 = hn::Sub(one, u), w0 = hn::Sub(one, w);
  const float* from = &texels[0].x;
  const auto channel = [&](int c) HWY_ATTR {
    const VF above = hn::Add(hn::Mul(hn::GatherIndex(d, from + c, first), u0), hn::Mul(hn::GatherIndex(d, from + c + 3, first), u));
    const VF below = hn::Add(hn::Mul(hn::GatherIndex(d, from + c, second), u0), hn::Mul(hn::GatherIndex(d, from + c + 3, second), u));
    return hn::Add(hn::Mul(above, w0), hn::Mul(below, w));
  };
  return {channel(0), channel(1), channel(2)};
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::post
HWY_AFTER_NAMESPACE();
#endif
