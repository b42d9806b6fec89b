// How the constants of sample_sets.cpp are made. Part of obscura-make-sample-sets and of the test that regenerates
// them, not of the library. Integers throughout, but for the comparison of candidates: + - * / on doubles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace obscura::post {

// One sample of a set of n: (xi_x, xi_y, xi_z) = (x / 65536, (yRank + 1/2) / n, (zRank + 1/2) / n).
struct SamplePoint {
  uint16_t x;
  uint8_t yRank, zRank;
};

// In: n, 1 ... 64.  Out: n points, ordered by zRank.
// Each of several seeded candidates is a Poisson-disc set in the toroidal unit cube, relaxed by Lloyd's iteration.
// A relaxed set of few points tends to a lattice whose projections coincide, so that it would see only two or three
// elevations or distances; hence xi_y and xi_z are then replaced by their ranks, as evenly spread as n values can
// be, which moves them by little. xi_x stays. As the 16 rotations of the pixel pattern spread xi_x, what is left of the
// error is that of the pairs (xi_y, xi_z): of the candidates that keep at least 80 % of the largest minimal distance,
// the one whose pairs have the lowest L2 star discrepancy is taken.
std::vector<SamplePoint> makeSampleSet(int n);

// Smallest toroidal distance between two points, squared; the unit is the cube's side. 3 for a single point.
double minimalDistanceSquared(const std::vector<SamplePoint>& set);

// L2 star discrepancy, squared, of the projection (xi_y, xi_z).
double starDiscrepancy(const std::vector<SamplePoint>& set);

// Out: which of the 16 angles 2 pi j / 16 the pixel (i mod 4, i / 4) of the repeated 4x4 pattern takes; each once.
// Neighbouring pixels differ most: an exhaustive search maximises the smallest circular distance between the angles of
// pixels that share an edge (4 steps: 90 degrees), then of pixels that share only a corner (2 steps), then the sum of
// all these distances, those across an edge counted twice; of equals it takes the first in dictionary order.
std::array<uint8_t, 16> makeRotationPattern();

}  // namespace obscura::post
