#include "obscura/post/depth_filter.h"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "obscura/post/depth_filter.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <hwy/cache_control.h>

#include "obscura/post/filter_guide-inl.h"
#include "obscura/post/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::post {
namespace HWY_NAMESPACE {

// What the window adds up to: rays that stay outside, denominators, pixels that count.
struct Sums {
  VF numerator, denominator[3], count;
};

// kChannels of the denominator are summed: 0 for the W of the own albedo, else 3. kInside: no lane's window leaves the row.
// The order of the sum is by rows, then columns.
template <class Guide, int kChannels, bool kInside>
HWY_INLINE Sums sumWindow(const Guide& guide, const Window& window, int width, int x) {
  const DF d;
  const DI di;
  const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  Sums s{zero, {zero, zero, zero}, zero};
  VI columns[4];
  for (int i = 0; i < 4; ++i)
    columns[i] = hn::Min(hn::Max(hn::Iota(di, x + i - 2), hn::Zero(di)), hn::Set(di, width - 1));
  const typename Guide::Pixel pixel(guide, window, x, columns);
#if HWY_COMPILER_GCC_ACTUAL  // clang unrolls these by itself
#pragma GCC unroll 4
#endif
  for (int j = 0; j < 4; ++j)
#if HWY_COMPILER_GCC_ACTUAL
#pragma GCC unroll 4
#endif
    for (int i = 0; i < 4; ++i) {
      auto read = [&](const float* row) HWY_ATTR {
        return kInside ? hn::LoadU(d, row + x + i - 2) : hn::GatherIndex(d, row, columns[i]);
      };
      MF counts = pixel.counts(window, j, i, read);
      if (i == 2 && j == 2) counts = hn::Eq(zero, zero);  // the pixel itself
      // Adding nothing and adding 0 are the same here (no sum is ever -0); g++ makes one masked addition of the former.
      auto add = [&](VF& sum, VF v) HWY_ATTR { sum = hn::IfThenElse(counts, hn::Add(sum, v), sum); };
      add(s.count, one);
      add(s.numerator, read(window.numerator[j]));
      // One by one: g++ would keep a loop, and with it the sums in memory (two thirds more time).
      if (kChannels > 0) add(s.denominator[0], read(window.denominator[0][j]));
      if (kChannels > 1) add(s.denominator[1], read(window.denominator[1][j]));
      if (kChannels > 2) add(s.denominator[2], read(window.denominator[2][j]));
    }
  return s;
}

// The row after the next, whose first use would wait: there are too many planes for the hardware to keep ahead of.
template <class Guide, int kChannels>
HWY_INLINE void fetchAhead(const raster::GBuffer& g, const TransferSums& sums, int x, int y) {
  const int row = std::min(y + 3, g.height - 1);
  hwy::Prefetch(g.depth.row(row) + x);
  hwy::Prefetch(sums.numerator.row(row) + x);
  for (int c = 0; Guide::kNormals && c < 3; ++c) hwy::Prefetch(g.normal[c].row(row) + x);
  for (int c = 0; c < kChannels; ++c) hwy::Prefetch(sums.denominator[c].row(row) + x);
}

// kChannels as above; kStored: of radiances.
template <class Guide, int kChannels, bool kStored>
void filterRow(const TransferInput& in, const TransferSums& sums, int y, Transfer& out) {
  const DF d;
  const raster::GBuffer& g = *in.g;
  const VF one = hn::Set(d, 1.0f), rays = hn::Set(d, float(in.settings.samples));
  const Guide guide(in);
  const VF infinity = hn::Set(d, std::numeric_limits<float>::infinity());
  Window window;
  for (int j = 0; j < 4; ++j) {
    const int row = std::clamp(y + j - 2, 0, g.height - 1);
    window.depth[j] = g.depth.row(row);
    window.numerator[j] = sums.numerator.row(row);
    window.open[j] = sums.open.row(row);
    for (int c = 0; c < kChannels; ++c) window.denominator[c][j] = sums.denominator[c].row(row);
    for (int c = 0; Guide::kNormals && c < 3; ++c) window.normal[c][j] = g.normal[c].row(row);
    window.yRay[j] = (float(row + in.projector.yFirst) + 0.5f - in.projector.yCenter) * in.projector.yInverse;
  }
  float* obscurance = out.obscurance.empty() ? nullptr : out.obscurance.row(y);
  float* w[3] = {};  // or the bounced light
  raster::Plane<float>* const planes = kStored ? out.bounced : out.w;
  const VF ofOpen = hn::Set(d, kStored ? 0.0f : 1.0f);
  const float* albedo[3] = {};
  const bool speaksOf = kStored || in.settings.albedo != TransferAlbedo::Radiance;
  for (int c = 0; c < 3 && speaksOf && !planes[0].empty(); ++c) {
    w[c] = planes[c].row(y);
    if (kChannels == 0) albedo[c] = g.albedo[c].row(y);
  }
  bool open = false;
  for (int x = 0; x < g.width; x += int(hn::Lanes(d))) {
    if (x % kSegment == 0) open = window.isOpen(x / kSegment, sums.open.width(), in.settings.filter);
    const MF seen = hn::Lt(hn::LoadU(d, window.depth[2] + x), infinity);
    if (open || hn::AllFalse(d, seen)) {
      if (obscurance) hn::StoreU(one, d, obscurance + x);
      for (int c = 0; w[0] && c < 3; ++c) hn::StoreU(ofOpen, d, w[c] + x);
      continue;
    }
    Sums s;
    if (in.settings.filter) {
      fetchAhead<Guide, kChannels>(g, sums, x, y);
      const bool inside = x >= 2 && x + int(hn::Lanes(d)) < g.width;
      s = inside ? sumWindow<Guide, kChannels, true>(guide, window, g.width, x)
                 : sumWindow<Guide, kChannels, false>(guide, window, g.width, x);
    } else {
      s.numerator = hn::LoadU(d, window.numerator[2] + x);
      s.count = one;
      for (int c = 0; c < kChannels; ++c) s.denominator[c] = hn::LoadU(d, window.denominator[c][2] + x);
    }
    const VF total = hn::Mul(rays, s.count);
    if (obscurance) hn::StoreU(hn::IfThenElse(seen, hn::Div(s.numerator, total), one), d, obscurance + x);
    for (int c = 0; w[0] && c < 3; ++c) {
      VF denominator = s.denominator[c];
      if (kStored) {
        const VF light = hn::Sub(hn::Zero(d), denominator), most = hn::Set(d, std::numeric_limits<float>::max());
        const MF some = hn::And(hn::Gt(light, hn::Zero(d)), seen);
        hn::StoreU(hn::Div(hn::IfThenElseZero(some, hn::Min(light, most)), total), d, w[c] + x);
        continue;
      }
      if (kChannels == 0)
        denominator = hn::Sub(total, hn::Mul(hn::LoadU(d, albedo[c] + x), hn::Sub(total, s.numerator)));
      const MF whole = hn::Not(hn::Gt(denominator, s.numerator));
      const VF quotient = hn::Div(s.numerator, hn::IfThenElse(whole, one, denominator));
      hn::StoreU(hn::IfThenElse(hn::AndNot(whole, seen), quotient, one), d, w[c] + x);
    }
  }
}

template <class Guide, int kChannels, bool kStored>
void filterRows(const TransferInput& in, const TransferSums& sums, int y0, int y1, Transfer& out) {
  for (int y = y0; y < y1; ++y) filterRow<Guide, kChannels, kStored>(in, sums, y, out);
}

template <class Guide>
void filterRows(const TransferInput& in, const TransferSums& sums, int y0, int y1, Transfer& out) {
  const TransferAlbedo albedo = in.settings.albedo;
  if (albedo == TransferAlbedo::Radiance && !out.bounced[0].empty()) return filterRows<Guide, 3, true>(in, sums, y0, y1, out);
  if (albedo == TransferAlbedo::Neighbour && !out.w[0].empty()) return filterRows<Guide, 3, false>(in, sums, y0, y1, out);
  filterRows<Guide, 0, false>(in, sums, y0, y1, out);
}

void DepthFilter(const TransferInput& in, const TransferSums& sums, int y0, int y1, Transfer& out) {
  if (!in.settings.filter || in.settings.filterGuide == FilterGuide::Depth) filterRows<DepthGuide>(in, sums, y0, y1, out);
  else if (in.projector.perspective) filterRows<PlaneGuide<true>>(in, sums, y0, y1, out);
  else filterRows<PlaneGuide<false>>(in, sums, y0, y1, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::post
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "obscura/raster/dispatch.h"
#include "obscura/raster/float_environment.h"

namespace obscura::post {

HWY_EXPORT(DepthFilter);

void depthFilter(const TransferInput& in, const TransferSums& sums, int y0, int y1, Transfer& out, raster::Target target) {
  const raster::FloatEnvironment environment;
  OBSCURA_DISPATCH(DepthFilter, target)(in, sums, y0, y1, out);
}

Transfer makeTransfer(int width, int height, const TransferPlanes& planes, Transfer used) {
  const auto resize = [&](raster::Plane<float>& plane, bool there) { plane.resize(there ? width : 0, there ? height : 0); };
  resize(used.obscurance, planes.obscurance);
  for (auto& plane : used.w) resize(plane, planes.w);
  for (auto& plane : used.bounced) resize(plane, planes.bounced);
  return used;
}

}  // namespace obscura::post
#endif
