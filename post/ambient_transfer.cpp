#include "obscura/post/ambient_transfer.h"

#include <algorithm>
#include <limits>
#include <type_traits>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "obscura/post/ambient_transfer.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <hwy/cache_control.h>

#include "obscura/post/containment-inl.h"
#include "obscura/post/open_tangent-inl.h"
#include "obscura/post/ray_hits-inl.h"
#include "obscura/post/ray_march-inl.h"
#include "obscura/post/ray_points-inl.h"
#include "obscura/post/sample_sets.h"
#include "obscura/post/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::post {
namespace HWY_NAMESPACE {

// T = normalize(N x (0, 1, 0.01)), B = N x T.
HWY_INLINE void setFrame(Pixels& at) {
  const DF d;
  const VF one = hn::Set(d, 1.0f), hundredth = hn::Set(d, 0.01f);
  const V3& n = at.n;
  const V3 t{hn::Sub(hn::Mul(n.y, hundredth), n.z), hn::Neg(hn::Mul(n.x, hundredth)), n.x};
  const VF square = dot(t, t);
  const MF direction = hn::Gt(square, hn::Set(d, 1e-12f));
  const VF length = hn::Sqrt(hn::IfThenElse(direction, square, one));
  at.t = {hn::IfThenElse(direction, hn::Div(t.x, length), one), hn::IfThenElseZero(direction, hn::Div(t.y, length)),
          hn::IfThenElseZero(direction, hn::Div(t.z, length))};
  at.b = cross(n, at.t);
}

// Turns T and B by the pixel's angle.
HWY_INLINE void turnFrame(Pixels& at, VF c, VF s) {
  const V3 t = at.t, b = at.b;
  at.t = {hn::Add(hn::Mul(c, t.x), hn::Mul(s, b.x)), hn::Add(hn::Mul(c, t.y), hn::Mul(s, b.y)),
          hn::Add(hn::Mul(c, t.z), hn::Mul(s, b.z))};
  at.b = {hn::Sub(hn::Mul(s, t.x), hn::Mul(c, b.x)), hn::Sub(hn::Mul(s, t.y), hn::Mul(c, b.y)),
          hn::Sub(hn::Mul(s, t.z), hn::Mul(c, b.z))};
}

// kReads: what the occluders send back is subtracted from the denominators. kMore: there is more than the depth map.
template <class Points, bool kPerspective, bool kOneStep, bool kReads, bool kMore>
class Kernel {
 public:
  Kernel(const TransferInput& in, TransferSums& out)
      : in_(in), g_(*in.g), read_(occluderPlanes(in)), out_(out), map_(in), points_(in, in.settings.steps), reach_(points_.all()),
        implicits_(in, reach_), relief_(in) {}

  TransferStatistics rows(int y0, int y1) {
    if (in_.bounds) blocks_.resize(size_t(in_.bounds->c.width()));
    for (int y = y0; y < y1; ++y) {
      if (in_.bounds && (y == y0 || y % DepthBounds::kCellHeight == 0))
        for (size_t column = 0; column < blocks_.size(); ++column)
          blocks_[column] = blockAt(int(column), y / DepthBounds::kCellHeight);
      startRow(y);
      for (int x = 0; x < g_.width; x += kSegment) segment(x, y);
      subtractPending(y);
    }
    return statistics_;
  }

 private:
  using Block = std::conditional_t<Points::kMarched, TangentBlock, OpenBlock>;

  Block blockAt(int column, int row) const {
    if constexpr (Points::kMarched) return tangentBlock<kPerspective>(in_, reach_, column, row);
    else return openBlock<kPerspective>(in_, reach_, column, row);
  }
  HWY_INLINE MF isOpen(const Block& block, const Pixels& at) const {
    if constexpr (Points::kMarched) return knownOpen<kPerspective>(block, TangentPlane<kPerspective>(in_, at), at.n);
    else return knownOpen<kPerspective>(block, reach_, at.position, at.n, in_.settings.bias);
  }

