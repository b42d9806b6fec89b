// What rough surfaces reflect of an environment: the chain of cube maps against direct integration.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "obscura/engine/environment.h"
#include "obscura/engine/prefiltered_environment.h"
#include "environment_maps.h"

using namespace obscura;
using engine::EnvironmentMap;
using Projection = engine::EnvironmentProjection;

namespace {

constexpr double kPi = 3.14159265358979323846;

template <class F>
EnvironmentMap cubeOf(int side, const F& radiance) {
  return tests::filledEnvironment({Projection::Cube, side, side}, radiance);
}

// Blue above, brown below, and a sun of this cosine of its radius around (0.6, 0.64, 0.48).
glm::dvec3 sky(const glm::dvec3& d, double cosine, double sun) {
  if (glm::dot(d, glm::dvec3(0.6, 0.64, 0.48)) > cosine) return glm::dvec3(30, 28, 25) * sun;
  return d.y > 0 ? glm::dvec3(0.3, 0.5, 1) : glm::dvec3(0.3, 0.2, 0.1);
}
glm::dvec3 sunny(const glm::dvec3& d) { return sky(d, 0.985, 1); }
glm::dvec3 glaring(const glm::dvec3& d) { return sky(d, 0.99985, 30); }

struct Texel {
  glm::dvec3 direction, light;  // radiance times solid angle
  double solidAngle;
};

std::vector<Texel> texelsOf(const EnvironmentMap& map) {
  const engine::EnvironmentProjector& p = map.projector();
  std::vector<Texel> all;
  for (int face = 0; face < 6; ++face)
    for (int y = 0; y < p.height; ++y)
      for (int x = 0; x < p.width; ++x)
        all.push_back({p.directionAt({face, x + 0.5, y + 0.5}), p.solidAngle(x, y) * glm::dvec3(map.at(face, x, y)), p.solidAngle(x, y)});
  return all;
}

// By the definition, with D as Walter et al. 2007 write it, over all texels.
glm::dvec3 integrated(const std::vector<Texel>& texels, const glm::dvec3& r, double roughness) {
  const double alpha2 = std::pow(roughness, 4);
  glm::dvec3 sum(0);
  double weights = 0;
  for (const Texel& l : texels) {
    const double cosine = glm::dot(r, l.direction);
    if (cosine <= 0) continue;
    const double nh2 = (1 + cosine) / 2, t = nh2 * (alpha2 - 1) + 1, weight = alpha2 / (kPi * t * t) * cosine;
    sum += weight * l.light;
    weights += weight * l.solidAngle;
  }
  return sum / weights;
}

// Root mean square over some texels of each face, over their mean.
double errorOf(const std::vector<Texel>& texels, const engine::PrefilteredEnvironment& chain, int level) {
  const post::EnvironmentChain view = chain.view();
  const int side = view.sizes[level], row = side + 2;
  const engine::EnvironmentProjector p{Projection::Cube, side, side};
  double squares = 0, mean = 0, count = 0;
  for (int face = 0; face < 6; ++face)
    for (int k = 0; k < 6; ++k) {
      const int x = (5 * k + 3) * side / 32, y = (11 * k + 7) % 32 * side / 32;
      const glm::dvec3 expected = integrated(texels, p.directionAt({face, x + 0.5, y + 0.5}), level / 8.0);
      const glm::dvec3 found(view.texels[size_t(view.first(level) + (face * row + y + 1) * row + x + 1)]);
      squares += glm::dot(found - expected, found - expected);
      mean += expected.x + expected.y + expected.z;
      count += 3;
    }
  return std::sqrt(squares / count) / (mean / count);
}

}  // namespace

TEST_CASE("prefiltered environment: each level errs by less than 1 % against direct integration, with a broad and with a glaring sun") {
  raster::Parallel parallel(2);
  for (const auto& radiance : {sunny, glaring}) {
    const EnvironmentMap cube = cubeOf(128, radiance);
    const std::vector<Texel> texels = texelsOf(cube);
    const engine::PrefilteredEnvironment chain = prefiltered(cube, parallel);
    for (int level = 1; level < post::kRoughnessLevels; ++level) {
      CAPTURE(level);
      CHECK(errorOf(texels, chain, level) < 0.01);
    }
  }
}

TEST_CASE("prefiltered environment: what is white stays white at every level, however small the map") {
  raster::Parallel parallel(2);
  for (int side : {1, 3, 40}) {
    const engine::PrefilteredEnvironment chain = prefiltered(cubeOf(side, [](const glm::dvec3&) { return glm::dvec3(1, 0.5, 0); }), parallel);
    REQUIRE(chain.hasReflections());
    size_t wrong = 0;
    for (const glm::vec3& t : chain.texels) wrong += !(std::fabs(t.x - 1) < 1e-5f && std::fabs(t.y - 0.5f) < 1e-5f && t.z == 0);
    CHECK(wrong == 0);
  }
}

TEST_CASE("prefiltered environment: level 0 is the cube, the sun's reflection gets wider and darker level by level") {
  raster::Parallel parallel(2);
  const EnvironmentMap cube = cubeOf(50, sunny);
  const engine::PrefilteredEnvironment chain = prefiltered(cube, parallel);
  const post::EnvironmentChain view = chain.view();
  REQUIRE(view.sizes[0] == 50);
  CHECK(std::equal(cube.texels().begin(), cube.texels().end(), view.texels.begin()));
  CHECK(view.first(8) + 6 * (view.sizes[8] + 2) * (view.sizes[8] + 2) == int(view.texels.size()));
  float last = 31;
  for (int level = 1; level < post::kRoughnessLevels; ++level) {
    const glm::vec3* first = view.texels.begin() + view.first(level);
    const float brightest = std::max_element(first, first + 6 * (view.sizes[level] + 2) * (view.sizes[level] + 2), [](auto& a, auto& b) { return a.x < b.x; })->x;
    CHECK(brightest < last);
    last = brightest;
  }
  CHECK(last < 2);
}

TEST_CASE("prefiltered environment: levels have no seams, as their borders continue the faces beside") {
  raster::Parallel parallel(2);
  const engine::PrefilteredEnvironment chain = prefiltered(cubeOf(50, sunny), parallel);
  const post::EnvironmentChain view = chain.view();
  for (int level = 1; level < post::kRoughnessLevels; ++level) {
    const int n = view.sizes[level], row = n + 2;
    const auto at = [&](int face, int x, int y) { return view.texels[size_t(view.first(level) + (face * row + y + 1) * row + x + 1)]; };
    for (int y = 0; y < n; ++y) CHECK(at(5, n, y) == at(0, 0, y));  // right of -z is +x
    for (int x = 0; x < n; ++x) CHECK(at(5, x, -1) == at(2, x, n - 1));  // above -z is +y
  }
}

TEST_CASE("prefiltered environment: the same bits with any number of threads") {
  const EnvironmentMap cube = cubeOf(30, glaring);
  raster::Parallel one(1);
  const engine::PrefilteredEnvironment expected = prefiltered(cube, one);
  for (int threads : {2, 5}) {
    raster::Parallel parallel(threads);
    CHECK(prefiltered(cube, parallel).texels == expected.texels);
  }
}
