// Per target: the test points of a pixel's rays in the frame (T', B', N), those of a ray one after the other.
#if defined(OBSCURA_POST_RAY_POINTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef OBSCURA_POST_RAY_POINTS_INL_H_
#undef OBSCURA_POST_RAY_POINTS_INL_H_
#else
#define OBSCURA_POST_RAY_POINTS_INL_H_
#endif

#include <vector>

#include "obscura/post/ambient_transfer.h"
#include "obscura/post/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::post {
namespace HWY_NAMESPACE {

// The paper's: all pixels have the same, in a frame that is turned.
class SharedPoints {
 public:
  static constexpr bool kTurned = true, kMarched = false;

  SharedPoints(const TransferInput& in, int steps) {
    for (const glm::vec3& offset : in.offsets)
      for (int k = 1; k <= steps; ++k) points_.push_back(offset * (float(k) / float(steps)));
  }
  const std::vector<glm::vec3>& all() const { return points_; }

  void startRow(int) {}
  HWY_INLINE V3 at(size_t point, int) const {
    const DF d;
    const glm::vec3& p = points_[point];
    return {hn::Set(d, p.x), hn::Set(d, p.y), hn::Set(d, p.z)};
  }

 private:
  std::vector<glm::vec3> points_;
};

// Dealt to a 4x4 pattern: in a row the lanes repeat four points, so that one load of them and a broadcast do.
class DealtPoints {
 public:
  static constexpr bool kTurned = false, kMarched = false;

  DealtPoints(const TransferInput& in, int steps) : points_(SharedPoints(in, steps).all()), perRow_(points_.size() / 16) {
    rows_.reserve(4 * perRow_);
    for (size_t row = 0; row < 4; ++row)
      for (size_t point = 0; point < perRow_; ++point) {
        Four four;
        for (int lane = 0; lane < 4; ++lane) {  // lane 0 is a pixel whose x in the G-buffer is a multiple of 4
          const glm::vec3& p = points_[(size_t((lane + in.projector.xFirst) & 3) + 4 * row) * perRow_ + point];
          four.x[lane] = p.x, four.y[lane] = p.y, four.z[lane] = p.z;
        }
        rows_.push_back(four);
      }
  }
  const std::vector<glm::vec3>& all() const { return points_; }

  void startRow(int yImage) { row_ = rows_.data() + size_t(yImage & 3) * perRow_; }
  HWY_INLINE V3 at(size_t point, int x) const {
    const Four& four = row_[point];
    return {repeated(four.x, x), repeated(four.y, x), repeated(four.z, x)};
  }

 protected:
  // Vectors begin at multiples of their length.
  HWY_INLINE static VF repeated(const float (&four)[4], int x) {
    if (hn::MaxLanes(DF()) < 4) return hn::LoadU(DF(), four + (x & 3));
    return hn::LoadDup128(DF(), four);
  }

 private:
  struct Four {
    float x[4], y[4], z[4];
  };

  std::vector<glm::vec3> points_;
  size_t perRow_;  // n rays of m points
  std::vector<Four> rows_;
  const Four* row_ = nullptr;
};

}  // namespace HWY_NAMESPACE
}  // namespace obscura::post
HWY_AFTER_NAMESPACE();
#endif
