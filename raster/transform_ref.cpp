// Scalar twin of transform.cpp.
#include <cmath>

#include "obscura/raster/transform.h"

namespace obscura::raster {

void transformVerticesRef(const View& view, const Draw& draw, const float* x, const float* y, const float* z, int count,
                          TransformedVertices& out) {
  out.anyCode = 0;
  out.packed = false;
  out.allCodes = -1;
  for (int i = 0; i < count; ++i) {
    float p[3];
    for (int r = 0; r < 3; ++r) {
      const float* m = draw.viewFromObject[r];
      p[r] = m[0] * x[i] + m[1] * y[i] + m[2] * z[i] + m[3];
    }
    const float w = view.perspective ? 1.0f / -p[2] : 1.0f;
    const float xs = p[0] * w * view.xScaleSub + view.xShiftSub;
    const float ys = p[1] * w * view.yScaleSub + view.yShiftSub;

    int32_t code = 0;
    if (!(-p[2] >= view.zNear)) code |= kBeforeNear;
    if (-p[2] > view.zFar) code |= kBeyondFar;
    if (!(std::fabs(xs) <= float(kGuardSub)) || !(std::fabs(ys) <= float(kGuardSub))) code |= kOutsideGuard;
    const bool usable = (code & (kBeforeNear | kOutsideGuard)) == 0;
    // The default rounding mode makes nearbyint round halves to even.
    out.xSub[i] = usable ? int32_t(std::nearbyint(xs)) : 0;
    out.ySub[i] = usable ? int32_t(std::nearbyint(ys)) : 0;
    if (usable && out.xSub[i] < view.xFirstSub) code |= kLeft;
    if (usable && out.xSub[i] > view.xLastSub) code |= kRight;
    if (usable && out.ySub[i] < view.yFirstSub) code |= kAbove;
    if (usable && out.ySub[i] > view.yLastSub) code |= kBelow;
    out.key[i] = view.perspective ? w : p[2];
    out.code[i] = code;
    out.anyCode |= code;
    out.allCodes &= code;
  }
}

}  // namespace obscura::raster
