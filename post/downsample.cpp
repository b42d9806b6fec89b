#include "obscura/post/downsample.h"

#include <cstring>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "obscura/post/downsample.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "obscura/post/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::post {
namespace HWY_NAMESPACE {

// Columns 0 ... s - 1 of one row of sub-pixels, for the pixels from x on, one per lane.
template <class D>
HWY_INLINE void loadColumns(D d, const hn::TFromD<D>* row, int width, int s, int x, hn::Vec<D> (&columns)[4]) {
  using T = hn::TFromD<D>;
  const T* from = row + size_t(s) * size_t(x);
  HWY_ALIGN T last[4 * 16];
  if (x + int(hn::Lanes(d)) > width) {  // the sub-pixels' row may end before a whole vector of pixels does
    std::memset(last, 0, sizeof last);
    std::memcpy(last, from, size_t(s) * size_t(width - x) * sizeof(T));
    from = last;
  }
  if (s == 2) hn::LoadInterleaved2(d, from, columns[0], columns[1]);
  else hn::LoadInterleaved4(d, from, columns[0], columns[1], columns[2], columns[3]);
}

HWY_INLINE VF sumOfRow(const float* row, int width, int s, int x) {
  VF v[4];
  loadColumns(DF(), row, width, s, x, v);
  const VF left = hn::Add(v[0], v[1]);
  return s == 2 ? left : hn::Add(left, hn::Add(v[2], v[3]));
}

void MeanOfSubpixels(const raster::Plane<float>& in, int s, int y0, int y1, raster::Plane<float>& out) {
  const DF d;
  const int width = out.width();
  const VF share = hn::Set(d, s == 2 ? 0.25f : 0.0625f);
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < width; x += int(hn::Lanes(d))) {
      const int top = y * s;
      VF sum = hn::Add(sumOfRow(in.row(top), width, s, x), sumOfRow(in.row(top + 1), width, s, x));
      if (s == 4)
        sum = hn::Add(sum, hn::Add(sumOfRow(in.row(top + 2), width, s, x), sumOfRow(in.row(top + 3), width, s, x)));
      hn::StoreU(hn::Mul(sum, share), d, out.row(y) + x);
    }
}

void NearestSubpixel(const raster::Plane<float>& depth, int s, int y0, int y1, raster::Plane<uint32_t>& nearest) {
  const DF d;
  const DI di;
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < nearest.width(); x += int(hn::Lanes(d))) {
      VF least = hn::Set(d, std::numeric_limits<float>::infinity());
      VI which = hn::Zero(di);
      for (int j = 0; j < s; ++j) {
        VF z[4];
        loadColumns(d, depth.row(y * s + j), nearest.width(), s, x, z);
        for (int i = 0; i < s; ++i) {
          const MF nearer = hn::Lt(z[i], least);
          least = hn::IfThenElse(nearer, z[i], least);
          which = hn::IfThenElse(hn::RebindMask(di, nearer), hn::Set(di, j * s + i), which);
        }
      }
      hn::StoreU(which, di, reinterpret_cast<int32_t*>(nearest.row(y)) + x);
    }
}

// `in` and `out` as planes of float or uint32_t, of which Lane is the type in vectors.
template <class Lane, class T>
HWY_INLINE void take(const raster::Plane<T>& in, const raster::Plane<uint32_t>& nearest, int s, int y0, int y1,
                     raster::Plane<T>& out) {
  const hn::Rebind<Lane, DF> d;
  const DI di;
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < out.width(); x += int(hn::Lanes(d))) {
      const VI which = hn::LoadU(di, reinterpret_cast<const int32_t*>(nearest.row(y)) + x);
      auto taken = hn::Zero(d);
      for (int j = 0; j < s; ++j) {
        hn::Vec<decltype(d)> v[4];
        loadColumns(d, reinterpret_cast<const Lane*>(in.row(y * s + j)), out.width(), s, x, v);
        for (int i = 0; i < s; ++i)
          taken = hn::IfThenElse(hn::RebindMask(d, hn::Eq(which, hn::Set(di, j * s + i))), v[i], taken);
      }
      hn::StoreU(taken, d, reinterpret_cast<Lane*>(out.row(y)) + x);
    }
}

void TakeValues(const raster::Plane<float>& in, const raster::Plane<uint32_t>& nearest, int s, int y0, int y1,
                raster::Plane<float>& out) {
  take<float>(in, nearest, s, y0, y1, out);
}

void TakeIds(const raster::Plane<uint32_t>& in, const raster::Plane<uint32_t>& nearest, int s, int y0, int y1,
             raster::Plane<uint32_t>& out) {
  take<int32_t>(in, nearest, s, y0, y1, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::post
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "obscura/raster/dispatch.h"
#include "obscura/raster/float_environment.h"

namespace obscura::post {

HWY_EXPORT(MeanOfSubpixels);
HWY_EXPORT(NearestSubpixel);
HWY_EXPORT(TakeValues);
HWY_EXPORT(TakeIds);

void meanOfSubpixels(const raster::Plane<float>& in, int s, int y0, int y1, raster::Plane<float>& out,
                     raster::Target target) {
  const raster::FloatEnvironment environment;
  OBSCURA_DISPATCH(MeanOfSubpixels, target)(in, s, y0, y1, out);
}

void nearestSubpixel(const raster::Plane<float>& depth, int s, int y0, int y1, raster::Plane<uint32_t>& nearest,
                     raster::Target target) {
  const raster::FloatEnvironment environment;
  OBSCURA_DISPATCH(NearestSubpixel, target)(depth, s, y0, y1, nearest);
}

void takeSubpixel(const raster::Plane<float>& in, const raster::Plane<uint32_t>& nearest, int s, int y0, int y1,
                  raster::Plane<float>& out, raster::Target target) {
  OBSCURA_DISPATCH(TakeValues, target)(in, nearest, s, y0, y1, out);
}

void takeSubpixel(const raster::Plane<uint32_t>& in, const raster::Plane<uint32_t>& nearest, int s, int y0, int y1,
                  raster::Plane<uint32_t>& out, raster::Target target) {
  OBSCURA_DISPATCH(TakeIds, target)(in, nearest, s, y0, y1, out);
}

}  // namespace obscura::post
#endif
