// The methods that look for horizons: Hbao and Gtao of peer_methods.h.
#include "obscura/apps/peer_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "obscura/apps/peer_horizons.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "obscura/apps/peer_rows-inl.h"
#include "obscura/post/ray_points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::apps {
namespace HWY_NAMESPACE {

// The slice of space through the eye and a direction of the image, seen from a pixel.
struct Slice {
  VF c, s;            // the direction
  VF normal, level;   // N's part in the slice, unit: its cosine to V and to the direction across V
  VF length;          // that part's length
};

// A sample's direction in its slice: the cosine to V of it and the square of its distance.
struct Seen {
  VF cosine, square;
};

template <bool kPerspective>
class Horizons {
 public:
  Horizons(const post::TransferInput& in, const PeerSettings& peer)
      : samples_(size_t(in.settings.samples)), steps_(peer.steps), perStep_(1 / float(peer.steps)), radius_(in.settings.radius),
        square_(hn::Set(DF(), in.settings.radius * in.settings.radius)), seen_(in), points_(in, 1) {}

 protected:
  // Of direction i of a pixel in column x.
  HWY_INLINE Slice slice(const Pixel& at, const V3& point) const {
    const DF d;
    const VF one = hn::Set(d, 1.0f), zero = hn::Zero(d);
    Slice q;
    q.c = point.x, q.s = point.y;
    const VF facing = dot(at.n, at.eye);
    VF level = hn::Add(hn::Mul(q.c, at.n.x), hn::Mul(q.s, at.n.y));
    if (kPerspective) {  // orthographic: the direction is across V as it is
      const VF tilt = hn::Add(hn::Mul(q.c, at.eye.x), hn::Mul(q.s, at.eye.y));
      level = hn::Div(hn::Sub(level, hn::Mul(tilt, facing)), hn::Sqrt(hn::Sub(one, hn::Mul(tilt, tilt))));
    }
    q.length = hn::Sqrt(hn::Add(hn::Mul(facing, facing), hn::Mul(level, level)));
    const MF some = hn::Gt(q.length, zero);
    const VF length = hn::IfThenElse(some, q.length, one);
    q.normal = hn::IfThenElse(some, hn::Div(facing, length), one);
    q.level = hn::IfThenElseZero(some, hn::Div(level, length));
    return q;
  }

  // What is seen a part `far` of R from the pixel; low: cosine to V of the tangent plane on this side.
  HWY_INLINE Seen look(const Pixel& at, const Slice& q, VF c, VF s, VF low, VF far) const {
    const DF d;
    const VF zero = hn::Zero(d);
    const VF r = hn::Mul(hn::Set(d, radius_), far);
    VF u = hn::Add(at.position.x, hn::Mul(c, r)), v = hn::Add(at.position.y, hn::Mul(s, r));
    if (kPerspective) {
      const VF inverse = hn::Div(hn::Set(d, 1.0f), at.position.z);
      u = hn::Mul(u, inverse), v = hn::Mul(v, inverse);
    }
    const V3 to = minus(seen_.at(u, v), at.position);
    Seen out;
    out.square = dot(to, to);
    // Turned into the slice: as high over the tangent plane, as far away.
    const VF height = hn::Div(dot(to, at.n), q.length), rest = hn::Sub(out.square, hn::Mul(height, height));
    const VF along = hn::Sqrt(hn::IfThenElse(hn::Gt(rest, zero), rest, zero));
    out.cosine = hn::Div(hn::Add(hn::Mul(along, low), hn::Mul(height, q.normal)), hn::Sqrt(out.square));
    return out;
  }

  // Where step j lies.
  HWY_INLINE VF partOfR(int j, VF shift) const {
    const VF even = hn::Mul(hn::Add(hn::Set(DF(), float(j)), shift), hn::Set(DF(), perStep_));
    return hn::Mul(even, even);
  }

  size_t samples_;
  int steps_;
  float perStep_, radius_;
  VF square_;
  SeenPoints<kPerspective> seen_;
  post::HWY_NAMESPACE::DealtPoints points_;
};

template <bool kPerspective, bool kLinear>
class HbaoMethod : Horizons<kPerspective> {
  using Base = Horizons<kPerspective>;

 public:
  HbaoMethod(const post::TransferInput& in, const PeerSettings& peer) : Base(in, peer) {}
  void startRow(int yImage) { this->points_.startRow(yImage); }

