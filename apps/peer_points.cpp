#include <cmath>

#include "obscura/apps/peer_methods.h"
#include "obscura/post/dealt_samples.h"
#include "obscura/post/sample_sets.h"
#include "obscura/raster/exact_math.h"
#include "obscura/raster/float_environment.h"

namespace obscura::apps {
namespace {

using raster::exactCos;
using raster::exactSin;

constexpr double kPi = 3.14159265358979323846;
constexpr uint32_t kSeed = 1;  // that of Estimator::Sobol

glm::vec3 inBall(const glm::vec3& xi, PeerAim aim, float radius) {
  const double z = 1 - 2 * double(xi.y), across = std::sqrt(1 - z * z), angle = 2 * kPi * xi.x;
  const double r = radius * (aim == PeerAim::Own ? raster::exactPow(xi.z, 1.0 / 3) : double(xi.z));
  return {float(r * across * exactCos(angle)), float(r * across * exactSin(angle)), float(r * z)};
}

glm::vec3 inDisc(const glm::vec3& xi, float radius) {
  const double r = std::sqrt(double(xi.y)), angle = 2 * kPi * xi.x, half = 0.5 * radius;
  return {float(half * r * exactCos(angle)), float(half * r * exactSin(angle)), float(half * std::sqrt(1 - double(xi.y)))};
}

// The 16 n directions are even; j, the pixel's place among the 16, and its bits backwards make an even grid of angles and steps.
glm::vec3 inImage(int i, int j, int n, double turn) {
  const int backwards = (j & 1) << 3 | (j & 2) << 1 | (j & 4) >> 1 | (j & 8) >> 3;
  const double angle = turn * (i + j / 16.0) / n, step = (backwards + 0.5) / 16 + i * 0.6180339887498949;
  return {float(exactCos(angle)), float(exactSin(angle)), float(step - std::floor(step))};
}

}  // namespace

std::vector<glm::vec3> peerPoints(const PeerSettings& peer, const post::AmbientSettings& s) {
  const raster::FloatEnvironment environment;
  const int n = s.samples;
  const bool horizons = peer.method == PeerMethod::Hbao || peer.method == PeerMethod::Gtao;
  const bool pairs = peer.method == PeerMethod::Ssao && n % 2 == 0;
  const int drawn = pairs ? n / 2 : n;
  std::vector<glm::vec3> net, points;
  if (!horizons) net = post::dealtSamples(drawn, kSeed);
  for (int p = 0; p < 16; ++p)
    for (int i = 0; i < n; ++i) {
      const int pixel = s.interleave ? p : 0;
      if (horizons) {
        points.push_back(inImage(i, post::rotationOrder()[size_t(pixel)], n, peer.method == PeerMethod::Hbao ? 2 * kPi : kPi));
        continue;
      }
      const glm::vec3& xi = net[size_t(pixel * drawn + i % drawn)];
      points.push_back(peer.method == PeerMethod::Vao ? inDisc(xi, s.radius) : inBall(xi, peer.aim, s.radius) * (i < drawn ? 1.0f : -1.0f));
    }
  return points;
}

}  // namespace obscura::apps