  // The pattern is that of the whole image.
  void startRow(int y) {
    const Projector& p = in_.projector;
    for (int x = 0; x < kSegment; ++x) {
      const glm::vec2 r = in_.settings.interleave ? rotations()[size_t(((x + p.xFirst) & 3) + 4 * ((y + p.yFirst) & 3))] : glm::vec2(1, 0);
      cosines_[x] = r.x;
      sines_[x] = r.y;
    }
    points_.startRow(y + p.yFirst);
    yRay_ = hn::Set(DF(), (float(y + p.yFirst) + 0.5f - p.yCenter) * p.yInverse);
  }

  HWY_INLINE void segment(int x, int y) {
    const DF d;
    constexpr int kLanes = int(hn::MaxLanes(DF())), kVectors = kSegment / kLanes;
    const bool asked = !in_.asked || in_.asked->at(x / kSegment, y);
    const VF all = hn::Set(d, float(in_.settings.samples));
    const VF start = in_.settings.albedo == TransferAlbedo::Radiance ? hn::Zero(d) : all;
    const VF infinity = hn::Set(d, std::numeric_limits<float>::infinity());
    float* numerator = out_.numerator.row(y) + x;
    MF seen[kVectors];
    uint64_t seenCount = 0;
    for (int v = 0; v < kVectors; ++v) {
      const VI column = hn::Iota(DI(), x + v * kLanes);
      seen[v] = hn::And(hn::Lt(hn::LoadU(d, g_.depth.row(y) + x + v * kLanes), infinity),
                        hn::RebindMask(d, hn::Lt(column, hn::Set(DI(), g_.width))));
      seenCount += hn::CountTrue(d, seen[v]);
      hn::StoreU(all, d, numerator + v * kLanes);
      for (int c = 0; kReads && c < 3; ++c) hn::StoreU(start, d, out_.denominator[c].row(y) + x + v * kLanes);
    }
    const uint64_t count = uint64_t(std::min(kSegment, g_.width - x));
    uint8_t& open = out_.open.at(x / kSegment, y);
    open = 1;
    if (!asked) {
      statistics_.unasked += count;
      return;
    }
    statistics_.empty += count - seenCount;
    if (seenCount == 0) return;

    fetchAhead(x, y);
    Pixels pixels[kVectors];
    for (int v = 0; v < kVectors; ++v) {
      // A ray from infinity meets nothing: z - z* is not finite.
      const VF z = hn::IfThenElse(seen[v], hn::LoadU(d, g_.depth.row(y) + x + v * kLanes), infinity);
      place(pixels[v], x + v * kLanes, y, z);
    }
    bool alone = true;  // with the depth map
    if (kMore) {
      implicits_.choose(pixels, seen, kVectors);
      alone = !implicits_.any();
      for (int v = 0; v < kVectors; ++v) alone = !relief_.choose(x + v * kLanes, y) && alone;
    }
    if (in_.bounds) {
      const Block& block = blocks_[size_t(x / kSegment)];
      bool known = block.known && alone;
      for (int v = 0; v < kVectors && known; ++v) known = hn::AllTrue(d, hn::Or(hn::Not(seen[v]), isOpen(block, pixels[v])));
      if (known) {
        statistics_.open += seenCount;
        return;
      }
    }
    statistics_.sampled += seenCount;
    fetchOccludersAhead(x, y);
    for (int v = 0; v < kVectors; ++v) {
      setFrame(pixels[v]);
      if (Points::kTurned) turnFrame(pixels[v], hn::LoadU(d, cosines_ + v * kLanes), hn::LoadU(d, sines_ + v * kLanes));
      if (kMore) relief_.choose(x + v * kLanes, y);
      VF outer;
      if constexpr (Points::kMarched) outer = marchedRays(pixels[v], x + v * kLanes);
      else outer = outerRays(pixels[v], x + v * kLanes);
      open &= uint8_t(hn::AllTrue(d, hn::Eq(outer, all)));
      hn::StoreU(outer, d, numerator + v * kLanes);
      if (kReads) {
        pending_[pendingCount_++] = x + v * kLanes;
        if (pendingCount_ == pendingMost_) subtractPending(y);
      }
    }
  }