  HWY_INLINE VF open(const Pixel& at, int x) const {
    const DF d;
    const VF one = hn::Set(d, 1.0f);
    VF blocked = hn::Zero(d);
    for (size_t i = 0; i < this->samples_; ++i) {
      const V3 point = this->points_.at(i, x);
      const Slice q = this->slice(at, point);
      const VF low = hn::Neg(q.level);
      VF highest = low;
      for (int j = 0; j < this->steps_; ++j) {
        const Seen seen = this->look(at, q, q.c, q.s, low, this->partOfR(j, point.z));
        const VF part = hn::Div(seen.square, this->square_);
        const VF weight = hn::Sub(one, kLinear ? hn::Sqrt(part) : part);
        const MF rises = hn::And(hn::Gt(seen.cosine, highest), hn::Lt(seen.square, this->square_));
        blocked = hn::IfThenElse(rises, hn::Add(blocked, hn::Mul(weight, hn::Sub(seen.cosine, highest))), blocked);
        highest = hn::IfThenElse(rises, seen.cosine, highest);
      }
    }
    return hn::Sub(hn::Set(d, float(this->samples_)), blocked);
  }
};
template <bool kPerspective>
using HbaoOwn = HbaoMethod<kPerspective, false>;
template <bool kPerspective>
using HbaoLinear = HbaoMethod<kPerspective, true>;

// acos c - c sqrt(1 - c^2), -1 <= c <= 1: (1 - c)^(3/2) times a polynomial, fitted to the least maximum of the error (5.4e-6);
// the rest by its symmetry, pi at -c.
HWY_INLINE VF arcWithChord(VF c) {
  const DF d;
  const VF x = hn::Sub(hn::Set(d, 1.0f), hn::Abs(c));
  VF q = hn::Add(hn::Mul(hn::Set(d, -0.0112203658f), x), hn::Set(d, -0.0182239134f));
  q = hn::Add(hn::Mul(q, x), hn::Set(d, -0.285760701f));
  q = hn::Add(hn::Mul(q, x), hn::Set(d, 1.88600671f));
  const VF of = hn::Mul(hn::Mul(x, hn::Sqrt(x)), q);
  return hn::IfThenElse(hn::Lt(c, hn::Zero(d)), hn::Sub(hn::Set(d, 3.14159274f), of), of);
}

template <bool kPerspective>
class GtaoMethod : Horizons<kPerspective> {
  using Base = Horizons<kPerspective>;

 public:
  GtaoMethod(const post::TransferInput& in, const PeerSettings& peer) : Base(in, peer) {
    const float from = peer.aim == PeerAim::Own ? kGtaoFalloff : kGtaoFalloffToO;
    end_ = 1 / (1 - from);
    slope_ = end_ / in.settings.radius;
  }
  void startRow(int yImage) { this->points_.startRow(yImage); }

  HWY_INLINE VF open(const Pixel& at, int x) const {
    const DF d;
    const VF two = hn::Set(d, 2.0f), half = hn::Set(d, 0.5f);
    VF sum = hn::Zero(d);
    for (size_t i = 0; i < this->samples_; ++i) {
      const V3 point = this->points_.at(i, x);
      const Slice q = this->slice(at, point);
      const VF up = horizon(at, q, q.c, q.s, hn::Neg(q.level), point.z), down = horizon(at, q, hn::Neg(q.c), hn::Neg(q.s), q.level, point.z);
      // With n = N's part in the slice and h the horizons' angles to V, |n| 1/4 (2 cos g - cos(2 h1 - g) - cos(2 h2 - g)
      // + 2 (h1 + h2) sin g): paper, equation 7.
      const VF cosines = hn::Sub(two, hn::Add(hn::Mul(up, up), hn::Mul(down, down)));
      const VF arcs = hn::Sub(arcWithChord(up), arcWithChord(down));
      const VF part = hn::Add(hn::Mul(q.normal, cosines), hn::Mul(q.level, arcs));
      sum = hn::Add(sum, hn::Mul(hn::Mul(half, q.length), part));
    }
    return sum;
  }

 private:
  // The largest cosine to V.
  HWY_INLINE VF horizon(const Pixel& at, const Slice& q, VF c, VF s, VF low, VF shift) const {
    const DF d;
    const VF one = hn::Set(d, 1.0f);
    VF highest = low;
    for (int j = 0; j < this->steps_; ++j) {
      const Seen seen = this->look(at, q, c, s, low, this->partOfR(j, shift));
      VF weight = hn::Sub(hn::Set(d, end_), hn::Mul(hn::Sqrt(seen.square), hn::Set(d, slope_)));
      weight = hn::IfThenElse(hn::Lt(weight, one), weight, one);
      const VF sunk = hn::Add(low, hn::Mul(weight, hn::Sub(seen.cosine, low)));
      highest = hn::IfThenElse(hn::And(hn::Gt(sunk, highest), hn::Lt(seen.square, this->square_)), sunk, highest);
    }
    return hn::IfThenElse(hn::Lt(highest, one), highest, one);
  }

  float end_, slope_;  // weight = end - slope d
};

void PeerHorizons(const PeerSettings& peer, const post::TransferInput& in, int y0, int y1, post::TransferSums& out) {
  if (peer.method == PeerMethod::Gtao) peerRows<GtaoMethod>(peer, in, y0, y1, out);
  else if (peer.aim == PeerAim::Own) peerRows<HbaoOwn>(peer, in, y0, y1, out);
  else peerRows<HbaoLinear>(peer, in, y0, y1, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::apps
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "obscura/raster/dispatch.h"
#include "obscura/raster/float_environment.h"

namespace obscura::apps {

HWY_EXPORT(PeerHorizons);

void peerHorizons(const PeerSettings& peer, const post::TransferInput& in, int y0, int y1, post::TransferSums& out, raster::Target target) {
  OBSCURA_DISPATCH(PeerHorizons, target)(peer, in, y0, y1, out);
}

void peerOcclusion(const PeerSettings& peer, const post::TransferInput& in, int y0, int y1, post::TransferSums& out, raster::Target target) {
  const raster::FloatEnvironment environment;
  const bool volumes = peer.method == PeerMethod::Ssao || peer.method == PeerMethod::Vao;
  (volumes ? peerVolumes : peerHorizons)(peer, in, y0, y1, out, target);
}

void clampPeers(int y0, int y1, post::Transfer& out) {
  for (int y = y0; y < y1; ++y) {
    float* row = out.obscurance.row(y);
    for (int x = 0; x < out.obscurance.width(); ++x) {
      const float above = row[x] > 0 ? row[x] : 0;
      row[x] = above < 1 ? above : 1;
    }
  }
}

}  // namespace obscura::apps
#endif
