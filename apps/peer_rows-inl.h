// Per target: what the methods of peer_methods.h have in common: vectors of pixels and what the depth map shows in a texel.
// A method has
//   Method(in, peer)          once
//   method.startRow(yImage)   for a row
//   method.open(at, x)        n times the openness of a vector of pixels, columns x ...
#if defined(OBSCURA_APPS_PEER_ROWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef OBSCURA_APPS_PEER_ROWS_INL_H_
#undef OBSCURA_APPS_PEER_ROWS_INL_H_
#else
#define OBSCURA_APPS_PEER_ROWS_INL_H_
#endif

#include <limits>

#include "obscura/apps/peer_methods.h"
#include "obscura/post/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::apps {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using post::HWY_NAMESPACE::DF;
using post::HWY_NAMESPACE::DI;
using post::HWY_NAMESPACE::dot;
using post::HWY_NAMESPACE::MF;
using post::HWY_NAMESPACE::V3;
using post::HWY_NAMESPACE::VF;
using post::HWY_NAMESPACE::VI;

// z away from the eye; `eye` is unit and points to it.
struct Pixel {
  V3 position, n, eye;
};

HWY_INLINE V3 minus(const V3& a, const V3& b) { return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)}; }

template <bool kPerspective>
HWY_INLINE Pixel placed(const post::TransferInput& in, int x, int y, VF z) {
  const DF d;
  const post::Projector& p = in.projector;
  Pixel at;
  VF px = hn::Add(hn::ConvertTo(d, hn::Iota(DI(), x + p.xFirst)), hn::Set(d, 0.5f));
  VF py = hn::Set(d, (float(y + p.yFirst) + 0.5f - p.yCenter) * p.yInverse);
  px = hn::Mul(hn::Sub(px, hn::Set(d, p.xCenter)), hn::Set(d, p.xInverse));
  if (kPerspective) px = hn::Mul(px, z), py = hn::Mul(py, z);
  at.position = {px, py, z};
  at.n = {hn::LoadU(d, in.g->normal[0].row(y) + x), hn::LoadU(d, in.g->normal[1].row(y) + x),
          hn::Neg(hn::LoadU(d, in.g->normal[2].row(y) + x))};
  at.eye = {hn::Zero(d), hn::Zero(d), hn::Set(d, -1.0f)};
  if (kPerspective) {
    const VF inverse = hn::Div(hn::Set(d, -1.0f), hn::Sqrt(dot(at.position, at.position)));
    at.eye = {hn::Mul(px, inverse), hn::Mul(py, inverse), hn::Mul(z, inverse)};
  }
  return at;
}

// The points that texels show.
template <bool kPerspective>
class SeenPoints {
 public:
  explicit SeenPoints(const post::TransferInput& in) : depth_(in.g->depth.data()) {
    const DF d;
    const post::Projector& p = in.projector;
    xScale_ = hn::Set(d, p.xScale), yScale_ = hn::Set(d, p.yScale), xInverse_ = hn::Set(d, p.xInverse), yInverse_ = hn::Set(d, p.yInverse);
    xCenter_ = hn::Set(d, p.xCenter), yCenter_ = hn::Set(d, p.yCenter);
    firstX_ = hn::Set(d, float(p.xFirst)), firstY_ = hn::Set(d, float(p.yFirst));
    lastX_ = hn::Set(d, float(p.xFirst + p.width - 1)), lastY_ = hn::Set(d, float(p.yFirst + p.height - 1));
    stride_ = hn::Set(DI(), int32_t(in.g->depth.stride()));
    origin_ = hn::Set(DI(), p.yFirst * int32_t(in.g->depth.stride()) + p.xFirst);
  }

  // In the texel of x / z and y / z (orthographic: of x and y), clamped to the G-buffer.
  HWY_INLINE V3 at(VF u, VF v) const {
    const DF d;
    const VF column = within(hn::Add(hn::Mul(u, xScale_), xCenter_), firstX_, lastX_);
    const VF row = within(hn::Add(hn::Mul(v, yScale_), yCenter_), firstY_, lastY_);
    const VI texel = hn::Sub(hn::Add(hn::Mul(post::HWY_NAMESPACE::truncated(row), stride_), post::HWY_NAMESPACE::truncated(column)), origin_);
    const VF z = hn::GatherIndex(d, depth_, texel), half = hn::Set(d, 0.5f);
    VF x = hn::Mul(hn::Sub(hn::Add(column, half), xCenter_), xInverse_), y = hn::Mul(hn::Sub(hn::Add(row, half), yCenter_), yInverse_);
    if (kPerspective) x = hn::Mul(x, z), y = hn::Mul(y, z);
    return {x, y, z};
  }

 private:
  HWY_INLINE static VF within(VF c, VF first, VF last) {  // NaN becomes the first
    const VF from = hn::IfThenElse(hn::Gt(c, first), c, first);
    return hn::Floor(hn::IfThenElse(hn::Lt(from, last), from, last));
  }

  const float* depth_;
  VF xScale_, yScale_, xInverse_, yInverse_, xCenter_, yCenter_, firstX_, firstY_, lastX_, lastY_;
  VI stride_, origin_;
};

template <bool kPerspective, class Method>
void peerRows(const PeerSettings& peer, const post::TransferInput& in, int y0, int y1, post::TransferSums& out) {
  const DF d;
  const raster::GBuffer& g = *in.g;
  const VF all = hn::Set(d, float(in.settings.samples)), one = hn::Set(d, 1.0f);
  const VF infinity = hn::Set(d, std::numeric_limits<float>::infinity());
  Method method(in, peer);
  for (int y = y0; y < y1; ++y) {
    method.startRow(y + in.projector.yFirst);
    for (int x = 0; x < g.width; x += int(hn::Lanes(d))) {
      const MF inside = hn::RebindMask(d, hn::Lt(hn::Iota(DI(), x), hn::Set(DI(), g.width)));
      const VF z = hn::LoadU(d, g.depth.row(y) + x);
      const MF seen = hn::And(hn::Lt(z, infinity), inside);
      VF value = all;
      if (!hn::AllFalse(d, seen)) value = method.open(placed<kPerspective>(in, x, y, hn::IfThenElse(seen, z, one)), x);
      value = hn::IfThenElse(hn::Eq(value, value), value, hn::Zero(d));  // of what is no normal
      value = hn::IfThenElse(seen, value, all);
      hn::StoreU(value, d, out.numerator.row(y) + x);
      uint8_t& open = out.open.at(x / post::kSegment, y);
      const uint8_t before = x % post::kSegment == 0 ? 1 : open;
      open = before & uint8_t(hn::AllTrue(d, hn::Eq(value, all)));
    }
  }
}

template <template <bool> class Method>
void peerRows(const PeerSettings& peer, const post::TransferInput& in, int y0, int y1, post::TransferSums& out) {
  if (in.projector.perspective) peerRows<true, Method<true>>(peer, in, y0, y1, out);
  else peerRows<false, Method<false>>(peer, in, y0, y1, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::apps
HWY_AFTER_NAMESPACE();
#endif
