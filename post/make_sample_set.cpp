#include "obscura/post/make_sample_set.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>

namespace obscura::post {
namespace {

// Coordinates are multiples of 2^-16, so that the torus is the wrap-around of 16-bit integers.
struct Point {
  uint16_t c[3];
};

constexpr int kTestPointsPerSample = 64;   // that stand for the volume in Lloyd's iteration
constexpr int kLloydSteps = 8;             // more of them turn the sets into lattices
constexpr int kCandidates = 512;           // shared out: 512 / n for a set of n, which is 8 or more

struct Random {  // SplitMix64
  uint64_t state;
  uint64_t next() {
    uint64_t z = state += 0x9E3779B97F4A7C15ull;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
  }
};

int wrappedDifference(uint16_t a, uint16_t b) { return int16_t(uint16_t(a - b)); }

uint32_t distanceSquared(const Point& a, const Point& b) {  // at most 3 2^30
  uint32_t sum = 0;
  for (int k = 0; k < 3; ++k) {
    const int d = wrappedDifference(a.c[k], b.c[k]);
    sum += uint32_t(d * d);
  }
  return sum;
}

// Darts are thrown at the cube and kept where they are far enough from all others; the distance asked for starts at
// the largest there is and shrinks after 32 misses in a row.
std::vector<Point> throwDarts(int n, Random& random) {
  std::vector<Point> points;
  uint64_t radiusSquared = 3ull << 30;
  int misses = 0;
  while (int(points.size()) < n) {
    const uint64_t bits = random.next();
    const Point p{{uint16_t(bits), uint16_t(bits >> 16), uint16_t(bits >> 32)}};
    const bool free = std::all_of(points.begin(), points.end(),
                                  [&](const Point& q) { return distanceSquared(p, q) >= radiusSquared; });
    if (free) points.push_back(p);
    misses = free ? 0 : misses + 1;
    if (misses == 32) {
      radiusSquared -= radiusSquared / 16;
      misses = 0;
    }
  }
  return points;
}

// An even filling of the cube: the additive recurrence whose steps are the powers of 1 / 1.2207..., the root of
// g^4 = g + 1 (Roberts), as fractions of 2^32.
std::vector<Point> testPoints(int count) {
  std::vector<Point> points(static_cast<size_t>(count));
  for (uint32_t i = 0; i < uint32_t(count); ++i) {
    const uint32_t k = i + 1;
    points[i] = {{uint16_t(k * 0xD1B54A33u >> 16), uint16_t(k * 0xABC98389u >> 16), uint16_t(k * 0x8CB92BA7u >> 16)}};
  }
  return points;
}

// Every sample moves to the centroid of its Voronoi cell, that is of the test points it is nearest to.
void lloydStep(std::vector<Point>& samples, const std::vector<Point>& volume) {
  struct Cell {
    int64_t sum[3] = {0, 0, 0};
    int64_t count = 0;
  };
  std::vector<Cell> cells(samples.size());
  for (const Point& v : volume) {
    uint64_t best = ~0ull;  // distance, then index: ties go to the first
    for (size_t i = 0; i < samples.size(); ++i)
      best = std::min(best, (uint64_t(distanceSquared(v, samples[i])) << 8) | i);
    Cell& cell = cells[best & 0xFF];
    for (int k = 0; k < 3; ++k) cell.sum[k] += wrappedDifference(v.c[k], samples[best & 0xFF].c[k]);
    ++cell.count;
  }
  for (size_t i = 0; i < samples.size(); ++i)
    for (int k = 0; k < 3 && cells[i].count > 0; ++k)
      samples[i].c[k] = uint16_t(samples[i].c[k] + cells[i].sum[k] / cells[i].count);
}

std::vector<uint8_t> ranks(const std::vector<Point>& points, int axis) {
  std::vector<uint8_t> order(points.size()), rank(points.size());
  std::iota(order.begin(), order.end(), uint8_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](uint8_t a, uint8_t b) { return points[a].c[axis] < points[b].c[axis]; });
  for (size_t i = 0; i < order.size(); ++i) rank[order[i]] = uint8_t(i);
  return rank;
}

std::vector<SamplePoint> withRanks(const std::vector<Point>& points) {
  const std::vector<uint8_t> y = ranks(points, 1), z = ranks(points, 2);
  std::vector<SamplePoint> set(points.size());
  for (size_t i = 0; i < points.size(); ++i) set[z[i]] = {points[i].c[0], y[i], z[i]};
  return set;
}

// Distances along the axes between two samples, each 0 ... 1/2.
std::array<double, 3> wrappedDistances(const SamplePoint& a, const SamplePoint& b, size_t n) {
  const auto wrap = [](int d, int period) { return double(std::min(std::abs(d), period - std::abs(d))) / period; };
  return {wrap(a.x - b.x, 65536), wrap(a.yRank - b.yRank, int(n)), wrap(a.zRank - b.zRank, int(n))};
}

// Backtracking over the pixels of the pattern in reading order, angles in ascending order.
struct PatternSearch {
  int edgeMin, cornerMin;  // circular distances asked for between pixels that share an edge, or only a corner
  std::array<uint8_t, 16> pattern{}, best{};
  uint32_t used = 0;
  int bestSum = -1;

