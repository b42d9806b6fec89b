#include "obscura/post/depth_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "obscura/post/depth_bounds.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <hwy/cache_control.h>

#include "obscura/post/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::post {
namespace HWY_NAMESPACE {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// What is linear over a plane; larger is nearer.
template <bool kPerspective>
HWY_INLINE VF nearness(VF z) {
  return kPerspective ? hn::Div(hn::Set(DF(), 1.0f), z) : hn::Neg(z);
}
template <bool kPerspective>
float nearness(float z) {
  return kPerspective ? 1 / z : -z;
}

struct Slopes {
  float a = 0, b = 0;
};

// From the uppermost and lowest texels that count of the outer columns. Any slope is right, a good one makes the bound
// tight.
template <bool kPerspective>
Slopes slopesOf(const raster::GBuffer& g, int x0, int x1, int y0, int y1) {
  struct Side {
    int top, bottom;
    float wTop, wBottom;
  };
  const auto counts = [](float z) { return z > 0 && z < kInfinity; };
  const auto sideOf = [&](int x) {
    Side s{y0, y1, 0, 0};
    while (s.top <= s.bottom && !counts(g.depth.at(x, s.top))) ++s.top;
    while (s.top < s.bottom && !counts(g.depth.at(x, s.bottom))) --s.bottom;
    if (s.top > s.bottom) return s;
    s.wTop = nearness<kPerspective>(g.depth.at(x, s.top));
    s.wBottom = nearness<kPerspective>(g.depth.at(x, s.bottom));
    return s;
  };
  const Side left = sideOf(x0), right = sideOf(x1);
  if (left.top > left.bottom || right.top > right.bottom) return {};
  Slopes s;
  const int height = left.bottom - left.top + right.bottom - right.top;
  if (height > 0) s.b = ((left.wBottom - left.wTop) + (right.wBottom - right.wTop)) / float(height);
  if (x1 > x0) s.a = ((right.wBottom - left.wBottom) - s.b * float(right.bottom - left.bottom)) / float(x1 - x0);
  return std::fabs(s.a) < 1e30f && std::fabs(s.b) < 1e30f ? s : Slopes{};
}

template <bool kPerspective>
void boundCell(const raster::GBuffer& g, int column, int row, DepthBounds& out) {
  const DF d;
  const DI di;
  const int x0 = column * DepthBounds::kCellWidth, y0 = row * DepthBounds::kCellHeight;
  const int x1 = std::min(x0 + DepthBounds::kCellWidth, g.width) - 1;
  const int y1 = std::min(y0 + DepthBounds::kCellHeight, g.height) - 1;
  constexpr int kAhead = 6 * DepthBounds::kCellWidth;  // rows are too far apart for the hardware to fetch ahead
  const Slopes s = slopesOf<kPerspective>(g, x0, x1, y0, y1);
  const VF a = hn::Set(d, s.a), infinity = hn::Set(d, kInfinity), none = hn::Set(d, -kInfinity);
  VF highest = none, nearest = infinity;
  for (int y = y0; y <= y1; ++y) {
    hwy::Prefetch(g.depth.row(y) + x0 + kAhead);
    const VF bv = hn::Set(d, s.b * (float(y) + 0.5f));
    for (int x = x0; x <= x1; x += int(hn::Lanes(d))) {
      const VI column_ = hn::Iota(di, x);
      const MF inImage = hn::RebindMask(d, hn::Lt(column_, hn::Set(di, x1 + 1)));
      const VF z = hn::IfThenElse(inImage, hn::LoadU(d, g.depth.row(y) + x), infinity);
      const MF counts = hn::Lt(z, infinity), sound = hn::Gt(z, hn::Zero(d));
      const VF u = hn::Add(hn::ConvertTo(d, column_), hn::Set(d, 0.5f));
      VF above = hn::Sub(nearness<kPerspective>(z), hn::Add(hn::Mul(a, u), bv));
      above = hn::IfThenElse(hn::And(sound, hn::Lt(above, infinity)), above, infinity);
      highest = hn::Max(highest, hn::IfThenElse(counts, above, none));
      nearest = hn::Min(nearest, hn::IfThenElse(counts, z, infinity));
    }
  }
  const float c = hn::GetLane(hn::MaxOfLanes(d, highest));
  // Three roundings, each of at most 2^-24 of what was rounded.
  const float size = std::fabs(s.a) * float(g.width) + std::fabs(s.b) * float(g.height);
  const float slack = c < kInfinity && c > -kInfinity ? (size + std::fabs(c)) * 0x1p-20f : 0;
  out.a.at(column, row) = s.a;
  out.b.at(column, row) = s.b;
  out.c.at(column, row) = c + slack;
  out.nearest.at(column, row) = hn::GetLane(hn::MinOfLanes(d, nearest));
}

void BoundDepth(const raster::GBuffer& g, const Projector& projector, int row0, int row1, DepthBounds& out) {
  for (int row = row0; row < row1; ++row)
    for (int column = 0; column < out.c.width(); ++column)
      projector.perspective ? boundCell<true>(g, column, row, out) : boundCell<false>(g, column, row, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::post
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "obscura/raster/dispatch.h"
#include "obscura/raster/float_environment.h"

namespace obscura::post {

HWY_EXPORT(BoundDepth);

void boundDepth(const raster::GBuffer& g, const Projector& projector, int row0, int row1, DepthBounds& out,
                raster::Target target) {
  const raster::FloatEnvironment environment;
  OBSCURA_DISPATCH(BoundDepth, target)(g, projector, row0, row1, out);
}

DepthBounds makeDepthBounds(int width, int height, DepthBounds used) {
  const int columns = (width + DepthBounds::kCellWidth - 1) / DepthBounds::kCellWidth;
  const int rows = (height + DepthBounds::kCellHeight - 1) / DepthBounds::kCellHeight;
  for (raster::Plane<float>* plane : {&used.a, &used.b, &used.c, &used.nearest}) plane->resize(columns, rows);
  return used;
}

}  // namespace obscura::post
#endif
