// Scalar twin of depth_filter.cpp.
#include <algorithm>
#include <cmath>
#include <limits>

#include "obscura/post/depth_filter.h"
#include "obscura/raster/float_environment.h"

namespace obscura::post {
namespace {

void filterPixel(const TransferInput& in, const TransferSums& sums, int x, int y, Transfer& out) {
  const raster::GBuffer& g = *in.g;
  const float z = g.depth.at(x, y);
  const bool own = in.settings.albedo == TransferAlbedo::Own, transfer = !out.w[0].empty();
  float numerator = 0, denominator[3] = {0, 0, 0}, rays = 0;
  const int before = in.settings.filter ? 2 : 0, after = in.settings.filter ? 1 : 0;
  for (int j = y - before; j <= y + after; ++j)
    for (int i = x - before; i <= x + after; ++i) {
      const int u = std::clamp(i, 0, g.width - 1), v = std::clamp(j, 0, g.height - 1);
      if (!(i == x && j == y) && !(std::fabs(z - g.depth.at(u, v)) < in.settings.filterThreshold)) continue;
      rays += float(in.settings.samples);
      numerator += sums.numerator.at(u, v);
      for (int c = 0; c < 3 && transfer && !own; ++c) denominator[c] += sums.denominator[c].at(u, v);
    }
  const bool empty = !(z < std::numeric_limits<float>::infinity());
  if (!out.obscurance.empty()) out.obscurance.at(x, y) = empty ? 1 : numerator / rays;
  for (int c = 0; c < 3 && transfer; ++c) {
    const float den = own ? rays - g.albedo[c].at(x, y) * (rays - numerator) : denominator[c];
    out.w[c].at(x, y) = !empty && den > numerator ? numerator / den : 1;
  }
}

}  // namespace

void depthFilterRef(const TransferInput& in, const TransferSums& sums, int y0, int y1, Transfer& out) {
  const raster::FloatEnvironment environment;
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < in.g->width; ++x) filterPixel(in, sums, x, y, out);
}

}  // namespace obscura::post
