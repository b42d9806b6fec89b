#include "obscura/apps/ray_estimator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>

#include "obscura/apps/sobol.h"
#include "obscura/post/transfer_samples.h"

namespace obscura::apps {
namespace {

constexpr float kOffset = 0.002f;  // of R

// Directions about (0, 0, 1), n for each of the 16 pixels of the pattern.
std::vector<glm::vec3> dealtDirections(int n) {
  std::vector<glm::vec3> all;
  for (uint32_t i = 0; i < uint32_t(16 * n); ++i) {
    const glm::dvec2 xi = sobolPoint(i, 1);
    const double phi = 6.283185307179586 * xi.x, r = std::sqrt(xi.y);
    all.emplace_back(std::cos(phi) * r, std::sin(phi) * r, std::sqrt(1 - xi.y));
  }
  return all;
}

class RowTracer {
 public:
  RowTracer(const RayScene& rays, const post::TransferInput& in, const std::vector<glm::vec3>& directions, float* numerators)
      : rays_(rays), in_(in), directions_(directions), numerators_(numerators) {}

  void addPixel(int x, int y) {
    const post::Projector& q = in_.projector;
    const raster::GBuffer& g = *in_.g;
    const float depth = g.depth.at(x, y), n = float(in_.settings.samples);
    if (!(depth < std::numeric_limits<float>::infinity())) {
      numerators_[x] = n;
      return;
    }
    numerators_[x] = 0;
    const float w = q.perspective ? depth : 1;
    const int xImage = x + q.xFirst, yImage = y + q.yFirst;
    const glm::vec3 normal(g.normal[0].at(x, y), g.normal[1].at(x, y), g.normal[2].at(x, y));
    const glm::vec3 p = glm::vec3((float(xImage) + 0.5f - q.xCenter) * q.xInverse * w,
                                  (float(yImage) + 0.5f - q.yCenter) * q.yInverse * w, -depth) + normal * (kOffset * in_.settings.radius);
    // The frame about the normal after Duff et al. 2017.
    const float sign = std::copysign(1.0f, normal.z), a = -1 / (sign + normal.z), b = normal.x * normal.y * a;
    const glm::vec3 t(1 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x), s(b, sign + normal.y * normal.y * a, -normal.y);
    const glm::vec3* first = &directions_[size_t(((xImage & 3) + 4 * (yImage & 3)) * in_.settings.samples)];
    for (int i = 0; i < in_.settings.samples; ++i) addRay(x, p, t * first[i].x + s * first[i].y + normal * first[i].z);
  }

  void flush() {
    if (batch_.count == 0) return;
    rays_.intersect(batch_);
    const float perR = 1 / in_.settings.radius;
    for (int i = 0; i < batch_.count; ++i)
      numerators_[pixel_[i]] += batch_.instance[i] == RayBatch::kMiss
                                    ? 1 : float(post::membershipOf(in_.settings.membership, double(batch_.reach[i] * perR)));
    batch_.count = 0;
  }

 private:
  void addRay(int x, const glm::vec3& p, const glm::vec3& direction) {
    const int i = batch_.count++;
    for (int c = 0; c < 3; ++c) batch_.origin[c][i] = p[c], batch_.direction[c][i] = direction[c];
    batch_.reach[i] = in_.settings.radius;
    pixel_[i] = x;
    if (batch_.count == RayBatch::kSize) flush();
  }

  const RayScene& rays_;
  const post::TransferInput& in_;
  const std::vector<glm::vec3>& directions_;
  float* numerators_;
  RayBatch batch_;
  int pixel_[RayBatch::kSize];
};

}  // namespace

void traceObscurance(const RayScene& rays, const post::TransferInput& in, raster::Parallel& parallel, post::TransferSums& out) {
  const std::vector<glm::vec3> directions = dealtDirections(in.settings.samples);
  parallel.forRanges(size_t(in.g->height), 4, [&](size_t y0, size_t y1, int) {
    for (int y = int(y0); y < int(y1); ++y) {
      RowTracer tracer(rays, in, directions, out.numerator.row(y));
      for (int x = 0; x < in.g->width; ++x) tracer.addPixel(x, y);
      tracer.flush();
      std::fill_n(out.open.row(y), out.open.width(), uint8_t(0));  // none is known to be open
    }
  });
}

}  // namespace obscura::apps
