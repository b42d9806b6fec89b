// Per target: I(p), whether a test point is outside. Two ways to decide it, and their product where both apply:
//   depth map          inside exactly when bias < z - z* < R, z* the depth stored where p projects
//   height field       inside where p_z < h(p_x, p_y), p in the space of the height map that displaces the pixel
//   implicit surface   inside where f(p) < 0; what is double-sided has no inside
// (long paper, section 2.) Each has `inner`; a point is inside where either says so.
#if defined(OBSCURA_POST_CONTAINMENT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef OBSCURA_POST_CONTAINMENT_INL_H_
#undef OBSCURA_POST_CONTAINMENT_INL_H_
#else
#define OBSCURA_POST_CONTAINMENT_INL_H_
#endif

#include <vector>

#include "obscura/post/ambient_transfer.h"
#include "obscura/post/depth_map-inl.h"
#include "obscura/post/open_block-inl.h"
#include "obscura/post/vector-inl.h"
#include "obscura/raster/height-inl.h"
#include "obscura/raster/implicit-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::post {
namespace HWY_NAMESPACE {

// Where the pixels of a vector are, and their frame.
struct Pixels {
  V3 position, t, b, n;
};

// The height map of a vector of displaced pixels as the containment test sees it. It knows nothing of other surfaces.
class HeightField {
 public:
  explicit HeightField(const TransferInput& in) : g_(*in.g), heights_(in.heights) {}

  // Whether one of the pixels x ... of row y is displaced; `inner` is then for these.
  HWY_INLINE bool choose(int x, int y) {
    const DI d;
    if (heights_.empty() || g_.heightMap.empty()) return false;
    x_ = x;
    y_ = y;
    any_ = !hn::AllTrue(d, hn::Eq(map(), hn::Set(d, -1)));
    return any_;
  }

  // offset: from the pixel's point to the test point, z away from the eye.
  HWY_INLINE MF inner(const V3& offset) const {
    const DF d;
    return any_ ? below(offset) : hn::Lt(hn::Zero(d), hn::Zero(d));
  }

 private:
  // Not inlined: it would be compiled into every kernel.
  HWY_NOINLINE MF below(const V3& offset) const {
    const DF d;
    MF inside = hn::Lt(hn::Zero(d), hn::Zero(d));
    const auto plane = [&](int k) HWY_ATTR { return hn::LoadU(d, g_.relief[k].row(y_) + x_); };
    const auto moved = [&](int k) HWY_ATTR {
      const VF xy = hn::Add(hn::Mul(offset.x, plane(3 * k + 3)), hn::Mul(offset.y, plane(3 * k + 4)));
      return hn::Add(plane(k), hn::Sub(xy, hn::Mul(offset.z, plane(3 * k + 5))));
    };
    const VF u = moved(0), v = moved(1), height = moved(2);
    for (size_t k = 0; k < heights_.size(); ++k) {
      const MF mine = hn::RebindMask(d, hn::Eq(map(), hn::Set(DI(), int32_t(k))));
      if (hn::AllFalse(d, mine)) continue;
      inside = hn::Or(inside, hn::And(mine, hn::Lt(height, raster::HWY_NAMESPACE::heightAt(heights_[k], u, v))));
    }
    return inside;
  }

  HWY_INLINE VI map() const { return hn::LoadU(DI(), reinterpret_cast<const int32_t*>(g_.heightMap.row(y_) + x_)); }

  const raster::GBuffer& g_;
  raster::Span<const raster::HeightView> heights_;
  bool any_ = false;
  int x_ = 0, y_ = 0;
};

// Implicit surfaces as the containment test sees them: f in float, at p in their object space.
class Implicits {
 public:
  Implicits(const TransferInput& in, const Reach& reach) : surfaces_(in.implicits), reach_(reach), all_(!in.bounds) {
    for (const raster::ImplicitDraw& s : surfaces_)
      if (!s.doubleSided) near_.push_back(&s);
  }

  // Keeps those that a test point of the pixels may lie in: the points lie within reach of their pixel, and beyond the
  // bound's sphere, which has room for all roundings, f is positive. Frames that are not right may reach anywhere.
  HWY_INLINE void choose(const Pixels* pixels, const MF* seen, int vectors) {
    const DF d;
    if (all_) return;
    near_.clear();
    MF right = hn::Eq(hn::Zero(d), hn::Zero(d));
    for (int v = 0; v < vectors; ++v)
      right = hn::And(right, hn::Or(hn::Not(seen[v]), hasRightFrame(pixels[v].n)));
    const bool anywhere = !hn::AllTrue(d, right);
    for (const raster::ImplicitDraw& s : surfaces_) {
      if (s.doubleSided) continue;
      const float most = (s.sphere.reach + reach_.length) * 1.001f;
      MF far = hn::Eq(hn::Zero(d), hn::Zero(d));
      for (int v = 0; v < vectors; ++v) {
        const V3& x = pixels[v].position;
        const V3 to{hn::Sub(x.x, hn::Set(d, s.sphere.p[0])), hn::Sub(x.y, hn::Set(d, s.sphere.p[1])),
                    hn::Add(x.z, hn::Set(d, s.sphere.p[2]))};
        far = hn::And(far, hn::Or(hn::Not(seen[v]), hn::Gt(dot(to, to), hn::Set(d, most * most))));
      }
      if (anywhere || !hn::AllTrue(d, far)) near_.push_back(&s);
    }
  }
  bool any() const { return !near_.empty(); }

  HWY_INLINE MF inner(const V3& p) const {
    const DF d;
    MF inside = hn::Lt(hn::Zero(d), hn::Zero(d));
    for (const raster::ImplicitDraw* s : near_) {
      const auto row = [&](const double m[4]) HWY_ATTR {  // view space has z towards the eye
        const VF xy = hn::Add(hn::Mul(hn::Set(d, float(m[0])), p.x), hn::Mul(hn::Set(d, float(m[1])), p.y));
        return hn::Add(hn::Sub(xy, hn::Mul(hn::Set(d, float(m[2])), p.z)), hn::Set(d, float(m[3])));
      };
      namespace implicit = raster::HWY_NAMESPACE::implicit;
      const auto& m = s->objectFromView;
      const implicit::Point<DF> at{row(m[0]), row(m[1]), row(m[2])};
      const VF sum = hn::Add(hn::Add(at.x, at.y), at.z);  // NaN, whatever is, is nowhere
      inside = hn::Or(inside, hn::And(hn::Lt(implicit::value(d, *s, at), hn::Zero(d)), hn::Eq(sum, sum)));
    }
    return inside;
  }

 private:
  raster::Span<const raster::ImplicitDraw> surfaces_;
  const Reach& reach_;
  bool all_;
  std::vector<const raster::ImplicitDraw*> near_;
};

}  // namespace HWY_NAMESPACE
}  // namespace obscura::post
HWY_AFTER_NAMESPACE();
#endif
