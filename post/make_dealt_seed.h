// How the seeds of boxSeed() are found. Part of obscura-make-sample-sets and of the test that repeats the search, not of
// the library. + - * / sqrt on doubles, and raster::exactCos: the same seeds on every machine.
#pragma once

#include <cstdint>

namespace obscura::post {

// In: n, 1 ... 64.  Out: of the seeds 0 ... 4096 / n - 1 the one with the least error, see dealtError.
uint32_t makeBoxSeed(int n);

// Mean over 128 planes of 16 e16^2 + 4 e4^2 + e1^2. A plane cuts the ball of radius R around a pixel at random; e is the
// difference between the share of test points behind it (linear membership) and the right one: of the whole 4x4 pattern,
// of an aligned quad of pixels, of a single pixel, averaged over all there are. The filter adds up whole patterns on
// smooth ground, and parts of them at edges. The weights are those by which the errors of random points would be equal.
double dealtError(int n, uint32_t seed);

}  // namespace obscura::post