  // The gathers' lines come from far down, and no hardware sees that they advance by a row at a time.
  static constexpr int kRowsAhead = 64;
  HWY_INLINE void fetchOccludersAhead(int x, int y) const {  // where some are likely: below what is not known to be open
    const int row = std::min(y + kRowsAhead, g_.height - 1);
    for (int c = 0; kReads && c < 3; ++c) hwy::Prefetch(read_[c].row(row) + x);
  }
  HWY_INLINE void fetchAhead(int x, int y) const {
    hwy::Prefetch(g_.depth.row(std::min(y + kRowsAhead, g_.height - 1)) + x);
    const int next = std::min(y + 1, g_.height - 1);
    for (int c = 0; c < 3; ++c) hwy::Prefetch(g_.normal[c].row(next) + x);
  }

  HWY_INLINE void place(Pixels& at, int x, int y, VF z) const {
    const DF d;
    VF px = hn::Add(hn::ConvertTo(d, hn::Iota(DI(), x + in_.projector.xFirst)), hn::Set(d, 0.5f)), py = yRay_;
    px = hn::Mul(hn::Sub(px, hn::Set(d, in_.projector.xCenter)), hn::Set(d, in_.projector.xInverse));
    if (kPerspective) px = hn::Mul(px, z), py = hn::Mul(py, z);
    at.position = {px, py, z};
    at.n = {hn::LoadU(d, g_.normal[0].row(y) + x), hn::LoadU(d, g_.normal[1].row(y) + x),
            hn::Neg(hn::LoadU(d, g_.normal[2].row(y) + x))};
  }

  // From the pixel's point.
  HWY_INLINE static V3 offset(const Pixels& at, const V3& xyz) {
    auto shift = [&](VF t, VF b, VF n) HWY_ATTR { return hn::Add(hn::Add(hn::Mul(xyz.x, t), hn::Mul(xyz.y, b)), hn::Mul(xyz.z, n)); };
    return {shift(at.t.x, at.b.x, at.n.x), shift(at.t.y, at.b.y, at.n.y), shift(at.t.z, at.b.z, at.n.z)};
  }
  HWY_INLINE static V3 moved(const Pixels& at, const V3& o) {
    return {hn::Add(at.position.x, o.x), hn::Add(at.position.y, o.y), hn::Add(at.position.z, o.z)};
  }

  // Counts the rays that stay outside; with kReads also notes what the others meet.
  HWY_INLINE VF outerRays(const Pixels& at, int x) {
    const DF d;
    const DI di;
    const VF one = hn::Set(d, 1.0f);
    const size_t samples = size_t(in_.settings.samples), steps = kOneStep ? 1 : size_t(in_.settings.steps);
    const size_t firstRay = size_t(pendingCount_) * samples * Hits::kStride;
    size_t point = 0;
    VF outer = hn::Zero(d);
    for (size_t i = 0; i < samples; ++i) {
      MF hit = hn::MaskFromVec(hn::Zero(d));
      VI met = hn::Zero(di);
      for (size_t k = 0; k < steps; ++k, ++point) {
        const V3 o = offset(at, points_.at(point, x)), p = moved(at, o);
        const VI texel = map_.texelOf(p);
        MF inner = map_.inner(p.z, texel);
        if (kMore) inner = hn::Or(inner, hn::Or(implicits_.inner(p), relief_.inner(o)));
        met = kOneStep ? texel : hn::IfThenElse(hn::RebindMask(di, hn::AndNot(hit, inner)), texel, met);
        hit = kOneStep ? inner : hn::Or(hit, inner);
      }
      outer = hn::IfThenElse(hit, outer, hn::Add(outer, one));
      if (kReads) hits_.set(firstRay + i * Hits::kStride, hit, met);
    }
    return outer;
  }