  static int distance(int a, int b) { return std::min(std::abs(a - b), 16 - std::abs(a - b)); }
  static int neighbour(int i, int dx, int dy) { return ((i + dx) & 3) + 4 * ((i / 4 + dy + 4) & 3); }

  bool fits(int i, int angle) const {
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const int j = neighbour(i, dx, dy);
        if (j < i && distance(angle, pattern[size_t(j)]) < (dx == 0 || dy == 0 ? edgeMin : cornerMin)) return false;
      }
    return true;
  }

  int sum() const {
    int total = 0;
    for (int i = 0; i < 16; ++i)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
          total += distance(pattern[size_t(i)], pattern[size_t(neighbour(i, dx, dy))]) * (dx == 0 || dy == 0 ? 2 : 1);
    return total;
  }

  void place(int i) {
    if (i == 16) {
      if (const int total = sum(); total > bestSum) {
        bestSum = total;
        best = pattern;
      }
      return;
    }
    for (int angle = 0; angle < (i == 0 ? 1 : 16); ++angle)  // turning all angles changes nothing: the first is 0
      if (!(used >> angle & 1) && fits(i, angle)) {
        used ^= 1u << angle;
        pattern[size_t(i)] = uint8_t(angle);
        place(i + 1);
        used ^= 1u << angle;
      }
  }
};

}  // namespace

double minimalDistanceSquared(const std::vector<SamplePoint>& set) {
  double best = 3;
  for (size_t i = 0; i < set.size(); ++i)
    for (size_t j = 0; j < i; ++j) {
      const auto d = wrappedDistances(set[i], set[j], set.size());
      best = std::min(best, d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    }
  return best;
}

double starDiscrepancy(const std::vector<SamplePoint>& set) {
  const double n = double(set.size());
  double single = 0, pairs = 0;  // Warnock's formula
  for (const SamplePoint& a : set) {
    const double y = (a.yRank + 0.5) / n, z = (a.zRank + 0.5) / n;
    single += (1 - y * y) * (1 - z * z) / 4;
    for (const SamplePoint& b : set)
      pairs += (1 - std::max(y, (b.yRank + 0.5) / n)) * (1 - std::max(z, (b.zRank + 0.5) / n));
  }
  return 1.0 / 9 - 2 * single / n + pairs / (n * n);
}

std::vector<SamplePoint> makeSampleSet(int n) {
  const std::vector<Point> volume = testPoints(n * kTestPointsPerSample);
  std::vector<std::vector<SamplePoint>> candidates;
  double largestDistance = 0;
  for (int c = 0; c < kCandidates / n; ++c) {
    Random random{uint64_t(n) << 32 | uint64_t(c)};
    std::vector<Point> points = throwDarts(n, random);
    for (int step = 0; step < kLloydSteps; ++step) lloydStep(points, volume);
    candidates.push_back(withRanks(points));
    largestDistance = std::max(largestDistance, minimalDistanceSquared(candidates.back()));
  }
  const std::vector<SamplePoint>* best = nullptr;
  for (const auto& set : candidates)
    if (minimalDistanceSquared(set) >= 0.64 * largestDistance)
      if (!best || starDiscrepancy(set) < starDiscrepancy(*best)) best = &set;
  return *best;
}

std::array<uint8_t, 16> makeRotationPattern() {
  for (int edgeMin = 8;; --edgeMin)
    for (int cornerMin = edgeMin; cornerMin >= 1; --cornerMin) {
      PatternSearch search{edgeMin, cornerMin};
      search.place(0);
      if (search.bestSum >= 0) return search.best;
    }
}

}  // namespace obscura::post
