#include "obscura/post/make_dealt_seed.h"

#include <cmath>
#include <vector>

#include <glm/vec3.hpp>

#include "obscura/post/dealt_samples.h"
#include "obscura/post/sample_sets.h"
#include "obscura/raster/exact_math.h"

namespace obscura::post {
namespace {

constexpr int kCandidates = 4096;  // shared out: 4096 / n for a set of n
constexpr size_t kPlanes = 128;
constexpr double kTwoPi = 6.283185307179586476925;

struct Plane {
  glm::dvec3 direction;
  double distance, share;  // share of the test points behind it
};

// In units of R, in the frame (T, B, N).
std::vector<glm::dvec3> testPoints(int n, uint32_t seed) {
  std::vector<glm::dvec3> points;
  for (const glm::vec3& xi : dealtSamples(n, seed)) {
    const double angle = kTwoPi * xi.x, r = xi.z, across = std::sqrt(double(xi.y)) * r;
    points.emplace_back(raster::exactCos(angle) * across, raster::exactSin(angle) * across, std::sqrt(1 - double(xi.y)) * r);
  }
  return points;
}

bool behind(const Plane& plane, const glm::dvec3& p) {
  const glm::dvec3& m = plane.direction;
  return m.x * p.x + m.y * p.y + m.z * p.z > plane.distance;
}

// Those that cut off too little to matter are passed over.
std::vector<Plane> makePlanes() {
  std::vector<glm::dvec3> many;
  for (uint32_t seed = 1000; seed < 1008; ++seed)
    for (const glm::dvec3& p : testPoints(kMaxSamples, seed)) many.push_back(p);
  std::vector<Plane> planes;
  uint64_t state = 0;
  const auto random = [&state] {  // a linear congruential generator (Knuth's), upper 32 bits
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    return double(state >> 32) * 0x1p-32;
  };
  while (planes.size() < kPlanes) {
    const double z = 2 * random() - 1, angle = kTwoPi * random(), across = std::sqrt(1 - z * z);
    Plane plane{{raster::exactCos(angle) * across, raster::exactSin(angle) * across, z}, 0.8 * random(), 0};
    for (const glm::dvec3& p : many) plane.share += behind(plane, p);
    plane.share /= double(many.size());
    if (plane.share >= 0.005) planes.push_back(plane);
  }
  return planes;
}

double errorOver(const std::vector<Plane>& planes, int n, uint32_t seed) {
  const std::vector<glm::dvec3> points = testPoints(n, seed);
  double sum = 0;
  for (const Plane& plane : planes) {
    int counts[16];
    for (size_t pixel = 0; pixel < 16; ++pixel) {
      counts[pixel] = 0;
      for (size_t i = 0; i < size_t(n); ++i) counts[pixel] += behind(plane, points[pixel * size_t(n) + i]);
    }
    const auto squared = [&](int count, int pixels) {
      const double e = double(count) / (n * pixels) - plane.share;
      return e * e;
    };
    int all = 0;
    for (int pixel = 0; pixel < 16; ++pixel) {
      all += counts[pixel];
      sum += squared(counts[pixel], 1) / 16;
      if (pixel % 2 == 0 && pixel / 4 % 2 == 0)  // the upper left one of a quad
        sum += squared(counts[pixel] + counts[pixel + 1] + counts[pixel + 4] + counts[pixel + 5], 4);
    }
    sum += 16 * squared(all, 16);
  }
  return sum / double(planes.size());
}

}  // namespace

double dealtError(int n, uint32_t seed) { return errorOver(makePlanes(), n, seed); }

uint32_t makeBoxSeed(int n) {
  const std::vector<Plane> planes = makePlanes();
  uint32_t best = 0;
  double least = errorOver(planes, n, best);
  for (uint32_t seed = 1; seed < uint32_t(kCandidates / n); ++seed)
    if (const double error = errorOver(planes, n, seed); error < least) {
      least = error;
      best = seed;
    }
  return best;
}

}  // namespace obscura::post
