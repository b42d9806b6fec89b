// Per target: which pixels have only rays that stay outside, as the bounds of the depth around them show.
//
// Let 1/z* <= a u + b v + c hold for the texels in reach of a block of pixels (DepthBounds). A test point p is seen at
// (u, v), and read is a texel whose centre lies at most `off` pixels away, so that 1/z* <= a u + b v + c', with
// c' = c + |a| off_u + |b| off_v. As u = x xScale / z + xCenter, and v likewise, this is l(p) / z with the linear form
//   l(p) = g . p,   g = (a xScale, b yScale, a xCenter + b yCenter + c').
// Where l(p) <= 1: z <= z*, p is outside. Else z - z* <= z (1 - 1/l) <= z (l - 1): p is outside if that is <= bias.
// With p = x + X T' + Y B' + Z N and r = |(X, Y)|:  l(p) <= l(x) + r |g x N| + Z g . N, whatever the rotation; g points
// into the plane, so that g . N < 0 and rays that rise from it lower l. For X T' + Y B' = r e, e a unit vector across N,
// and of g only the part across N, of length |g x N|, meets it: the frame itself need not be known.
// Orthographic: -z* <= a u + b v + c, hence z - z* <= l(p) = g . p + k, g = (a xScale, b yScale, 1),
// k = a xCenter + b yCenter + c', which must not exceed the bias.
// The upper bound of the containment test plays no part: z - z* <= bias is outside with it and without.
#if defined(OBSCURA_POST_OPEN_BLOCK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef OBSCURA_POST_OPEN_BLOCK_INL_H_
#undef OBSCURA_POST_OPEN_BLOCK_INL_H_
#else
#define OBSCURA_POST_OPEN_BLOCK_INL_H_
#endif

#include <algorithm>
#include <cmath>
#include <limits>

#include "obscura/post/ambient_transfer.h"
#include "obscura/post/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::post {
namespace HWY_NAMESPACE {

// Bounds on the test points of a pixel whose frame is right but for a thousandth, scene units.
struct Reach {
  float across = 0;                                      // >= |X T' + Y B'|
  float least = std::numeric_limits<float>::infinity();  // <= Z
  float length = 0;                                      // >= |p - x|

