// Per target: which pixels of the filter's window count (FilterGuide). What depth_filter.cpp asks of a guide:
//   Guide(in)                           once
//   Guide::Pixel(guide, window, x, columns)   for a vector of pixels, whose windows have these columns
//   pixel.counts(window, j, i, read)    for row j, column i of the windows; read(row) gives a plane's values there
#if defined(OBSCURA_POST_FILTER_GUIDE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef OBSCURA_POST_FILTER_GUIDE_INL_H_
#undef OBSCURA_POST_FILTER_GUIDE_INL_H_
#else
#define OBSCURA_POST_FILTER_GUIDE_INL_H_
#endif

#include <algorithm>

#include "obscura/post/depth_filter.h"
#include "obscura/post/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::post {
namespace HWY_NAMESPACE {

// Where the rows of a window are read; indices 0 ... 3 stand for y - 2 ... y + 1, clamped at the image's border.
struct Window {
  const float *depth[4], *numerator[4], *denominator[3][4], *normal[3][4];
  const uint8_t* open[4];
  float yRay[4];  // y of the rows' points, at z = 1 if the projection is perspective

  // All rays of all windows of the 16 pixels from 16 segment on stay outside: O and W are 1 whichever pixels count.
  HWY_INLINE bool isOpen(int segment, int segments, bool filter) const {
    if (!filter) return open[2][segment];
    const int before = std::max(segment - 1, 0), after = std::min(segment + 1, segments - 1);
    int all = 1;
    for (int j = 0; j < 4; ++j) all &= open[j][before] & open[j][segment] & open[j][after];
    return all;
  }
};

// |z - z'| < threshold.
struct DepthGuide {
  static constexpr bool kNormals = false;
  VF threshold;

  explicit DepthGuide(const TransferInput& in) : threshold(hn::Set(DF(), in.settings.filterThreshold)) {}

  struct Pixel {
    VF z, threshold;

    HWY_INLINE Pixel(const DepthGuide& guide, const Window& window, int x, const VI (&)[4])
        : z(hn::LoadU(DF(), window.depth[2] + x)), threshold(guide.threshold) {}

    template <class Read>
    HWY_INLINE MF counts(const Window& window, int j, int, const Read& read) const {
      return hn::Lt(hn::Abs(hn::Sub(z, read(window.depth[j]))), threshold);
    }
  };
};

// |N . (p' - p)| < kPlaneDistance R and N . N' > kNormalCosine. N . p' costs two additions and a product for each of the
// 16, as the rays through the window's pixels differ by column or by row alone.
template <bool kPerspective>
struct PlaneGuide {
  static constexpr bool kNormals = true;
  VF xFirst, xCenter, xInverse, limit;

  explicit PlaneGuide(const TransferInput& in) {
    const DF d;
    const Projector& p = in.projector;
    xFirst = hn::Set(d, float(p.xFirst)), xCenter = hn::Set(d, p.xCenter), xInverse = hn::Set(d, p.xInverse);
    limit = hn::Set(d, kPlaneDistance * in.settings.radius);
  }

  struct Pixel {
    VF n[3], across[4], down[4], own, limit;

    HWY_INLINE Pixel(const PlaneGuide& guide, const Window& window, int x, const VI (&columns)[4]) : limit(guide.limit) {
      const DF d;
      for (int c = 0; c < 3; ++c) n[c] = hn::LoadU(d, window.normal[c][2] + x);
      for (int k = 0; k < 4; ++k) {
        const VF u = hn::Add(hn::Add(hn::ConvertTo(d, columns[k]), guide.xFirst), hn::Set(d, 0.5f));
        across[k] = hn::Mul(n[0], hn::Mul(hn::Sub(u, guide.xCenter), guide.xInverse));
        down[k] = hn::Mul(n[1], hn::Set(d, window.yRay[k]));
      }
      own = height(2, 2, hn::LoadU(d, window.depth[2] + x));
    }

    // N . p' of the pixel in row j, column i at depth z.
    HWY_INLINE VF height(int j, int i, VF z) const {
      const VF aside = hn::Add(across[i], down[j]);
      return kPerspective ? hn::Mul(z, hn::Sub(aside, n[2])) : hn::Sub(aside, hn::Mul(n[2], z));
    }

    template <class Read>
    HWY_INLINE MF counts(const Window& window, int j, int i, const Read& read) const {
      const MF flat = hn::Lt(hn::Abs(hn::Sub(height(j, i, read(window.depth[j])), own)), limit);
      const VF cosine = dot({n[0], n[1], n[2]}, {read(window.normal[0][j]), read(window.normal[1][j]), read(window.normal[2][j])});
      return hn::And(flat, hn::Gt(cosine, hn::Set(DF(), kNormalCosine)));
    }
  };
};

}  // namespace HWY_NAMESPACE
}  // namespace obscura::post
HWY_AFTER_NAMESPACE();
#endif
