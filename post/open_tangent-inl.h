// Per target: which pixels have only rays that stay outside, if what stops a ray must stand above the tangent plane
// (ray_march.h): nothing seen in reach does, as the bounds of the depth show.
//
// Let 1/z* <= w, w = a u + b v + c, hold for the texels in reach of a block of pixels (DepthBounds, highestOver). The point q
// seen at (u, v) has N . q = z* s, s = s_u u + s_v v + s_c (TangentPlane). It stands above if z* s > K, K = N . x + bias. Where
// K < 0 and s <= w K: s < 0, so z* s <= s / w <= K, it does not. s - w K is linear in u and v: its largest value over a rectangle
// of texels is that of its middle and, for each half side, the magnitude of the slope. Orthographic: -z* <= w and N . q = s +
// N_z z* <= s - N_z w if N_z <= 0, which must not exceed K.
#if defined(OBSCURA_POST_OPEN_TANGENT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef OBSCURA_POST_OPEN_TANGENT_INL_H_
#undef OBSCURA_POST_OPEN_TANGENT_INL_H_
#else
#define OBSCURA_POST_OPEN_TANGENT_INL_H_
#endif

#include "obscura/post/open_block-inl.h"
#include "obscura/post/ray_march-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::post {
namespace HWY_NAMESPACE {

// w over a rectangle of the image's texels.
struct TangentBlock {
  bool known = false;  // false: nothing can be said
  float a = 0, b = 0, c = 0;
  float u = 0, v = 0, uHalf = 0, vHalf = 0;
};

template <bool kPerspective>
TangentBlock tangentBlock(const TransferInput& in, const Reach& reach, int column, int row) {
  constexpr double kSteepest = 16;  // 1 / the cosine, from the eye, from which on a bias's height is not all there is to gain
  const DepthBounds& bounds = *in.bounds;
  const Projector& p = in.projector;
  const Reached at = reachedFrom<kPerspective>(in, reach, column, row);
  if (!at.known) return {};
  const float a = bounds.a.at(column, row), b = bounds.b.at(column, row), own = bounds.c.at(column, row);
  const double nearest = bounds.nearest.at(column, row), slack = kSteepest * in.settings.bias;
  const double most = own + (kPerspective ? slack / (nearest * nearest) : slack);
  const double c = highestOver(bounds, a, b, at.column0, at.column1, at.row0, at.row1, float(p.width + p.height), float(most));
  if (!(c < std::numeric_limits<double>::infinity())) return {};
  TangentBlock out{true, a, b, float(c + a * (0.5 - p.xFirst) + b * (0.5 - p.yFirst))};
  out.u = 0.5f * float(at.u.first + at.u.last) + float(p.xFirst), out.uHalf = 0.5f * float(at.u.last - at.u.first);
  out.v = 0.5f * float(at.v.first + at.v.last) + float(p.yFirst), out.vHalf = 0.5f * float(at.v.last - at.v.first);
  return out;
}

// Lanes whose rays all stay outside.
template <bool kPerspective>
HWY_INLINE MF knownOpen(const TangentBlock& block, const TangentPlane<kPerspective>& plane, const V3& n) {
  const DF d;
  const VF zero = hn::Zero(d), weight = kPerspective ? plane.least : plane.facing;
  const auto slope = [&](VF s, float w) HWY_ATTR { return hn::Sub(s, hn::Mul(hn::Set(d, w), weight)); };
  const VF su = slope(plane.a, block.a), sv = slope(plane.b, block.b);
  const VF u = hn::Set(d, block.u), v = hn::Set(d, block.v), uHalf = hn::Set(d, block.uHalf), vHalf = hn::Set(d, block.vHalf);
  VF most = hn::Add(hn::Add(hn::Mul(su, u), hn::Mul(sv, v)), slope(plane.c, block.c));
  most = hn::Add(most, hn::Add(hn::Mul(hn::Abs(su), uHalf), hn::Mul(hn::Abs(sv), vHalf)));
  if (!kPerspective) most = hn::Sub(most, plane.least);
  // Two dozen roundings here and in TangentPlane, each of at most 2^-24 of a part of this.
  const auto size = [&](VF s, float w) HWY_ATTR { return hn::Add(hn::Abs(s), hn::Mul(hn::Set(d, std::fabs(w)), hn::Abs(weight))); };
  const VF uMost = hn::Add(hn::Abs(u), uHalf), vMost = hn::Add(hn::Abs(v), vHalf);
  VF all = hn::Add(hn::Add(hn::Mul(size(plane.a, block.a), uMost), hn::Mul(size(plane.b, block.b), vMost)), size(plane.c, block.c));
  if (!kPerspective) all = hn::Add(all, hn::Abs(plane.least));
  const MF below = hn::Le(hn::Add(most, hn::Mul(all, hn::Set(d, 0x1p-18f))), zero);
  return hn::And(hn::And(below, kPerspective ? hn::Lt(weight, zero) : hn::Le(weight, zero)), hasRightFrame(n));
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::post
HWY_AFTER_NAMESPACE();
#endif