  explicit Reach(const std::vector<glm::vec3>& points) {
    constexpr float kWrong = 1.004f;
    for (const glm::vec3& p : points) {
      const float square = p.x * p.x + p.y * p.y;
      across = std::max(across, std::sqrt(square) * kWrong);
      least = std::min(least, p.z);
      length = std::max(length, std::sqrt(square + p.z * p.z) * kWrong);
    }
  }
};

// The linear form of a block.
struct OpenBlock {
  bool known = false;  // false: nothing can be said
  float gx = 0, gy = 0, gz = 0, k = 0;
};

// max(w - a u - b v) over the texels of the cells column0 ... column1 of rows row0 ... row1; infinity as soon as it is
// known to exceed `most`.
inline double highestOver(const DepthBounds& bounds, float a, float b, int column0, int column1, int row0, int row1,
                          float size, float most) {
  const DF d;
  const DI di;
  constexpr float kWidth = DepthBounds::kCellWidth, kHeight = DepthBounds::kCellHeight;
  const VF none = hn::Set(d, -std::numeric_limits<float>::infinity());
  const int lanes = int(hn::Lanes(d)), start = column0 / lanes * lanes;  // where a whole vector can be loaded
  VF highest = none;
  for (int row = row0; row <= row1; ++row) {
    const VF top = hn::Set(d, float(row) * kHeight + 0.5f), bottom = hn::Add(top, hn::Set(d, kHeight - 1));
    for (int column = start; column <= column1; column += lanes) {
      const VI index = hn::Iota(di, column);
      const MF inside = hn::RebindMask(d, hn::And(hn::Gt(index, hn::Set(di, column0 - 1)),
                                                  hn::Lt(index, hn::Set(di, column1 + 1))));
      const VF left = hn::Add(hn::Mul(hn::ConvertTo(d, index), hn::Set(d, kWidth)), hn::Set(d, 0.5f));
      const VF right = hn::Add(left, hn::Set(d, kWidth - 1));
      const VF da = hn::Sub(hn::LoadU(d, bounds.a.row(row) + column), hn::Set(d, a));
      const VF db = hn::Sub(hn::LoadU(d, bounds.b.row(row) + column), hn::Set(d, b));
      const VF c = hn::LoadU(d, bounds.c.row(row) + column);
      VF w = hn::Add(c, hn::Add(hn::Max(hn::Mul(da, left), hn::Mul(da, right)),
                                hn::Max(hn::Mul(db, top), hn::Mul(db, bottom))));
      const VF rounding = hn::Mul(hn::Add(hn::Abs(da), hn::Abs(db)), hn::Set(d, size * 0x1p-20f));
      w = hn::Add(w, rounding);
      highest = hn::Max(highest, hn::IfThenElse(inside, w, none));
    }
    if (!hn::AllFalse(d, hn::Gt(highest, hn::Set(d, most)))) return std::numeric_limits<double>::infinity();
  }
  return hn::GetLane(hn::MaxOfLanes(d, highest));
}

// The texels that points within reach of a block of pixels may be seen in, counted from the G-buffer's first.
struct Reached {
  struct Range {
    double low, high;  // of the points' pixel coordinates: |u_p - u| = |xScale dx - (u - xCenter) dz| / z_p
    int first, last;   // of the texels read
    bool sound;
  };
  bool known = false;
  double xCenter = 0, yCenter = 0;  // counted alike
  Range u, v;
  int column0 = 0, column1 = 0, row0 = 0, row1 = 0;  // of cells
};

template <bool kPerspective>
Reached reachedFrom(const TransferInput& in, const Reach& reach, int column, int row) {
  constexpr int kMostCells = 4096;         // beyond, looking costs as much as sampling
  constexpr double kFarthest = 32768;      // pixels; up to here 1/64 is enough
  const DepthBounds& bounds = *in.bounds;
  const Projector& p = in.projector;
  Reached out;
  out.xCenter = double(p.xCenter) - p.xFirst, out.yCenter = double(p.yCenter) - p.yFirst;
  const float nearest = bounds.nearest.at(column, row);
  if (!(bounds.c.at(column, row) < std::numeric_limits<float>::infinity()) ||
      !(nearest < std::numeric_limits<float>::infinity()))
    return out;
  const double room = kPerspective ? double(nearest) - reach.length : 1;
  if (!(room > 0)) return out;

  const auto rangeOf = [&](int begin, int end, int size, double scale, double center) {
    const double u0 = begin + 0.5, u1 = std::min(end, size) - 0.5;
    const double aside = kPerspective ? std::max(std::fabs(u0 - center), std::fabs(u1 - center)) : 0;
    const double by = reach.length * std::sqrt(scale * scale + aside * aside) / room + 1;
    Reached::Range r{u0 - by, u1 + by, 0, size - 1, by < kFarthest};
    if (r.low > 0) r.first = int(std::min(r.low, size - 1.0));
    if (r.high < size) r.last = int(std::max(r.high, 0.0));
    return r;
  };
  const int x0 = column * DepthBounds::kCellWidth, y0 = row * DepthBounds::kCellHeight;
  out.u = rangeOf(x0, x0 + DepthBounds::kCellWidth, p.width, p.xScale, out.xCenter);
  out.v = rangeOf(y0, y0 + DepthBounds::kCellHeight, p.height, p.yScale, out.yCenter);
  if (!out.u.sound || !out.v.sound) return out;
  out.column0 = out.u.first / DepthBounds::kCellWidth, out.column1 = out.u.last / DepthBounds::kCellWidth;
  out.row0 = out.v.first / DepthBounds::kCellHeight, out.row1 = out.v.last / DepthBounds::kCellHeight;
  out.known = (out.column1 - out.column0 + 1) * (out.row1 - out.row0 + 1) <= kMostCells;
  return out;
}

template <bool kPerspective>
OpenBlock openBlock(const TransferInput& in, const Reach& reach, int column, int row) {
  constexpr double kOff = 0.5 + 1.0 / 64;  // from a point's pixel coordinates to its texel's centre, with roundings
  const DepthBounds& bounds = *in.bounds;
  const Projector& p = in.projector;
  const Reached at = reachedFrom<kPerspective>(in, reach, column, row);
  if (!at.known) return {};
  const float nearest = bounds.nearest.at(column, row);

  // Beyond the border the texel read may be further off, on the inner side.
  const auto off = [&](double slope, const Reached::Range& r, int size) {
    return std::fabs(slope) * (kOff + std::max(0.0, slope > 0 ? -r.low : r.high - size));
  };
  const float a = bounds.a.at(column, row), b = bounds.b.at(column, row), own = bounds.c.at(column, row);
  // What rises more than this over the block's own plane leaves nothing to prove for most of its pixels, even if all
  // their rays rise twice as much as the least one does straight away from the plane.
  const double gx = a * p.xScale, gy = b * p.yScale, gz = kPerspective ? a * p.xCenter + b * p.yCenter + own : 1;
  const double lift = reach.least * std::sqrt(gx * gx + gy * gy + gz * gz);
  const double most = own + 2 * (kPerspective ? (lift + in.settings.bias / nearest) / nearest : lift + in.settings.bias);
  const double c = highestOver(bounds, a, b, at.column0, at.column1, at.row0, at.row1, float(p.width + p.height), float(most)) +
                   off(a, at.u, p.width) + off(b, at.v, p.height);
  if (!(c < std::numeric_limits<double>::infinity())) return {};
  const double atCenter = double(a) * at.xCenter + double(b) * at.yCenter + c;
  OpenBlock block{true, a * p.xScale, b * p.yScale, 1, float(atCenter)};
  if (kPerspective) block.gz = block.k, block.k = 0;
  return block;
}

// Lanes whose frame is right but for a thousandth: N must be nearly unit, and N x (0, 1, 0.01) not shorter than 1/1000: it
// errs by 2e-7 at most, T by 2e-4 of its length.
HWY_INLINE MF hasRightFrame(const V3& n) {
  const DF d;
  const VF square = dot(n, n), tx = hn::Sub(hn::Mul(n.y, hn::Set(d, 0.01f)), n.z);
  const MF unit = hn::And(hn::Le(square, hn::Set(d, 1.001f)), hn::Ge(square, hn::Set(d, 0.999f)));
  return hn::And(unit, hn::Ge(hn::Add(hn::Mul(tx, tx), hn::Mul(n.x, n.x)), hn::Set(d, 1e-6f)));
}

// Lanes whose rays all stay outside.
template <bool kPerspective>
HWY_INLINE MF knownOpen(const OpenBlock& block, const Reach& reach, const V3& x, const V3& n, float bias) {
  const DF d;
  const V3 g{hn::Set(d, block.gx), hn::Set(d, block.gy), hn::Set(d, block.gz)};
  const VF k = hn::Set(d, block.k), length = hn::Set(d, reach.length);
  const VF farthest = hn::Add(x.z, length);  // z of no test point is larger
  const V3 across = cross(g, n);
  const VF aside = hn::Mul(hn::Set(d, reach.across), hn::Sqrt(dot(across, across)));
  const VF facing = dot(g, n);
  const VF rise =
      hn::Mul(facing, hn::IfThenElse(hn::Lt(facing, hn::Zero(d)), hn::Set(d, reach.least), length));
  // |g|_1 times what bounds the coordinates of test points. Some thirty roundings, each of at most 2^-24 of a part of this;
  // and T is unit by its making, but from being perpendicular to N it may be off by 2^-12, as seen below.
  const V3 size{hn::Add(hn::Abs(x.x), length), hn::Add(hn::Abs(x.y), length), farthest};
  const V3 slopes{hn::Abs(g.x), hn::Abs(g.y), hn::Abs(g.z)};
  const VF rounding = hn::Mul(hn::Add(dot(slopes, size), hn::Abs(k)), hn::Set(d, 0x1p-18f));
  const VF tilted = hn::Mul(hn::Mul(hn::Add(hn::Add(slopes.x, slopes.y), slopes.z), hn::Set(d, reach.across)), hn::Set(d, 0x1p-12f));
  VF l = hn::Add(hn::Add(hn::Add(hn::Add(dot(g, x), k), hn::Add(aside, rise)), tilted), rounding);
  if (kPerspective) l = hn::Mul(hn::Sub(l, hn::Set(d, 1.0f)), farthest);
  return hn::And(hn::Le(l, hn::Set(d, bias)), hasRightFrame(n));
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::post
HWY_AFTER_NAMESPACE();
#endif
