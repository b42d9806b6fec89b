#include "obscura/post/asked.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "obscura/post/ambient_transfer.h"

namespace obscura::post {
namespace {

// The filter's window of pixel p is p - 2 ... p + 1 on both axes (depth_filter.h), so that q lies in those of q - 1 ... q + 2.
constexpr int kBefore = 1, kAfter = 2;

// Answers for segments of 16 pixels. Most are lit, and then one pixel says so: planes are hardly read.
class Asked {
 public:
  explicit Asked(const AskedInput& in) : in_(in), g_(*in.g), before_(in.filter ? kBefore : 0), after_(in.filter ? kAfter : 0) {}

  void rows(int y0, int y1, raster::Plane<uint8_t>& asked) const {
    // Row y0 + 2 is in the windows' reach of all four rows from y0 on.
    constexpr int kBand = kBefore + kAfter + 1;
    for (int y = y0; y < y1; y += kBand)
      for (int s = 0; s < asked.width(); ++s) {
        const bool all = in_.filter && asks(s, y + kAfter);
        for (int row = y; row < std::min(y + kBand, y1); ++row) asked.at(s, row) = all || reaches(s, row);
      }
  }

 private:
  // A pixel asks whose window meets segment s of row y.
  bool reaches(int s, int y) const {
    for (int row = y - before_; row <= y + after_; ++row)
      if (asks(s, row)) return true;
    return false;
  }

  // A pixel of row y asks whose window meets the columns of segment s.
  bool asks(int s, int y) const {
    if (y < in_.part.y || y >= in_.part.y + in_.part.height) return false;
    const int first = std::max(s * kSegment - before_, in_.part.x);
    const int end = std::min((s + 1) * kSegment + after_, in_.part.x + in_.part.width);
    for (int x = first; x < end; ++x)
      if (!in_.onlyLit || isLit(x, y)) return true;
    return false;
  }

  // Or empty: that is cheaper to let pass than to find out that all of a sky asks for nothing.
  bool isLit(int x, int y) const {
    if (!reflects(x, y)) return !(g_.depth.at(x, y) < std::numeric_limits<float>::infinity());
    if (in_.ambient.empty() || g_.instance.at(x, y) >= in_.ambient.size()) return true;
    const glm::vec3& la = in_.ambient[g_.instance.at(x, y)];
    return la != glm::vec3(0);
  }

  bool reflects(int x, int y) const {
    if (in_.glossy) return !std::signbit(g_.metallic.at(x, y));
    return g_.albedo[0].at(x, y) > 0 || g_.albedo[1].at(x, y) > 0 || g_.albedo[2].at(x, y) > 0;
  }

  const AskedInput& in_;
  const raster::GBuffer& g_;
  const int before_, after_;
};

}  // namespace

void askedPixels(const AskedInput& in, int y0, int y1, raster::Plane<uint8_t>& asked) { Asked(in).rows(y0, y1, asked); }

}  // namespace obscura::post
