// Per target: the height map at a vector of texture coordinates.
#if defined(OBSCURA_HEIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef OBSCURA_HEIGHT_INL_H_
#undef OBSCURA_HEIGHT_INL_H_
#else
#define OBSCURA_HEIGHT_INL_H_
#endif

#include <hwy/highway.h>

#include "obscura/raster/texture-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::raster {
namespace HWY_NAMESPACE {

// Linear between the texels' centres.
HWY_INLINE VF heightAt(const HeightView& map, VF u, VF v) {
  const DF d;
  const DI di;
  const VI w = hn::Set(di, map.width), h = hn::Set(di, map.height);
  const VF half = hn::Set(d, 0.5f);
  const VF x = hn::Sub(hn::Mul(wrapCoordinate(u, map.wrapU), hn::ConvertTo(d, w)), half);
  const VF y = hn::Sub(hn::Mul(wrapCoordinate(v, map.wrapV), hn::ConvertTo(d, h)), half);
  const VF left = hn::Floor(x), top = hn::Floor(y), fx = hn::Sub(x, left), fy = hn::Sub(y, top);
  const VI x0 = hn::ConvertTo(di, left), y0 = hn::ConvertTo(di, top), one = hn::Set(di, 1);
  const auto line = [&](VI row) HWY_ATTR {
    const VI first = hn::Mul(wrapTexel(row, h, map.wrapV), w);
    const VF a = hn::GatherIndex(d, map.heights.data(), hn::Add(first, wrapTexel(x0, w, map.wrapU)));
    const VF b = hn::GatherIndex(d, map.heights.data(), hn::Add(first, wrapTexel(hn::Add(x0, one), w, map.wrapU)));
    return hn::Add(a, hn::Mul(hn::Sub(b, a), fx));
  };
  const VF a = line(y0), b = line(hn::Add(y0, one));
  return hn::Add(a, hn::Mul(hn::Sub(b, a), fy));
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::raster
HWY_AFTER_NAMESPACE();
#endif
