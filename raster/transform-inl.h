// Per-target: object space -> view space -> sub-pixels, for the vertex stage and for resolve, which must get the
// same bits. Included once per target by each kernel that needs it.
#if defined(OBSCURA_TRANSFORM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef OBSCURA_TRANSFORM_INL_H_
#undef OBSCURA_TRANSFORM_INL_H_
#else
#define OBSCURA_TRANSFORM_INL_H_
#endif

#include <hwy/highway.h>

#include "obscura/raster/view.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::raster {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Rows of 16 pixels are the padding unit of planes and tiles, so no vector is longer.
using DF = hn::CappedTag<float, 16>;
using DI = hn::RebindToSigned<DF>;
using DU = hn::RebindToUnsigned<DF>;
using VF = hn::Vec<DF>;
using VI = hn::Vec<DI>;
using VU = hn::Vec<DU>;
using MF = hn::Mask<DF>;
using MI = hn::Mask<DI>;

struct V3 {
  VF x, y, z;
};

HWY_INLINE V3 viewPosition(const Draw& draw, VF x, VF y, VF z) {
  const DF d;
  auto row = [&](const float m[4]) HWY_ATTR {
    const VF sum = hn::Add(hn::Add(hn::Mul(hn::Set(d, m[0]), x), hn::Mul(hn::Set(d, m[1]), y)), hn::Mul(hn::Set(d, m[2]), z));
    return hn::Add(sum, hn::Set(d, m[3]));
  };
  return {row(draw.viewFromObject[0]), row(draw.viewFromObject[1]), row(draw.viewFromObject[2])};
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::raster
HWY_AFTER_NAMESPACE();
#endif
