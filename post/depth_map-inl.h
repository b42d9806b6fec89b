// Per target: the depth map as the containment test sees it.
#if defined(OBSCURA_POST_DEPTH_MAP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef OBSCURA_POST_DEPTH_MAP_INL_H_
#undef OBSCURA_POST_DEPTH_MAP_INL_H_
#else
#define OBSCURA_POST_DEPTH_MAP_INL_H_
#endif

#include <limits>

#include "obscura/post/ambient_transfer.h"
#include "obscura/post/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::post {
namespace HWY_NAMESPACE {

template <bool kPerspective>
struct DepthMap {
  const float *depth, *depth2;  // depth2: null unless two layers are known
  VF xScale, yScale, xCenter, yCenter, firstX, firstY, lastX, lastY, bias, deepest, deepest2, zNear;
  VI stride, origin;  // origin: element of the image's pixel (0, 0), were it in the G-buffer, times -1
  bool negative;      // the G-buffer reaches beyond the image's upper or left edge

  explicit DepthMap(const TransferInput& in) {
    const DF d;
    const Projector& p = in.projector;
    depth = in.g->depth.data();
    depth2 = in.settings.layers == 2 ? in.g->depth2.data() : nullptr;
    deepest2 = hn::Set(d, kHiddenThickness * in.settings.radius);
    xScale = hn::Set(d, p.xScale), yScale = hn::Set(d, p.yScale);
    xCenter = hn::Set(d, p.xCenter), yCenter = hn::Set(d, p.yCenter);
    firstX = hn::Set(d, float(p.xFirst)), firstY = hn::Set(d, float(p.yFirst));
    lastX = hn::Set(d, float(p.xFirst + p.width - 1)), lastY = hn::Set(d, float(p.yFirst + p.height - 1));
    origin = hn::Set(DI(), p.yFirst * int32_t(in.g->depth.stride()) + p.xFirst);
    negative = p.xFirst < 0 || p.yFirst < 0;
    bias = hn::Set(d, in.settings.bias), zNear = hn::Set(d, p.zNear);
    deepest = hn::Set(d, in.settings.silhouetteBound ? in.settings.radius : std::numeric_limits<float>::infinity());
    stride = hn::Set(DI(), int32_t(in.g->depth.stride()));
  }

  struct Texel {
    VI column, row;  // of the image
  };

  // The nearest texel, clamped to the G-buffer.
  HWY_INLINE Texel nearest(const V3& p) const {
    VF u = p.x, v = p.y;
    if (kPerspective) {
      const VF inverse = hn::Div(hn::Set(DF(), 1.0f), p.z);
      u = hn::Mul(u, inverse);
      v = hn::Mul(v, inverse);
    }
    return nearest(u, v);
  }

  // The same of x / z and y / z, or of x and y if the projection is orthographic.
  HWY_INLINE Texel nearest(VF u, VF v) const {
    u = hn::Add(hn::Mul(u, xScale), xCenter);
    v = hn::Add(hn::Mul(v, yScale), yCenter);
    if (HWY_UNLIKELY(negative)) u = hn::Floor(u), v = hn::Floor(v);
    return {floorOf(u, firstX, lastX), floorOf(v, firstY, lastY)};
  }

  HWY_INLINE VI element(const Texel& t) const { return hn::Sub(hn::Add(hn::Mul(t.row, stride), t.column), origin); }
  HWY_INLINE VI texelOf(const V3& p) const { return element(nearest(p)); }
  HWY_INLINE VI texelAt(VF u, VF v) const { return element(nearest(u, v)); }

  // Inner exactly when bias < z - z* < R; the upper bound keeps far foreground objects from casting silhouettes. Without
  // it the difference need only be finite. Behind the second layer the same, to kHiddenThickness R.
  HWY_INLINE MF inner(VF z, VI texel) const {
    const VF behind = hn::Sub(z, hn::GatherIndex(DF(), depth, texel));
    MF within = hn::Lt(behind, deepest);
    if (HWY_UNLIKELY(depth2 != nullptr)) {
      const VF behind2 = hn::Sub(z, hn::GatherIndex(DF(), depth2, texel));
      within = hn::Or(within, hn::And(hn::Gt(behind2, bias), hn::Lt(behind2, deepest2)));
    }
    return hn::And(hn::And(hn::Gt(behind, bias), within), hn::Gt(z, zNear));
  }

 private:
  // Truncation is the floor of what is not negative, and of integers. NaN becomes the first.
  HWY_INLINE static VI floorOf(VF c, VF first, VF last) {
#if HWY_ARCH_X86  // takes the second operand for NaN
    const VF from = hn::Max(c, first);
#else
    const VF from = hn::IfThenElse(hn::Gt(c, first), c, first);
#endif
    return truncated(hn::Min(from, last));
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace obscura::post
HWY_AFTER_NAMESPACE();
#endif
