// The methods that measure volumes: Ssao and Vao of peer_methods.h.
#include "obscura/apps/peer_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "obscura/apps/peer_volumes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "obscura/apps/peer_rows-inl.h"
#include "obscura/post/depth_map-inl.h"
#include "obscura/post/ray_points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::apps {
namespace HWY_NAMESPACE {
using post::HWY_NAMESPACE::DealtPoints;
using post::HWY_NAMESPACE::DepthMap;

template <bool kPerspective>
class SsaoMethod {
 public:
  SsaoMethod(const post::TransferInput& in, const PeerSettings&) : samples_(size_t(in.settings.samples)), map_(in), points_(in, 1) {}
  void startRow(int yImage) { points_.startRow(yImage); }

  HWY_INLINE VF open(const Pixel& at, int x) const {
    const DF d;
    const VF one = hn::Set(d, 1.0f), two = hn::Set(d, 2.0f), zero = hn::Zero(d);
    VF sum = zero;
    for (size_t i = 0; i < samples_; ++i) {
      const V3 o = points_.at(i, x);
      const V3 p{hn::Add(at.position.x, o.x), hn::Add(at.position.y, o.y), hn::Add(at.position.z, o.z)};
      const VF stored = hn::GatherIndex(d, map_.depth, map_.texelOf(p));
      const MF below = hn::And(hn::Gt(p.z, stored), hn::Gt(p.z, map_.zNear));
      const MF near = hn::Lt(hn::Sub(at.position.z, stored), map_.deepest);
      sum = hn::Add(sum, hn::IfThenElse(below, hn::IfThenElse(near, zero, one), two));
    }
    return sum;
  }

 private:
  const size_t samples_;
  const DepthMap<kPerspective> map_;
  DealtPoints points_;
};

template <bool kPerspective>
class VaoMethod {
 public:
  VaoMethod(const post::TransferInput& in, const PeerSettings&)
      : samples_(size_t(in.settings.samples)), half_(hn::Set(DF(), 0.5f * in.settings.radius)), map_(in), points_(in, 1) {}
  void startRow(int yImage) { points_.startRow(yImage); }

  HWY_INLINE VF open(const Pixel& at, int x) const {
    const DF d;
    const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    const auto raised = [&](VF p, VF n) HWY_ATTR { return hn::Add(p, hn::Mul(half_, n)); };
    const V3 center{raised(at.position.x, at.n.x), raised(at.position.y, at.n.y), raised(at.position.z, at.n.z)};
    V3 e{zero, zero, one};  // the view axis through it
    if (kPerspective) {
      const VF inverse = hn::Div(one, hn::Sqrt(dot(center, center)));
      e = {hn::Mul(center.x, inverse), hn::Mul(center.y, inverse), hn::Mul(center.z, inverse)};
    }
    // Two axes across it (Frisvad 2012).
    const VF k = hn::Div(one, hn::Add(one, e.z)), mixed = hn::Neg(hn::Mul(hn::Mul(e.x, e.y), k));
    const V3 b1{hn::Sub(one, hn::Mul(hn::Mul(e.x, e.x), k)), mixed, hn::Neg(e.x)};
    const V3 b2{mixed, hn::Sub(one, hn::Mul(hn::Mul(e.y, e.y), k)), hn::Neg(e.y)};
    VF whole = zero, inner = zero;
    for (size_t i = 0; i < samples_; ++i) {
      const V3 o = points_.at(i, x);
      const auto shifted = [&](VF p, VF b, VF c) HWY_ATTR { return hn::Add(p, hn::Add(hn::Mul(o.x, b), hn::Mul(o.y, c))); };
      const V3 p{shifted(center.x, b1.x, b2.x), shifted(center.y, b1.y, b2.y), shifted(center.z, b1.z, b2.z)};
      const VF stored = hn::GatherIndex(d, map_.depth, map_.texelOf(p)), along = hn::Mul(o.z, e.z);
      const VF begin = hn::Sub(p.z, along), end = hn::Add(p.z, along), last = hn::Add(stored, map_.deepest);
      const VF from = hn::IfThenElse(hn::Gt(stored, begin), stored, begin), to = hn::IfThenElse(hn::Lt(last, end), last, end);
      whole = hn::Add(whole, hn::Sub(end, begin));
      inner = hn::Add(inner, hn::IfThenElseZero(hn::Gt(to, from), hn::Sub(to, from)));
    }
    const MF sound = hn::Gt(whole, zero);
    const VF n = hn::Set(d, float(samples_));
    return hn::Sub(n, hn::Mul(n, hn::IfThenElseZero(sound, hn::Div(inner, hn::IfThenElse(sound, whole, one)))));
  }

 private:
  const size_t samples_;
  const VF half_;
  const DepthMap<kPerspective> map_;
  DealtPoints points_;
};

void PeerVolumes(const PeerSettings& peer, const post::TransferInput& in, int y0, int y1, post::TransferSums& out) {
  if (peer.method == PeerMethod::Ssao) peerRows<SsaoMethod>(peer, in, y0, y1, out);
  else peerRows<VaoMethod>(peer, in, y0, y1, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::apps
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "obscura/raster/dispatch.h"

namespace obscura::apps {

HWY_EXPORT(PeerVolumes);

void peerVolumes(const PeerSettings& peer, const post::TransferInput& in, int y0, int y1, post::TransferSums& out, raster::Target target) {
  OBSCURA_DISPATCH(PeerVolumes, target)(peer, in, y0, y1, out);
}

}  // namespace obscura::apps
#endif
