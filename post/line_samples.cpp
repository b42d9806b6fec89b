#include "obscura/post/line_samples.h"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "obscura/post/line_samples.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "obscura/post/depth_map-inl.h"
#include "obscura/post/ray_hits-inl.h"
#include "obscura/post/ray_points-inl.h"
#include "obscura/post/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::post {
namespace HWY_NAMESPACE {

// A vector of rays of line_samples.h, in its symbols.
struct Line {
  VF A, B, c, g, h;

  // The integral from nowhere to t, but for D.
  HWY_INLINE VF upTo(VF t) const {
    const VF q = hn::Add(hn::Mul(hn::Add(hn::Mul(c, t), hn::Add(g, g)), t), h);
    const VF along = hn::Mul(A, hn::Add(hn::Mul(c, t), g)), across = hn::Mul(B, hn::Add(hn::Mul(g, t), h));
    return hn::Div(hn::Sub(along, across), hn::Sqrt(q));
  }
};

// What the rays of a pixel add up to.
struct LineSums {
  VF total, inner, read[3];
};

HWY_INLINE VF larger(VF a, VF b) { return hn::IfThenElse(hn::Gt(a, b), a, b); }   // b where a is NaN
HWY_INLINE VF smaller(VF a, VF b) { return hn::IfThenElse(hn::Lt(a, b), a, b); }  // alike

template <bool kPerspective, bool kReads>
class LineKernel {
 public:
  LineKernel(const TransferInput& in, TransferSums& out)
      : in_(in), g_(*in.g), read_(occluderPlanes(in)), out_(out), map_(in), points_(in, 1), inverseRadius_(hn::Set(DF(), 1 / in.settings.radius)) {}

  TransferStatistics rows(int y0, int y1) {
    for (int y = y0; y < y1; ++y) {
      const Projector& p = in_.projector;
      points_.startRow(y + p.yFirst);
      yRay_ = hn::Set(DF(), (float(y + p.yFirst) + 0.5f - p.yCenter) * p.yInverse);
      for (int x = 0; x < g_.width; x += int(hn::Lanes(DF()))) pixels(x, y);
    }
    return statistics_;
  }

 private:
  HWY_INLINE void pixels(int x, int y) {
    const DF d;
    const VF all = hn::Set(d, float(in_.settings.samples)), one = hn::Set(d, 1.0f);
    const VF infinity = hn::Set(d, std::numeric_limits<float>::infinity());
    const MF inside = hn::RebindMask(d, hn::Lt(hn::Iota(DI(), x), hn::Set(DI(), g_.width)));
    const VF z = hn::LoadU(d, g_.depth.row(y) + x);
    const bool asked = !in_.asked || in_.asked->at(x / kSegment, y);
    const MF seen = hn::And(hn::Lt(asked ? z : infinity, infinity), inside);
    const uint64_t seenCount = hn::CountTrue(d, seen);
    statistics_.sampled += seenCount;
    (asked ? statistics_.empty : statistics_.unasked) += hn::CountTrue(d, inside) - seenCount;

    LineSums s{hn::Zero(d), hn::Zero(d), {hn::Zero(d), hn::Zero(d), hn::Zero(d)}};
    if (seenCount != 0) s = sumLines(x, y, hn::IfThenElse(seen, z, one));
    MF sound = hn::And(seen, hn::And(hn::Gt(s.total, hn::Zero(d)), hn::Le(s.inner, s.total)));
    sound = hn::And(sound, hn::Lt(s.total, infinity));
    const VF total = hn::IfThenElse(sound, s.total, one);
    const auto rest = [&](VF from, VF part) HWY_ATTR {
      return hn::IfThenElse(sound, hn::Sub(from, hn::Mul(all, hn::Div(part, total))), from);
    };
    const VF numerator = rest(all, s.inner), start = in_.settings.albedo == TransferAlbedo::Radiance ? hn::Zero(d) : all;
    hn::StoreU(numerator, d, out_.numerator.row(y) + x);
    for (int c = 0; kReads && c < 3; ++c) hn::StoreU(rest(start, s.read[c]), d, out_.denominator[c].row(y) + x);
    uint8_t& open = out_.open.at(x / kSegment, y);
    const uint8_t before = x % kSegment == 0 ? 1 : open;
    open = before & uint8_t(hn::AllTrue(d, hn::Or(hn::Eq(numerator, all), hn::Not(inside))));
  }

