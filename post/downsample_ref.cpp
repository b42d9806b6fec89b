// Scalar twin of downsample.cpp.
#include <limits>
#include <vector>

#include "obscura/post/downsample.h"
#include "obscura/raster/float_environment.h"

namespace obscura::post {
namespace {

// Of a power of two of values: that of the first half plus that of the second.
float sum(const float* values, size_t count) {
  return count == 1 ? *values : sum(values, count / 2) + sum(values + count / 2, count / 2);
}

// In the sub-pixels' order.
template <class T>
std::vector<T> subpixelsOf(const raster::Plane<T>& in, int s, int x, int y) {
  std::vector<T> values;
  for (int k = 0; k < s * s; ++k) values.push_back(in.at(x * s + k % s, y * s + k / s));
  return values;
}

template <class T>
void take(const raster::Plane<T>& in, const raster::Plane<uint32_t>& nearest, int s, int y0, int y1,
          raster::Plane<T>& out) {
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < out.width(); ++x) out.at(x, y) = subpixelsOf(in, s, x, y)[nearest.at(x, y)];
}

}  // namespace

void meanOfSubpixelsRef(const raster::Plane<float>& in, int s, int y0, int y1, raster::Plane<float>& out) {
  const raster::FloatEnvironment environment;
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < out.width(); ++x) {
      const std::vector<float> values = subpixelsOf(in, s, x, y);
      out.at(x, y) = sum(values.data(), values.size()) / float(s * s);
    }
}

void nearestSubpixelRef(const raster::Plane<float>& depth, int s, int y0, int y1, raster::Plane<uint32_t>& nearest) {
  const raster::FloatEnvironment environment;
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < nearest.width(); ++x) {
      const std::vector<float> z = subpixelsOf(depth, s, x, y);
      float least = std::numeric_limits<float>::infinity();
      nearest.at(x, y) = 0;
      for (uint32_t k = 0; k < z.size(); ++k)
        if (z[k] < least) least = z[k], nearest.at(x, y) = k;
    }
}

void takeSubpixelRef(const raster::Plane<float>& in, const raster::Plane<uint32_t>& nearest, int s, int y0, int y1,
                     raster::Plane<float>& out) {
  take(in, nearest, s, y0, y1, out);
}

void takeSubpixelRef(const raster::Plane<uint32_t>& in, const raster::Plane<uint32_t>& nearest, int s, int y0, int y1,
                     raster::Plane<uint32_t>& out) {
  take(in, nearest, s, y0, y1, out);
}

}  // namespace obscura::post
