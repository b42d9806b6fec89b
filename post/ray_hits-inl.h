// Per target: what the rays met whose albedos or radiances make the denominators.
#if defined(OBSCURA_POST_RAY_HITS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef OBSCURA_POST_RAY_HITS_INL_H_
#undef OBSCURA_POST_RAY_HITS_INL_H_
#else
#define OBSCURA_POST_RAY_HITS_INL_H_
#endif

#include <cstring>

#include "obscura/post/ambient_transfer.h"
#include "obscura/post/sample_sets.h"
#include "obscura/post/vector-inl.h"
#include "obscura/raster/plane.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::post {
namespace HWY_NAMESPACE {

// What the occluders are read from: their albedos or their radiances; null if nothing is read.
inline const raster::Plane<float>* occluderPlanes(const TransferInput& in) {
  switch (in.settings.albedo) {
    case TransferAlbedo::Own: break;
    case TransferAlbedo::Neighbour: return in.g->albedo;
    case TransferAlbedo::Radiance: return in.radiance->rgb;
  }
  return nullptr;
}

// What the rays of a few vectors of pixels met. Noted here first and subtracted later, so that the tests of one vector
// need not wait for the hits of another.
struct Hits {
  static constexpr size_t kStride = HWY_MAX(hn::MaxLanes(DF()), 8);  // of a sample in a vector: whole bytes
  static constexpr size_t kRays = 2 * kMaxSamples * kStride;
  HWY_ALIGN int32_t element[kRays];       // of the G-buffer, what the ray reads
  HWY_ALIGN uint8_t bits[kRays / 8 + 8];  // whether it meets something there

  HWY_INLINE void set(size_t ray, MF hit, VI what) {
    hn::StoreU(what, DI(), element + ray);
    hn::StoreMaskBits(DF(), hit, bits + ray / 8);
  }

  // For `rays` rays from `first` on: denominator[c][lane] -= planes[c] of what is met, in the order of the samples.
  HWY_INLINE void subtract(size_t first, size_t rays, const raster::Plane<float>* planes, float* const denominator[3]) const {
    const float *red = planes[0].data(), *green = planes[1].data(), *blue = planes[2].data();
    float *r = denominator[0], *gr = denominator[1], *b = denominator[2];
    for (size_t from = first; from < first + rays; from += 64) {
      const size_t bytes = HWY_MIN(size_t(8), (first + rays - from) / 8);
      uint64_t word = 0;
      std::memcpy(&word, bits + from / 8, 8);
      if (bytes < 8) word &= (uint64_t(1) << 8 * bytes) - 1;
      for (; word != 0; word &= word - 1) {
        const size_t ray = from + hwy::Num0BitsBelowLS1Bit_Nonzero64(word), lane = ray % kStride;
        const size_t met = size_t(element[ray]);
        const float newR = r[lane] - red[met], newG = gr[lane] - green[met], newB = b[lane] - blue[met];
        r[lane] = newR, gr[lane] = newG, b[lane] = newB;
      }
    }
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace obscura::post
HWY_AFTER_NAMESPACE();
#endif
