// Scalar twin of depth_filter.cpp.
#include <algorithm>
#include <cmath>
#include <limits>

#include "obscura/post/depth_filter.h"
#include "obscura/raster/float_environment.h"

namespace obscura::post {
namespace {

// N . p of the point seen in a pixel, N in the papers' camera space.
float heightOver(const glm::vec3& N, const TransferInput& in, int x, int y) {
  const Projector& p = in.projector;
  const float z = in.g->depth.at(x, y);
  const float xRay = (float(x + p.xFirst) + 0.5f - p.xCenter) * p.xInverse;
  const float yRay = (float(y + p.yFirst) + 0.5f - p.yCenter) * p.yInverse;
  return p.perspective ? z * (N.x * xRay + N.y * yRay + N.z) : N.x * xRay + N.y * yRay + N.z * z;
}

bool counts(const TransferInput& in, int x, int y, int u, int v) {
  const raster::GBuffer& g = *in.g;
  if (in.settings.filterGuide == FilterGuide::Depth)
    return std::fabs(g.depth.at(x, y) - g.depth.at(u, v)) < in.settings.filterThreshold;
  const auto normal = [&](int i, int j) { return glm::vec3(g.normal[0].at(i, j), g.normal[1].at(i, j), -g.normal[2].at(i, j)); };
  const glm::vec3 N = normal(x, y), other = normal(u, v);
  return std::fabs(heightOver(N, in, u, v) - heightOver(N, in, x, y)) < kPlaneDistance * in.settings.radius &&
         N.x * other.x + N.y * other.y + N.z * other.z > kNormalCosine;
}

void filterPixel(const TransferInput& in, const TransferSums& sums, int x, int y, Transfer& out) {
  const raster::GBuffer& g = *in.g;
  const float z = g.depth.at(x, y);
  const bool own = in.settings.albedo == TransferAlbedo::Own, stored = in.settings.albedo == TransferAlbedo::Radiance;
  const bool transfer = !(stored ? out.bounced : out.w)[0].empty();
  float numerator = 0, denominator[3] = {0, 0, 0}, rays = 0;
  const int before = in.settings.filter ? 2 : 0, after = in.settings.filter ? 1 : 0;
  for (int j = y - before; j <= y + after; ++j)
    for (int i = x - before; i <= x + after; ++i) {
      const int u = std::clamp(i, 0, g.width - 1), v = std::clamp(j, 0, g.height - 1);
      if (!(i == x && j == y) && !counts(in, x, y, u, v)) continue;
      rays += float(in.settings.samples);
      numerator += sums.numerator.at(u, v);
      for (int c = 0; c < 3 && transfer && !own; ++c) denominator[c] += sums.denominator[c].at(u, v);
    }
  const bool empty = !(z < std::numeric_limits<float>::infinity());
  if (!out.obscurance.empty()) out.obscurance.at(x, y) = empty ? 1 : numerator / rays;
  for (int c = 0; c < 3 && transfer; ++c) {
    if (stored) {
      const float light = 0 - denominator[c], most = std::numeric_limits<float>::max();
      out.bounced[c].at(x, y) = !empty && light > 0 ? std::min(light, most) / rays : 0;
      continue;
    }
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