  HWY_INLINE LineSums sumLines(int x, int y, VF z) const {
    const DF d;
    const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    const Projector& p = in_.projector;
    VF px = hn::Add(hn::ConvertTo(d, hn::Iota(DI(), x + p.xFirst)), hn::Set(d, 0.5f)), py = yRay_;
    px = hn::Mul(hn::Sub(px, hn::Set(d, p.xCenter)), hn::Set(d, p.xInverse));
    if (kPerspective) px = hn::Mul(px, z), py = hn::Mul(py, z);
    const V3 position{px, py, z};
    const V3 n{hn::LoadU(d, g_.normal[0].row(y) + x), hn::LoadU(d, g_.normal[1].row(y) + x),
               hn::Neg(hn::LoadU(d, g_.normal[2].row(y) + x))};
    V3 e{zero, zero, one};  // the view axis through x
    if (kPerspective) {
      const VF inverse = hn::Div(one, hn::Sqrt(dot(position, position)));
      e = {hn::Mul(px, inverse), hn::Mul(py, inverse), hn::Mul(z, inverse)};
    }
    // Two axes across it (Frisvad 2012); e.z > 0.
    const VF k = hn::Div(one, hn::Add(one, e.z)), mixed = hn::Neg(hn::Mul(hn::Mul(e.x, e.y), k));
    const V3 b1{hn::Sub(one, hn::Mul(hn::Mul(e.x, e.x), k)), mixed, hn::Neg(e.x)};
    const V3 b2{mixed, hn::Sub(one, hn::Mul(hn::Mul(e.y, e.y), k)), hn::Neg(e.y)};
    const VF n1 = dot(n, b1), n2 = dot(n, b2);

    LineSums s{zero, zero, {zero, zero, zero}};
    for (size_t i = 0; i < size_t(in_.settings.samples); ++i) addLine(points_.at(i, x), position, n, b1, b2, n1, n2, s);
    return s;
  }

  HWY_INLINE void addLine(const V3& offset, const V3& position, const V3& n, const V3& b1, const V3& b2, VF n1, VF n2,
                          LineSums& s) const {
    const DF d;
    const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f), radius = hn::Set(d, in_.settings.radius);
    const auto shifted = [&](VF p, VF b, VF c) HWY_ATTR {
      return hn::Add(p, hn::Mul(radius, hn::Add(hn::Mul(offset.x, b), hn::Mul(offset.y, c))));
    };
    const V3 start{shifted(position.x, b1.x, b2.x), shifted(position.y, b1.y, b2.y), shifted(position.z, b1.z, b2.z)};
    Line line;
    line.A = hn::Add(hn::Mul(n1, offset.x), hn::Mul(n2, offset.y));
    line.h = hn::Add(hn::Mul(offset.x, offset.x), hn::Mul(offset.y, offset.y));
    VF u = start.x, v = start.y, weight = offset.z;
    if (kPerspective) {
      const VF inverse = hn::Div(one, start.z);
      u = hn::Mul(u, inverse), v = hn::Mul(v, inverse);
      line.B = dot(n, {u, v, one});
      line.c = dot({u, v, one}, {u, v, one});
      line.g = hn::Mul(hn::Mul(radius, line.h), inverse);
      weight = hn::Mul(weight, start.z);
    } else {
      line.B = n.z, line.c = one, line.g = zero;
    }

    // Where the ray is in the half ball, and the integral at both ends; on the sphere Q = 1.
    const VF root = hn::Sqrt(hn::Add(hn::Mul(line.g, line.g), hn::Mul(line.c, hn::Sub(one, line.h))));
    const VF inverseC = hn::Div(one, line.c);
    VF low = hn::Mul(hn::Sub(hn::Neg(line.g), root), inverseC), high = hn::Mul(hn::Sub(root, line.g), inverseC);
    const auto onSphere = [&](VF along, VF t) HWY_ATTR {
      return hn::Sub(hn::Mul(line.A, along), hn::Mul(line.B, hn::Add(hn::Mul(line.g, t), line.h)));
    };
    VF atLow = onSphere(hn::Neg(root), low), atHigh = onSphere(root, high);
    const VF turn = hn::Div(hn::Neg(line.A), line.B), atTurn = line.upTo(turn);
    const MF ahead = hn::Lt(line.B, zero);  // the ray goes down to the surface
    const MF endsThere = hn::And(ahead, hn::Lt(turn, high)), beginsThere = hn::AndNot(ahead, hn::Gt(turn, low));
    high = hn::IfThenElse(endsThere, turn, high), atHigh = hn::IfThenElse(endsThere, atTurn, atHigh);
    low = hn::IfThenElse(beginsThere, turn, low), atLow = hn::IfThenElse(beginsThere, atTurn, atLow);
    const VF whole = hn::Mul(hn::Sub(atHigh, atLow), weight);
    const MF counts = hn::And(hn::And(hn::Lt(low, high), hn::Gt(whole, zero)), hn::Gt(start.z, map_.zNear));
    s.total = hn::Add(s.total, hn::IfThenElseZero(counts, whole));