  // The same for Estimator::March.
  HWY_INLINE VF marchedRays(const Pixels& at, int x) {
    const DF d;
    const DI di;
    const VF one = hn::Set(d, 1.0f), zero = hn::Zero(d), perStep = hn::Set(d, 1 / float(in_.settings.steps));
    const TangentPlane<kPerspective> plane(in_, at);
    const size_t samples = size_t(in_.settings.samples), firstRay = size_t(pendingCount_) * samples * Hits::kStride;
    VF outer = zero;
    for (size_t i = 0; i < samples; ++i) {
      const V3 end = offset(at, points_.at(i, x));
      const VF early = points_.early(i, x), shell = points_.shell(i, x);
      MF hit = hn::MaskFromVec(zero);
      VI met = hn::Zero(di);
      for (int k = 1; k <= in_.settings.steps; ++k) {
        const VF part = hn::Mul(hn::Sub(hn::Set(d, float(k)), early), perStep);
        const V3 o{hn::Mul(end.x, part), hn::Mul(end.y, part), hn::Mul(end.z, part)}, p = moved(at, o);
        const auto place = map_.nearest(p);
        const VI texel = map_.element(place);
        const VF sight = plane.along(hn::ConvertTo(d, place.column), hn::ConvertTo(d, place.row));
        const auto within = [&](const float* depth, VF thickness) HWY_ATTR {
          const VF stored = hn::GatherIndex(d, depth, texel), behind = hn::Sub(p.z, stored);
          return hn::And(hn::And(hn::Gt(behind, zero), hn::Lt(behind, thickness)), plane.above(sight, stored));
        };
        MF inner = within(map_.depth, shell);
        if (HWY_UNLIKELY(map_.depth2 != nullptr)) inner = hn::Or(inner, within(map_.depth2, points_.shell2(i, x)));
        inner = hn::And(inner, hn::Gt(p.z, map_.zNear));
        if (kMore) inner = hn::Or(inner, hn::Or(implicits_.inner(p), relief_.inner(o)));
        if (kReads) met = hn::IfThenElse(hn::RebindMask(di, hn::AndNot(hit, inner)), texel, met);
        hit = hn::Or(hit, inner);
      }
      outer = hn::IfThenElse(hit, outer, hn::Add(outer, one));
      if (kReads) hits_.set(firstRay + i * Hits::kStride, hit, met);
    }
    return outer;
  }

  void subtractPending(int y) {
    const size_t rays = size_t(in_.settings.samples) * Hits::kStride;
    for (int v = 0; v < pendingCount_; ++v) {
      float* denominator[3];
      for (int c = 0; c < 3; ++c) denominator[c] = out_.denominator[c].row(y) + pending_[v];
      hits_.subtract(size_t(v) * rays, rays, read_, denominator);
    }
    pendingCount_ = 0;
  }

