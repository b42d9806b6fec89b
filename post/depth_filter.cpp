#include "obscura/post/depth_filter.h"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "obscura/post/depth_filter.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "obscura/post/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::post {
namespace HWY_NAMESPACE {

// What the window adds up to: rays that stay outside, denominators, pixels that count.
struct Sums {
  VF numerator, denominator[3], count;
};

// kChannels of the denominator are summed: 3 for the neighbours' W, else 0. kInside: no lane's window leaves the row.
template <int kChannels, bool kInside>
HWY_INLINE Sums sumWindow(const TransferInput& in, const TransferSums& sums, int x, int y) {
  const DF d;
  const DI di;
  const raster::GBuffer& g = *in.g;
  const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f), threshold = hn::Set(d, in.settings.filterThreshold);
  const VF z = hn::LoadU(d, g.depth.row(y) + x);
  Sums s{zero, {zero, zero, zero}, zero};
  for (int j = -2; j <= 1; ++j) {
    const int row = std::clamp(y + j, 0, g.height - 1);
    for (int i = -2; i <= 1; ++i) {
      VI column = hn::Zero(di);
      if (!kInside) column = hn::Min(hn::Max(hn::Iota(di, x + i), hn::Zero(di)), hn::Set(di, g.width - 1));
      auto read = [&](const raster::Plane<float>& p) HWY_ATTR {
        if (kInside) return hn::LoadU(d, p.row(row) + x + i);
        return hn::GatherIndex(d, p.row(row), column);
      };
      MF counts = hn::Lt(hn::Abs(hn::Sub(z, read(g.depth))), threshold);
      if (i == 0 && j == 0) counts = hn::Eq(zero, zero);
      s.count = hn::Add(s.count, hn::IfThenElseZero(counts, one));
      s.numerator = hn::Add(s.numerator, hn::IfThenElseZero(counts, read(sums.numerator)));
      for (int c = 0; c < kChannels; ++c)
        s.denominator[c] = hn::Add(s.denominator[c], hn::IfThenElseZero(counts, read(sums.denominator[c])));
    }
  }
  return s;
}

template <int kChannels>
void filterRow(const TransferInput& in, const TransferSums& sums, int y, Transfer& out) {
  const DF d;
  const raster::GBuffer& g = *in.g;
  const VF one = hn::Set(d, 1.0f), rays = hn::Set(d, float(in.settings.samples));
  const bool w = !out.w[0].empty();
  for (int x = 0; x < g.width; x += int(hn::Lanes(d))) {
    const MF seen = hn::Lt(hn::LoadU(d, g.depth.row(y) + x), hn::Set(d, std::numeric_limits<float>::infinity()));
    if (hn::AllFalse(d, seen)) {
      if (!out.obscurance.empty()) hn::StoreU(one, d, out.obscurance.row(y) + x);
      for (int c = 0; w && c < 3; ++c) hn::StoreU(one, d, out.w[c].row(y) + x);
      continue;
    }
    Sums s;
    if (in.settings.filter) {
      const bool inside = x >= 2 && x + int(hn::Lanes(d)) < g.width;
      s = inside ? sumWindow<kChannels, true>(in, sums, x, y) : sumWindow<kChannels, false>(in, sums, x, y);
    } else {
      s.numerator = hn::LoadU(d, sums.numerator.row(y) + x);
      s.count = one;
      for (int c = 0; c < kChannels; ++c) s.denominator[c] = hn::LoadU(d, sums.denominator[c].row(y) + x);
    }
    const VF total = hn::Mul(rays, s.count);
    if (!out.obscurance.empty())
      hn::StoreU(hn::IfThenElse(seen, hn::Div(s.numerator, total), one), d, out.obscurance.row(y) + x);
    for (int c = 0; w && c < 3; ++c) {
      VF denominator = s.denominator[c];
      if (kChannels == 0) {
        const VF albedo = hn::LoadU(d, g.albedo[c].row(y) + x);
        denominator = hn::Sub(total, hn::Mul(albedo, hn::Sub(total, s.numerator)));
      }
      const MF open = hn::Not(hn::Gt(denominator, s.numerator));
      const VF quotient = hn::Div(s.numerator, hn::IfThenElse(open, one, denominator));
      hn::StoreU(hn::IfThenElse(hn::AndNot(open, seen), quotient, one), d, out.w[c].row(y) + x);
    }
  }
}

void DepthFilter(const TransferInput& in, const TransferSums& sums, int y0, int y1, Transfer& out) {
  const bool neighbour = in.settings.albedo == TransferAlbedo::Neighbour && !out.w[0].empty();
  for (int y = y0; y < y1; ++y) neighbour ? filterRow<3>(in, sums, y, out) : filterRow<0>(in, sums, y, out);
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

Transfer makeTransfer(int width, int height, bool obscurance, bool w, Transfer used) {
  used.obscurance.resize(obscurance ? width : 0, obscurance ? height : 0);
  for (auto& plane : used.w) plane.resize(w ? width : 0, w ? height : 0);
  return used;
}

}  // namespace obscura::post
#endif
