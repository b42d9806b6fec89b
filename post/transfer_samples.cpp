#include "obscura/post/transfer_samples.h"

#include <cmath>

#include "obscura/post/dealt_samples.h"
#include "obscura/post/sample_sets.h"
#include "obscura/raster/exact_math.h"
#include "obscura/raster/float_environment.h"

namespace obscura::post {
namespace {

constexpr double kTwoPi = 6.283185307179586476925;
constexpr double kTauR = 5;  // tau of the exponential membership, times R
constexpr uint32_t kSobolSeed = 1;

std::vector<glm::vec3> samplePoints(const AmbientSettings& s) {
  if (s.estimator == Estimator::Paper) return {sampleSet(s.samples).begin(), sampleSet(s.samples).end()};
  std::vector<glm::vec3> points = dealtSamples(s.samples, s.estimator == Estimator::Box || s.estimator == Estimator::March ? boxSeed(s.samples) : kSobolSeed);
  for (size_t i = size_t(s.samples); !s.interleave && i < points.size(); ++i) points[i] = points[i - size_t(s.samples)];
  return points;
}

}  // namespace

double inverseMembership(Membership membership, double xi) {
  switch (membership) {
    case Membership::Classic: return 1;
    case Membership::Linear: return xi;
    case Membership::Sqrt: return xi * xi;
    case Membership::Exponential: return -raster::exactLog(1 - xi * (1 - raster::exactExp(-kTauR))) / kTauR;
  }
  return 1;
}

double membershipOf(Membership membership, double d) {
  if (!(d < 1)) return 1;
  switch (membership) {
    case Membership::Classic: return 0;
    case Membership::Linear: return d;
    case Membership::Sqrt: return std::sqrt(d);
    case Membership::Exponential: return (1 - raster::exactExp(-kTauR * d)) / (1 - raster::exactExp(-kTauR));
  }
  return 1;
}

std::vector<glm::vec3> transferSamples(const AmbientSettings& settings) {
  const raster::FloatEnvironment environment;
  std::vector<glm::vec3> offsets;
  for (const glm::vec3& xi : samplePoints(settings)) {
    if (settings.estimator == Estimator::Lines) {
      const double angle = kTwoPi * xi.y, r = xi.z;
      offsets.push_back({float(raster::exactCos(angle) * r), float(raster::exactSin(angle) * r), float(1 / r)});
      continue;
    }
    const double angle = kTwoPi * xi.x, sine = std::sqrt(double(xi.y)), cosine = std::sqrt(1 - double(xi.y));
    const double r = inverseMembership(settings.membership, xi.z) * settings.radius;
    offsets.push_back({float(raster::exactCos(angle) * sine * r), float(raster::exactSin(angle) * sine * r), float(cosine * r)});
  }
  return offsets;
}

}  // namespace obscura::post
