// Per target: rays that are followed through the depth map, see ray_march.h.
#if defined(OBSCURA_POST_RAY_MARCH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef OBSCURA_POST_RAY_MARCH_INL_H_
#undef OBSCURA_POST_RAY_MARCH_INL_H_
#else
#define OBSCURA_POST_RAY_MARCH_INL_H_
#endif

#include <vector>

#include "obscura/post/containment-inl.h"
#include "obscura/post/ray_march.h"
#include "obscura/post/ray_points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::post {
namespace HWY_NAMESPACE {

// at(i, x): the ends of the rays.
class MarchedRays : public DealtPoints {
 public:
  static constexpr bool kMarched = true;

  MarchedRays(const TransferInput& in, int) : DealtPoints(in, 1) {
    const std::vector<RayMarch> marches = rayMarches(in.settings, in.offsets);
    const size_t perRow = marches.size() / 16;
    rows_.reserve(4 * perRow);
    for (size_t row = 0; row < 4; ++row)
      for (size_t i = 0; i < perRow; ++i) {
        Four four;
        for (int lane = 0; lane < 4; ++lane) {
          const RayMarch& march = marches[(size_t((lane + in.projector.xFirst) & 3) + 4 * row) * perRow + i];
          four.early[lane] = march.early, four.shell[lane] = march.shell, four.shell2[lane] = march.shell2;
        }
        rows_.push_back(four);
      }
    perRow_ = perRow;
  }

  void startRow(int yImage) {
    DealtPoints::startRow(yImage);
    row_ = rows_.data() + size_t(yImage & 3) * perRow_;
  }
  HWY_INLINE VF early(size_t i, int x) const { return repeated(row_[i].early, x); }
  HWY_INLINE VF shell(size_t i, int x) const { return repeated(row_[i].shell, x); }
  HWY_INLINE VF shell2(size_t i, int x) const { return repeated(row_[i].shell2, x); }

 private:
  struct Four {
    float early[4], shell[4], shell2[4];
  };
  std::vector<Four> rows_;
  size_t perRow_ = 0;
  const Four* row_ = nullptr;
};

// Of a vector of pixels: N . q of the point seen at (u, v) is z (a u + b v + c), or a u + b v + c + N_z z if the projection is
// orthographic; `least` is N . x + bias.
template <bool kPerspective>
struct TangentPlane {
  VF a, b, c, facing, least;

  HWY_INLINE TangentPlane(const TransferInput& in, const Pixels& at) {
    const DF d;
    const Projector& p = in.projector;
    a = hn::Mul(at.n.x, hn::Set(d, p.xInverse));
    b = hn::Mul(at.n.y, hn::Set(d, p.yInverse));
    c = hn::Add(hn::Mul(a, hn::Set(d, 0.5f - p.xCenter)), hn::Mul(b, hn::Set(d, 0.5f - p.yCenter)));
    if (kPerspective) c = hn::Add(c, at.n.z);
    facing = at.n.z;
    least = hn::Add(dot(at.n, at.position), hn::Set(d, in.settings.bias));
  }

  HWY_INLINE VF along(VF u, VF v) const { return hn::Add(hn::Add(hn::Mul(a, u), hn::Mul(b, v)), c); }
  HWY_INLINE MF above(VF sight, VF z) const {  // sight: along(u, v)
    return hn::Gt(kPerspective ? hn::Mul(z, sight) : hn::Add(sight, hn::Mul(facing, z)), least);
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace obscura::post
HWY_AFTER_NAMESPACE();
#endif
