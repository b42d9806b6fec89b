#include "obscura/post/dealt_samples.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include <catch2/catch.hpp>

#include "obscura/post/make_dealt_seed.h"
#include "obscura/post/sample_sets.h"

using namespace obscura;
using post::dealtSamples;
using post::kMaxSamples;

namespace {

// Points of an elementary box of 2^-a by 2^-b by 2^-c, counted in each.
std::vector<int> perBox(const std::vector<glm::vec3>& points, int a, int b, int c) {
  std::vector<int> counts(size_t(1) << (a + b + c));
  for (const glm::vec3& p : points)
    ++counts[(size_t(p.x * float(1 << a)) << b | size_t(p.y * float(1 << b))) << c | size_t(p.z * float(1 << c))];
  return counts;
}

bool allEqual(const std::vector<int>& counts, int value) {
  return std::all_of(counts.begin(), counts.end(), [value](int n) { return n == value; });
}

std::vector<glm::vec3> ofPixels(const std::vector<glm::vec3>& all, int n, std::initializer_list<int> pixels) {
  std::vector<glm::vec3> points;
  for (int p : pixels) points.insert(points.end(), all.begin() + p * n, all.begin() + (p + 1) * n);
  return points;
}

}  // namespace

TEST_CASE("dealt samples: there are 16 n for every n from 1 to 64, all different, from 0 to below 1") {
  for (int n = 1; n <= kMaxSamples; ++n) {
    const std::vector<glm::vec3> points = dealtSamples(n, 5);
    REQUIRE(points.size() == size_t(16 * n));
    for (int axis = 0; axis < 3; ++axis) {
      std::set<float> values;
      for (const glm::vec3& p : points) {
        REQUIRE((p[axis] >= 0 && p[axis] < 1));
        values.insert(p[axis]);
      }
      CHECK(values.size() == points.size());
    }
  }
  for (int n : {-1, 0, kMaxSamples + 1}) CHECK(dealtSamples(n, 5).empty());
}

TEST_CASE("dealt samples: pixels, quads and the whole pattern are nets in elevation and distance, whatever the seed") {
  for (uint32_t seed : {0u, 1u, 77u, 0xFFFFFFFFu})
    for (int m : {0, 1, 2, 3, 6}) {
      const int n = 1 << m;
      const std::vector<glm::vec3> all = dealtSamples(n, seed);
      INFO("n " << n << " seed " << seed);
      for (int b = 0; b <= m + 4; ++b) CHECK(allEqual(perBox(all, 0, b, m + 4 - b), 1));
      for (int corner : {0, 2, 8, 10}) {
        const auto quad = ofPixels(all, n, {corner, corner + 1, corner + 4, corner + 5});
        for (int b = 0; b <= m + 2; ++b) CHECK(allEqual(perBox(quad, 0, b, m + 2 - b), 1));
      }
      for (int p = 0; p < 16; ++p)
        for (int b = 0; b <= m; ++b) CHECK(allEqual(perBox(ofPixels(all, n, {p}), 0, b, m - b), 1));
    }
}

TEST_CASE("dealt samples: every coordinate by itself is evenly spread, and eighths of the cube hold as many points each") {
  for (int m : {0, 2, 4, 6}) {
    const std::vector<glm::vec3> all = dealtSamples(1 << m, 3);
    CHECK(allEqual(perBox(all, m + 4, 0, 0), 1));
    CHECK(allEqual(perBox(all, 1, 1, 1), 2 << m));
  }
}

TEST_CASE("dealt samples: the seeds of the box are what the search finds") {
#ifdef __OPTIMIZE__
  for (int n : {1, 2, 3, 4, 5, 6, 7, 8, 11, 16, 31, 64}) CHECK(post::boxSeed(n) == post::makeBoxSeed(n));
#else
  for (int n : {1, 4, 8}) CHECK(post::boxSeed(n) == post::makeBoxSeed(n));
#endif
}

TEST_CASE("dealt samples: over the box they err less than most scrambles, and than random points by far") {
  for (int n : {4, 8, 16}) {
    const double least = post::dealtError(n, post::boxSeed(n));
    int better = 0;
    for (uint32_t seed = 5000; seed < 5020; ++seed) better += post::dealtError(n, seed) < least;
    CHECK(better == 0);
    CHECK(least < 3 * 0.25 / n / 3);  // three errors of random points, each with a variance of up to 1/4 / n
  }
}
