// Per-target: which triangles of a cluster face the eye, before they are snapped (see setup.h).
#if defined(OBSCURA_FACING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef OBSCURA_FACING_INL_H_
#undef OBSCURA_FACING_INL_H_
#else
#define OBSCURA_FACING_INL_H_
#endif

#include <cmath>

#include <hwy/highway.h>

#include "obscura/raster/setup.h"
#include "obscura/raster/transform-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::raster {
namespace HWY_NAMESPACE {

// By the cluster's planes; what is too close to call is decided exactly, one by one.
class Facing {
 public:
  Facing(const Draw& draw, const Cluster& cluster)
      : draw_(draw), all_(*draw.clusters), first_(cluster.firstTriangle), every_(draw.material->doubleSided || !draw.invertible) {
    // n . (eye - center) - n . (v0 - center), against 16 times the rounding error that either side can have.
    const float turn = draw.away ? -1.0f : 1.0f;  // changes all signs below, and no rounding
    float distance = 0;
    for (int c = 0; c < 3; ++c) {
      const float toEye = draw.eye[3] > 0 ? draw.eye[c] - cluster.center[c] : draw.eye[c];
      distance += std::fabs(toEye);
      toEye_[c] = turn * toEye;
    }
    w_ = turn * draw.eye[3];
    const float reach = distance + cluster.radius * draw.eye[3];
    // Below 1e-12 products with a plane of 1e-18 come near to underflow: everything is decided exactly.
    slack_ = reach > 1e-12f ? reach * (1.0f / (1 << 20)) : HUGE_VALF;
  }

  // Of the triangles `valid` of the vector from the cluster's triangle t.
  HWY_INLINE MI of(int t, MI valid) const {
    if (every_) return valid;
    const DF d;
    const DI di;
    const size_t at = first_ + size_t(t);
    const VF nx = hn::LoadU(d, all_.planeX.data() + at), ny = hn::LoadU(d, all_.planeY.data() + at);
    const VF nz = hn::LoadU(d, all_.planeZ.data() + at), nw = hn::LoadU(d, all_.planeW.data() + at);
    const VF toX = hn::Mul(nx, hn::Set(d, toEye_[0])), toY = hn::Mul(ny, hn::Set(d, toEye_[1])), toZ = hn::Mul(nz, hn::Set(d, toEye_[2]));
    const VF side = hn::Sub(hn::Add(hn::Add(toX, toY), toZ), hn::Mul(nw, hn::Set(d, w_)));
    const VF error = hn::Mul(hn::Add(hn::Add(hn::Abs(nx), hn::Abs(ny)), hn::Abs(nz)), hn::Set(d, slack_));
    const MI front = hn::And(hn::RebindMask(di, hn::Gt(side, error)), valid);
    const MI back = hn::RebindMask(di, hn::Lt(side, hn::Neg(error)));
    const MI noArea = hn::RebindMask(di, hn::Eq(error, hn::Zero(d)));  // n is 0 and faces nothing
    const MI unsure = hn::AndNot(hn::Or(hn::Or(front, back), noArea), valid);
    if (HWY_LIKELY(hn::AllFalse(di, unsure))) return front;
    HWY_ALIGN int32_t faces[16];
    hn::Store(hn::VecFromMask(di, unsure), di, faces);
    for (size_t k = 0; k < hn::Lanes(di); ++k) faces[k] = faces[k] != 0 && facesEye(draw_, all_.triangle[at + k]);
    return hn::Or(front, hn::Ne(hn::Load(di, faces), hn::Zero(di)));
  }

 private:
  const Draw& draw_;
  const Clusters& all_;
  size_t first_;
  bool every_;
  float toEye_[3], w_, slack_;
};

}  // namespace HWY_NAMESPACE
}  // namespace obscura::raster
HWY_AFTER_NAMESPACE();
#endif