    const VI texel = map_.texelAt(u, v);
    const auto reached = [&](VF depth) HWY_ATTR { return hn::Mul(hn::Sub(depth, start.z), inverseRadius_); };
    VF from = larger(reached(map_.zNear), low), inner = zero;
    MF any = hn::MaskFromVec(zero);
    // What is inside between two depths, and not before `from`, where the part of the layer before it ends.
    const auto addInside = [&](VF first, VF last) HWY_ATTR {
      const VF begin = reached(first), end = reached(last), since = larger(begin, from), to = smaller(end, high);
      const MF hit = hn::And(hn::And(counts, hn::Lt(since, to)), hn::And(hn::Lt(begin, high), hn::Gt(end, low)));
      if (hn::AllFalse(d, hit)) return;
      const VF atSince = hn::IfThenElse(hn::Eq(since, low), atLow, line.upTo(since));
      const MF endsHigh = hn::Eq(to, high);  // nearly always
      const VF atTo = hn::AllTrue(d, endsHigh) ? atHigh : hn::IfThenElse(endsHigh, atHigh, line.upTo(to));
      const VF part = larger(smaller(hn::Mul(hn::Sub(atTo, atSince), weight), whole), zero);
      inner = hn::Add(inner, hn::IfThenElseZero(hit, part));
      from = hn::IfThenElse(hit, to, from);
      any = hn::Or(any, hit);
    };
    const VF stored = hn::GatherIndex(d, map_.depth, texel);
    addInside(hn::Add(stored, map_.bias), hn::Add(stored, map_.deepest));
    if (HWY_UNLIKELY(map_.depth2 != nullptr)) {
      const VF hidden = larger(hn::GatherIndex(d, map_.depth2, texel), stored);
      addInside(hn::Add(hidden, map_.bias), hn::Add(hidden, map_.deepest2));
    }
    if (hn::AllFalse(d, any)) return;
    inner = smaller(inner, whole);
    s.inner = hn::Add(s.inner, hn::IfThenElseZero(any, inner));
    for (int c = 0; kReads && c < 3; ++c) {
      const VF read = hn::Mul(inner, hn::GatherIndex(d, read_[c].data(), texel));
      s.read[c] = hn::Add(s.read[c], hn::IfThenElseZero(any, read));
    }
  }

  const TransferInput& in_;
  const raster::GBuffer& g_;
  const raster::Plane<float>* const read_;  // three, or null
  TransferSums& out_;
  const DepthMap<kPerspective> map_;
  DealtPoints points_;
  const VF inverseRadius_;
  VF yRay_;
  TransferStatistics statistics_;
};

template <bool kPerspective>
TransferStatistics lineRows(const TransferInput& in, int y0, int y1, TransferSums& out) {
  if (in.settings.albedo == TransferAlbedo::Own) return LineKernel<kPerspective, false>(in, out).rows(y0, y1);
  return LineKernel<kPerspective, true>(in, out).rows(y0, y1);
}

TransferStatistics LineSamples(const TransferInput& in, int y0, int y1, TransferSums& out) {
  return in.projector.perspective ? lineRows<true>(in, y0, y1, out) : lineRows<false>(in, y0, y1, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::post
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "obscura/raster/dispatch.h"
#include "obscura/raster/float_environment.h"

namespace obscura::post {

HWY_EXPORT(LineSamples);

TransferStatistics lineSamples(const TransferInput& in, int y0, int y1, TransferSums& out, raster::Target target) {
  const raster::FloatEnvironment environment;
  return OBSCURA_DISPATCH(LineSamples, target)(in, y0, y1, out);
}

}  // namespace obscura::post
#endif
