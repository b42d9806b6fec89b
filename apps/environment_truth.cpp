#include "obscura/apps/environment_truth.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "obscura/apps/sobol.h"
#include "obscura/apps/truth_pixels.h"
#include "obscura/post/transfer_samples.h"

namespace obscura::apps {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kLittle = 1.0 / 16;  // of a path's light: from there on chance decides whether it goes on

int planeOf(TruthQuantity red) { return int(red) - kTruthQuantities; }

void addTo(double* sums, TruthQuantity red, const glm::dvec3& light) {
  for (int c = 0; c < 3; ++c) sums[planeOf(red) + c] += light[c];
}

class Tracer : public PixelTracer {
 public:
  Tracer(const RaySurface& surface, const RayScene& rays, const EnvironmentSampler& environment, const TruthSettings& settings)
      : surface_(surface), rays_(rays), environment_(environment), settings_(settings) {}

  void add(const TruthStart& start, uint32_t first, int count, uint32_t pixelSeed, int scramble, double* sums) override {
    const uint32_t seed = hashed(pixelSeed, uint32_t(scramble + 2 * kTruthScrambles));
    batch_.count = count;
    for (int i = 0; i < count; ++i) paths_[i] = {start, glm::dvec3(1), glm::dvec3(0), true};
    for (uint32_t hits = 0; hits < kTruthHits; ++hits) {
      lookAtEnvironment(first, hashed(seed, 3 * hits), hits == 0, sums);
      if (!goOn(first, hashed(seed, 3 * hits + 1), hashed(seed, 3 * hits + 2))) return;
    }
  }

 private:
  struct Path {
    TruthStart at;
    glm::dvec3 light{1};  // what arrives where the path is counts with this
    glm::dvec3 direction{0};
    bool alive = true;
  };

  double openAt(double d) const { return d < 1 ? post::membershipOf(settings_.membership, d) : 1; }

  // A negative reach: below the triangle, where the point itself blocks.
  void aim(int i, const glm::dvec3& direction, float reach) {
    Path& p = paths_[i];
    p.direction = direction;
    for (int c = 0; c < 3; ++c) batch_.origin[c][i] = float(p.at.position[c]), batch_.direction[c][i] = float(direction[c]);
    batch_.reach[i] = p.alive && glm::dot(direction, p.at.outside) > 0 ? reach : -1;
  }

  bool below(int i) const { return batch_.reach[i] < 0; }
  bool hit(int i) const { return !below(i) && batch_.instance[i] != RayBatch::kMiss; }
  double distance(int i) const { return below(i) ? 0 : hit(i) ? double(batch_.reach[i]) / settings_.radius : 1; }  // of R

  void lookAtEnvironment(uint32_t first, uint32_t seed, bool atPixel, double* sums) {
    // Beyond R only real shadows ask.
    const float reach = atPixel ? std::numeric_limits<float>::max() : settings_.radius;
    for (int i = 0; i < batch_.count; ++i) {
      const glm::dvec2 xi = sobolPoint(first + uint32_t(i), seed), within(2 * xi.x - (xi.x < 0.5 ? 0 : 1), xi.y);
      aim(i, xi.x < 0.5 ? cosineDirection(paths_[i].at.normal, within) : environment_.direction(within), reach);
    }
    rays_.intersect(batch_);
    for (int i = 0; i < batch_.count; ++i) {
      const Path& p = paths_[i];
      const double cosine = glm::dot(p.direction, p.at.normal) / kPi;
      if (!p.alive || !(cosine > 0)) continue;
      const glm::dvec3 arrives = environment_.radiance(p.direction) * (cosine / (0.5 * cosine + 0.5 * environment_.density(p.direction)));
      const double open = openAt(distance(i));
      addTo(sums, TruthQuantity::LitR, p.light * open * arrives);
      if (!atPixel) continue;
      addTo(sums, TruthQuantity::OpenR, arrives);
      addTo(sums, TruthQuantity::ObscuredR, open * arrives);
      if (!below(i) && !hit(i)) addTo(sums, TruthQuantity::ShadowedR, arrives);
    }
  }

  // To what is hit next; false: no path goes on.
  bool goOn(uint32_t first, uint32_t seed, uint32_t chance) {
    for (int i = 0; i < batch_.count; ++i) aim(i, cosineDirection(paths_[i].at.normal, sobolPoint(first + uint32_t(i), seed)), settings_.radius);
    rays_.intersect(batch_);
    bool any = false;
    for (int i = 0; i < batch_.count; ++i) {
      Path& p = paths_[i];
      if (!p.alive) continue;
      const double open = openAt(distance(i));
      if (hit(i)) p.at = startAtHit(surface_, batch_.point(i), p.direction);
      p.light *= (1 - open) * glm::dvec3(p.at.albedo);
      const double most = std::max({p.light.x, p.light.y, p.light.z});
      p.alive = most > 0 && (most >= kLittle || sobolPoint(first + uint32_t(i), chance).x * kLittle < most);
      if (most < kLittle) p.light *= kLittle / std::max(most, 1e-300);
      any |= p.alive;
    }
    return any;
  }

  const RaySurface& surface_;
  const RayScene& rays_;
  const EnvironmentSampler& environment_;
  const TruthSettings& settings_;
  RayBatch batch_;
  Path paths_[RayBatch::kSize];
};

}  // namespace

Truth traceEnvironment(const RaySurface& surface, const RayScene& rays, const TruthStarts& starts, const EnvironmentSampler& environment,
                       int width, int height, const TruthSettings& settings, const std::function<void(int)>& done) {
  return tracePixels(starts, width, height, settings, std::vector<float>(kEnvironmentQuantities, 0),
                     [&] { return std::make_unique<Tracer>(surface, rays, environment, settings); }, done);
}

void append(Truth& truth, Truth environment) {
  for (auto& plane : environment.value) truth.value.push_back(std::move(plane));
  for (auto& plane : environment.error) truth.error.push_back(std::move(plane));
}

}  // namespace obscura::apps
