#include "obscura/post/sample_sets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <set>
#include <vector>

#include <catch2/catch.hpp>

#include "obscura/post/make_sample_set.h"
#include "obscura/raster/exact_math.h"

using namespace obscura;
using post::kMaxSamples;
using post::rotationOrder;
using post::rotations;
using post::sampleSet;

namespace {

constexpr double kPi = 3.14159265358979323846;

// All sets take a second when optimised; unoptimised and sanitized builds regenerate those up to 16, and 32.
#if defined(__OPTIMIZE__) && !defined(__SANITIZE_ADDRESS__)
#define OBSCURA_FAST_BUILD 1
#endif
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#undef OBSCURA_FAST_BUILD
#endif
#endif
bool regenerated(int n) {
#ifdef OBSCURA_FAST_BUILD
  return n <= kMaxSamples;
#else
  return n <= 16 || n == 32;
#endif
}

double wrapped(double d) {
  d = std::fabs(d);
  return std::min(d, 1 - d);
}

double smallestDistance(raster::Span<const glm::vec3> set) {
  double best = 3;
  for (size_t i = 0; i < set.size(); ++i)
    for (size_t j = 0; j < i; ++j) {
      const glm::vec3 d = set[i] - set[j];
      best = std::min(best, wrapped(d.x) * wrapped(d.x) + wrapped(d.y) * wrapped(d.y) + wrapped(d.z) * wrapped(d.z));
    }
  return std::sqrt(best);
}

// Mean of f(w, r) over a set and the 16 rotations: w = (sqrt(xi_y) cos, sqrt(xi_y) sin, sqrt(1 - xi_y)), r = xi_z.
template <class F>
double quadrature(int n, F f) {
  double sum = 0;
  for (const glm::vec3& xi : sampleSet(n))
    for (const glm::vec2& turn : rotations()) {
      const double azimuth = 2 * kPi * xi.x, c = std::cos(azimuth), s = std::sin(azimuth), sine = std::sqrt(xi.y);
      sum += f((c * turn.x - s * turn.y) * sine, (c * turn.y + s * turn.x) * sine, std::sqrt(1 - xi.y), double(xi.z));
    }
  return sum / (16.0 * n);
}

}  // namespace

TEST_CASE("sample sets: the constants are what the generator makes") {
  for (int n = 1; n <= kMaxSamples; ++n) {
    if (!regenerated(n)) continue;
    const std::vector<post::SamplePoint> made = post::makeSampleSet(n);
    const auto set = sampleSet(n);
    REQUIRE(set.size() == made.size());
    for (size_t i = 0; i < made.size(); ++i) {
      INFO("set of " << n << ", point " << i);
      REQUIRE(set[i].x == float(made[i].x / 65536.0));
      REQUIRE(set[i].y == float((made[i].yRank + 0.5) / n));
      REQUIRE(set[i].z == float((made[i].zRank + 0.5) / n));
    }
  }
  CHECK(rotationOrder() == post::makeRotationPattern());
}

TEST_CASE("sample sets: there is one of every size from 1 to 64, and none of another size") {
  for (int n = 1; n <= kMaxSamples; ++n) CHECK(sampleSet(n).size() == size_t(n));
  for (int n : {-1, 0, kMaxSamples + 1, 1 << 30}) CHECK(sampleSet(n).empty());
}

TEST_CASE("sample sets: values lie from 0 to below 1, the projections on xi_y and xi_z are evenly spread with mean 1/2") {
  for (int n = 1; n <= kMaxSamples; ++n) {
    INFO("set of " << n);
    std::set<float> ys, zs;
    double meanY = 0, meanZ = 0;
    for (const glm::vec3& xi : sampleSet(n)) {
      for (float v : {xi.x, xi.y, xi.z}) REQUIRE((v >= 0 && v < 1));
      ys.insert(xi.y);
      zs.insert(xi.z);
      meanY += double(xi.y) / n;
      meanZ += double(xi.z) / n;
    }
    CHECK(ys.size() == size_t(n));
    CHECK(zs.size() == size_t(n));
    CHECK(std::fabs(meanY - 0.5) < 1e-7);
    CHECK(std::fabs(meanZ - 0.5) < 1e-7);
  }
}

