#include "obscura/apps/truth.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "obscura/apps/sobol.h"
#include "obscura/apps/truth_pixels.h"
#include "obscura/post/transfer_samples.h"

namespace obscura::apps {
namespace {

using Sums = double*;  // one for each quantity

// What a first hit at the distance d = reach of R tells of every O; `cosine` is the direction's to the normal.
void addObscurances(double d, double cosine, Sums sums) {
  for (int m = 0; m < 4; ++m) sums[m] += d < 1 ? post::membershipOf(post::Membership(m), d) : 1;
  // The sphere's chord is R cos long; int r^2 dr of its part in sight over that of the sphere, by the density cos / pi:
  // (min(d, cos)^3 / 3) (pi / cos) / (pi / 6).
  const double chord = std::min(d, cosine);
  sums[int(TruthQuantity::TangentSphere)] += cosine > 0 ? 2 * chord * chord * chord / cosine : 0;
}

// The same of what directions tell that are evenly spread over the half sphere.
void addEvenly(double d, Sums sums) {
  const double part = std::min(d, 1.0);
  sums[int(TruthQuantity::Ball)] += part * part * part;
  sums[int(TruthQuantity::Horizon)] += part * part;
}

struct Path {
  TruthStart at;
  glm::dvec3 light{1};  // what of La still has to come from where the path is
  glm::dvec3 direction{0};
};

class Tracer : public PixelTracer {
 public:
  Tracer(const RaySurface& surface, const RayScene& rays, const TruthSettings& settings)
      : surface_(surface), rays_(rays), settings_(settings) {}

  void add(const TruthStart& start, uint32_t first, int count, uint32_t pixelSeed, int scramble, double* sums) override {
    trace(start, first, count, hashed(pixelSeed, uint32_t(scramble)), sums);
    traceEvenly(start, first, count, hashed(pixelSeed, uint32_t(scramble + kTruthScrambles)), sums);
  }

 private:
  // Adds `count` paths, points first ... of the scramble `seed`.
  void trace(const TruthStart& start, uint32_t first, int count, uint32_t seed, Sums sums) {
    batch_.count = count;
    for (int i = 0; i < count; ++i) paths_[i] = {start, glm::dvec3(1), {}}, alive_[i] = true;
    for (int hits = 0; hits < kTruthHits; ++hits) {
      bool any = false;
      for (int i = 0; i < count; ++i) {
        batch_.reach[i] = -1;
        if (alive_[i] && survives(i, first + uint32_t(i), hashed(seed, uint32_t(2 * hits)))) {
          aim(i, cosineDirection(paths_[i].at.normal, sobolPoint(first + uint32_t(i), hashed(seed, uint32_t(2 * hits + 1)))));
          any = true;
        }
      }
      if (!any) return;
      rays_.intersect(batch_);
      for (int i = 0; i < count; ++i)
        if (alive_[i]) meet(i, hits == 0, sums);
    }
    for (int i = 0; i < count; ++i)
      if (alive_[i]) addLight(paths_[i].light, sums);
  }

  // Alike, first hits of directions that are evenly spread.
  void traceEvenly(const TruthStart& start, uint32_t first, int count, uint32_t seed, Sums sums) {
    batch_.count = count;
    for (int i = 0; i < count; ++i) {
      paths_[i].at = start, batch_.reach[i] = -1;
      aim(i, evenDirection(start.normal, sobolPoint(first + uint32_t(i), seed)));
    }
    rays_.intersect(batch_);
    for (int i = 0; i < count; ++i) addEvenly(distance(i), sums);
  }

  static void addLight(const glm::dvec3& light, Sums sums) {
    for (int c = 0; c < 3; ++c) sums[int(TruthQuantity::TransferR) + c] += light[c];
  }

  // Russian roulette, once there is little to come.
  bool survives(int i, uint32_t index, uint32_t seed) {
    constexpr double kLittle = 1.0 / 16;
    glm::dvec3& light = paths_[i].light;
    const double most = std::max({light.x, light.y, light.z});
    if (most >= kLittle) return true;
    alive_[i] = sobolPoint(index, seed).x * kLittle < most;
    light *= kLittle / std::max(most, 1e-300);
    return alive_[i];
  }

  void aim(int i, const glm::dvec3& direction) {
    Path& p = paths_[i];
    p.direction = direction;
    for (int c = 0; c < 3; ++c) {
      batch_.origin[c][i] = float(p.at.position[c]);
      batch_.direction[c][i] = float(p.direction[c]);
    }
    if (glm::dot(p.direction, p.at.outside) > 0) batch_.reach[i] = settings_.radius;
  }

  bool below(int i) const { return batch_.reach[i] < 0; }
  bool hit(int i) const { return !below(i) && batch_.instance[i] != RayBatch::kMiss; }
  double distance(int i) const { return below(i) ? 0 : hit(i) ? double(batch_.reach[i]) / settings_.radius : 1; }  // of R

  void meet(int i, bool first, Sums sums) {
    Path& p = paths_[i];
    const double d = distance(i);
    if (first) addObscurances(d, glm::dot(p.direction, p.at.normal), sums);
    const double open = d < 1 ? post::membershipOf(settings_.membership, d) : 1;
    addLight(p.light * open, sums);
    if (hit(i)) p.at = startAtHit(surface_, batch_.point(i), p.direction);
    p.light *= (1 - open) * glm::dvec3(p.at.albedo);
    for (int c = 0; c < 3 && first; ++c) sums[int(TruthQuantity::BounceR) + c] += p.light[c];
    alive_[i] = (hit(i) || below(i)) && open < 1 && std::max({p.light.x, p.light.y, p.light.z}) > 0;
  }

  const RaySurface& surface_;
  const RayScene& rays_;
  const TruthSettings& settings_;
  RayBatch batch_;
  Path paths_[RayBatch::kSize];
  bool alive_[RayBatch::kSize];
};

}  // namespace

Truth::Truth(int width, int height, int quantities) {
  for (int q = 0; q < quantities; ++q) {
    value.emplace_back(width, height);
    error.emplace_back(width, height);
  }
}

const std::vector<engine::Aov>& truthAovs() {
  using engine::Aov;
  static const std::vector<Aov> aovs = {Aov::Depth, Aov::Normal, Aov::Albedo, Aov::Triangle, Aov::Instance};
  return aovs;
}

Truth traceTruth(const RaySurface& surface, const RayScene& rays, const TruthStarts& starts, int width, int height,
                 const TruthSettings& settings, const std::function<void(int)>& done) {
  std::vector<float> empty(kTruthQuantities, 1);
  for (int c = 0; c < 3; ++c) empty[size_t(TruthQuantity::BounceR) + size_t(c)] = 0;
  return tracePixels(starts, width, height, settings, empty, [&] { return std::make_unique<Tracer>(surface, rays, settings); }, done);
}

}  // namespace obscura::apps
