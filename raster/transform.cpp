#include "obscura/raster/transform.h"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "obscura/raster/transform.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "obscura/raster/transform-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::raster {
namespace HWY_NAMESPACE {

HWY_INLINE int32_t lanesLeast(VI v) { return hn::GetLane(hn::MinOfLanes(DI(), v)); }

void TransformVertices(const View& view, const Draw& draw, const float* x, const float* y, const float* z, int count,
                       TransformedVertices& out) {
  const DF d;
  const DI di;
  const int lanes = int(hn::Lanes(d));
  const VF zNear = hn::Set(d, view.zNear), zFar = hn::Set(d, view.zFar), guard = hn::Set(d, float(kGuardSub));
  const VF xScale = hn::Set(d, view.xScaleSub), yScale = hn::Set(d, view.yScaleSub);
  const VF xShift = hn::Set(d, view.xShiftSub), yShift = hn::Set(d, view.yShiftSub);
  const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  auto bit = [&](MF mask, Outcode code) HWY_ATTR {
    return hn::IfThenElseZero(hn::RebindMask(di, mask), hn::Set(di, int32_t(code)));
  };

  const int32_t most = std::numeric_limits<int32_t>::max();
  VF nearest = hn::Set(d, -std::numeric_limits<float>::infinity());
  VI xLeast = hn::Set(di, most), yLeast = xLeast, xGreatest = hn::Set(di, -most), yGreatest = xGreatest;
  VI anyCode = hn::Zero(di), allCodes = hn::Set(di, -1);
  for (int i = 0; i < count; i += lanes) {
    const V3 p = viewPosition(draw, hn::LoadU(d, x + i), hn::LoadU(d, y + i), hn::LoadU(d, z + i));
    const VF zView = hn::Neg(p.z);
    const MF inFront = hn::Ge(zView, zNear);
    const VF inverse = view.perspective ? hn::Div(one, zView) : one;
    const VF xs = hn::Add(hn::Mul(hn::Mul(p.x, inverse), xScale), xShift);
    const VF ys = hn::Add(hn::Mul(hn::Mul(p.y, inverse), yScale), yShift);
    const MF inGuard = hn::And(hn::Le(hn::Abs(xs), guard), hn::Le(hn::Abs(ys), guard));
    const MF usable = hn::And(inFront, inGuard);
    const VI xSub = hn::NearestInt(hn::IfThenElse(usable, xs, zero));
    const VI ySub = hn::NearestInt(hn::IfThenElse(usable, ys, zero));

    VI code = bit(hn::Not(inFront), kBeforeNear);
    code = hn::Or(code, bit(hn::Gt(zView, zFar), kBeyondFar));
    code = hn::Or(code, bit(hn::Not(inGuard), kOutsideGuard));
    auto side = [&](MI outside, Outcode c) HWY_ATTR {
      code = hn::Or(code, hn::IfThenElseZero(hn::And(outside, hn::RebindMask(di, usable)), hn::Set(di, int32_t(c))));
    };
    side(hn::Lt(xSub, hn::Set(di, view.xFirstSub)), kLeft);
    side(hn::Gt(xSub, hn::Set(di, view.xLastSub)), kRight);
    side(hn::Lt(ySub, hn::Set(di, view.yFirstSub)), kAbove);
    side(hn::Gt(ySub, hn::Set(di, view.yLastSub)), kBelow);

    const MI real = hn::Lt(hn::Iota(di, i), hn::Set(di, count));  // the padding repeats a vertex, but need not
    xLeast = hn::IfThenElse(real, hn::Min(xLeast, xSub), xLeast);
    yLeast = hn::IfThenElse(real, hn::Min(yLeast, ySub), yLeast);
    xGreatest = hn::IfThenElse(real, hn::Max(xGreatest, xSub), xGreatest);
    yGreatest = hn::IfThenElse(real, hn::Max(yGreatest, ySub), yGreatest);
    hn::Store(xSub, di, out.xSub + i);
    hn::Store(ySub, di, out.ySub + i);
    const VF key = view.perspective ? inverse : p.z;
    nearest = hn::IfThenElse(hn::And(hn::RebindMask(d, real), hn::Gt(key, nearest)), key, nearest);
    hn::Store(key, d, out.key + i);
    hn::Store(code, di, out.code + i);
    anyCode = hn::Or(anyCode, hn::IfThenElseZero(real, code));
    allCodes = hn::And(allCodes, hn::IfThenElse(real, code, allCodes));
  }
  HWY_ALIGN int32_t any[16], all[16];
  hn::Store(anyCode, di, any);
  hn::Store(allCodes, di, all);
  out.anyCode = 0;
  out.allCodes = -1;
  for (int i = 0; i < lanes; ++i) {
    out.anyCode |= any[i];
    out.allCodes &= all[i];
  }
  out.xLeast = lanesLeast(xLeast);
  out.yLeast = lanesLeast(yLeast);
  out.xGreatest = -lanesLeast(hn::Neg(xGreatest));
  out.yGreatest = -lanesLeast(hn::Neg(yGreatest));
  out.nearestKey = hn::GetLane(hn::MaxOfLanes(d, nearest));
  out.packed = out.xGreatest - out.xLeast <= 0xFFFF && out.yGreatest - out.yLeast <= 0xFFFF;
  for (int i = 0; out.packed && i < count; i += lanes) {
    const VI x0 = hn::Sub(hn::Load(di, out.xSub + i), hn::Set(di, out.xLeast));
    const VI y0 = hn::Sub(hn::Load(di, out.ySub + i), hn::Set(di, out.yLeast));
    hn::Store(hn::Or(hn::And(x0, hn::Set(di, 0xFFFF)), hn::ShiftLeft<16>(y0)), di, out.xy + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "obscura/raster/dispatch.h"

namespace obscura::raster {

HWY_EXPORT(TransformVertices);

void transformVertices(const View& view, const Draw& draw, const float* x, const float* y, const float* z, int count,
                       TransformedVertices& out, Target target) {
  OBSCURA_DISPATCH(TransformVertices, target)(view, draw, x, y, z, count, out);
}

}  // namespace obscura::raster
#endif