TEST_CASE("sample sets: points keep a distance of 0.65 / cbrt(n) on the torus") {
  for (int n = 2; n <= kMaxSamples; ++n) {
    INFO("set of " << n);
    CHECK(smallestDistance(sampleSet(n)) >= 0.65 / std::cbrt(n));
  }
}

TEST_CASE("sample sets: the cosine-weighted quadrature converges to the closed form") {
  // Openness of a plane tilted by t against the normal, (1 + cos t) / 2.
  const auto tilted = [](double t) {
    return [t](double x, double, double z, double) { return x * std::sin(t) + z * std::cos(t) >= 0 ? 1.0 : 0.0; };
  };
  for (double t : {0.3, 0.8, kPi / 2, 2.2}) {
    const double exact = (1 + std::cos(t)) / 2;
    CAPTURE(t);
    CHECK(std::fabs(quadrature(8, tilted(t)) - exact) < 0.05);
    CHECK(std::fabs(quadrature(64, tilted(t)) - exact) < 0.01);
  }
  // A wall at distance h: hit where r w_x > h. Of (1/pi) int int [r w_x > h] cos dw dr what remains is an integral
  // over u = w_x, whose density under the cosine distribution is (2/pi) sqrt(1 - u^2).
  for (double h : {0.1, 0.3, 0.6}) {
    double exact = 0;
    for (int i = 0; i < 4000; ++i) {
      const double u = h + (1 - h) * (i + 0.5) / 4000;
      exact += 2 / kPi * std::sqrt(1 - u * u) * (1 - h / u) * (1 - h) / 4000;
    }
    CAPTURE(h, exact);
    const auto wall = [h](double x, double, double, double r) { return r * x > h ? 1.0 : 0.0; };
    CHECK(std::fabs(quadrature(8, wall) - exact) < 0.03);
    CHECK(std::fabs(quadrature(64, wall) - exact) < 0.01);
  }
  CHECK(std::fabs(quadrature(64, [](double, double, double z, double) { return z; }) - 2.0 / 3) < 1e-3);
  CHECK(std::fabs(quadrature(64, [](double x, double y, double, double) { return x * x - y * y; })) < 1e-6);
}

TEST_CASE("rotations: any 4x4 window of the repeated pattern holds each of the 16 angles once") {
  for (int y0 = 0; y0 < 4; ++y0)
    for (int x0 = 0; x0 < 4; ++x0) {
      std::set<int> seen;
      for (int y = y0; y < y0 + 4; ++y)
        for (int x = x0; x < x0 + 4; ++x) seen.insert(rotationOrder()[size_t((x & 3) + 4 * (y & 3))]);
      CHECK(seen.size() == 16);
      CHECK(*seen.rbegin() == 15);
    }
}

TEST_CASE("rotations: neighbouring pixels differ by 90 degrees, diagonal ones by 45, or more") {
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x)
      for (const auto& offset : {std::array{1, 0, 4}, std::array{0, 1, 4}, std::array{1, 1, 2}, std::array{3, 1, 2}}) {
        const int a = rotationOrder()[size_t(x + 4 * y)];
        const int b = rotationOrder()[size_t(((x + offset[0]) & 3) + 4 * ((y + offset[1]) & 3))];
        CHECK(std::min(std::abs(a - b), 16 - std::abs(a - b)) >= offset[2]);
      }
}

TEST_CASE("rotations: the pairs are cosine and sine of the angles, to the last bit of a float") {
  for (size_t i = 0; i < 16; ++i) {
    const double angle = 2 * kPi * rotationOrder()[i] / 16;
    CHECK(std::fabs(rotations()[i].x - raster::exactCos(angle)) <= 0x1p-25);
    CHECK(std::fabs(rotations()[i].y - raster::exactSin(angle)) <= 0x1p-25);
  }
  CHECK(rotations()[0] == glm::vec2(1, 0));
}