  const TransferInput& in_;
  const raster::GBuffer& g_;
  const raster::Plane<float>* const read_;  // three, or null
  TransferSums& out_;
  const DepthMap<kPerspective> map_;
  Points points_;
  const Reach reach_;
  Implicits implicits_;
  HeightField relief_;
  std::vector<Block> blocks_;  // of the row of cells
  TransferStatistics statistics_;
  HWY_ALIGN float cosines_[kSegment], sines_[kSegment];  // the row's rotations
  VF yRay_;
  static constexpr int kPendingMost = 16;
  const int pendingMost_ = std::min(kPendingMost, 2 * kMaxSamples / std::max(in_.settings.samples, 1));
  int pendingCount_ = 0, pending_[kPendingMost];  // vectors whose hits are noted: their x
  Hits hits_;
};

// More than the depth map is rare enough that one step has no kernel of its own then: each takes seconds to compile.
template <class Points, bool kPerspective, bool kOneStep, bool kReads>
TransferStatistics rowsOf(const TransferInput& in, int y0, int y1, TransferSums& out) {
  if (!in.implicits.empty() || (!in.heights.empty() && !in.g->heightMap.empty()))
    return Kernel<Points, kPerspective, false, kReads, true>(in, out).rows(y0, y1);
  return Kernel<Points, kPerspective, kOneStep, kReads, false>(in, out).rows(y0, y1);
}

template <bool kPerspective, bool kOneStep, bool kReads>
TransferStatistics transferRows(const TransferInput& in, int y0, int y1, TransferSums& out) {
  switch (in.settings.estimator) {
    case Estimator::Paper: return rowsOf<SharedPoints, kPerspective, kOneStep, kReads>(in, y0, y1, out);
    case Estimator::March: return rowsOf<MarchedRays, kPerspective, false, kReads>(in, y0, y1, out);
    default: return rowsOf<DealtPoints, kPerspective, kOneStep, kReads>(in, y0, y1, out);
  }
}

template <bool kPerspective, bool kOneStep>
TransferStatistics transferRows(const TransferInput& in, int y0, int y1, TransferSums& out) {
  const bool reads = in.settings.albedo != TransferAlbedo::Own;
  if (reads) return transferRows<kPerspective, kOneStep, true>(in, y0, y1, out);
  return transferRows<kPerspective, kOneStep, false>(in, y0, y1, out);
}

TransferStatistics AmbientTransfer(const TransferInput& in, int y0, int y1, TransferSums& out) {
  const bool oneStep = in.settings.steps == 1;
  if (in.projector.perspective)
    return oneStep ? transferRows<true, true>(in, y0, y1, out) : transferRows<true, false>(in, y0, y1, out);
  return oneStep ? transferRows<false, true>(in, y0, y1, out) : transferRows<false, false>(in, y0, y1, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::post
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <stdexcept>
#include <string>

#include "obscura/post/line_samples.h"
#include "obscura/raster/dispatch.h"
#include "obscura/raster/float_environment.h"

namespace obscura::post {

HWY_EXPORT(AmbientTransfer);

TransferStatistics ambientTransfer(const TransferInput& in, int y0, int y1, TransferSums& out, raster::Target target) {
  if (in.settings.estimator == Estimator::Lines) return lineSamples(in, y0, y1, out, target);
  const raster::FloatEnvironment environment;
  return OBSCURA_DISPATCH(AmbientTransfer, target)(in, y0, y1, out);
}

namespace {

void checkRadiance(const TransferInput& in) {
  if (!in.radiance) throw std::invalid_argument("the transfer of stored radiance has no radiance to read");
  for (const raster::Plane<float>& plane : in.radiance->rgb) {
    if (plane.width() == in.g->width && plane.height() == in.g->height) continue;
    const auto size = [](int w, int h) { return std::to_string(w) + "x" + std::to_string(h); };
    throw std::invalid_argument("a plane of the radiance has " + size(plane.width(), plane.height()) +
                                " pixels, the G-buffer " + size(in.g->width, in.g->height));
  }
}

}  // namespace

TransferSums makeTransferSums(const TransferInput& in, TransferSums used) {
  if (in.settings.albedo == TransferAlbedo::Radiance) checkRadiance(in);
  if (in.settings.layers == 2 && in.g->depth2.empty())
    throw std::invalid_argument("two layers of depth are asked for, but the G-buffer has no depth2");
  const bool denominators = in.settings.albedo != TransferAlbedo::Own;
  used.numerator.resize(in.g->width, in.g->height);
  used.open.resize(segmentsOf(in.g->width), in.g->height);
  for (auto& plane : used.denominator) plane.resize(denominators ? in.g->width : 0, denominators ? in.g->height : 0);
  return used;
}

}  // namespace obscura::post
#endif
