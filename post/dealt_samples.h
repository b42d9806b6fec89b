// Sample points that differ from pixel to pixel: one set of 16 n points, dealt to the 16 pixels of the 4x4 pattern.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace obscura::post {

// 16 n points (xi_x, xi_y, xi_z) in [0, 1), multiples of 2^-16 plus 2^-17; what they mean: sampleSet. The pixel (x, y)
// has the points [p n, p n + n), p = (x mod 4) + 4 (y mod 4). n outside 1 ... kMaxSamples: empty.
//
// They are the first 16 n points of Sobol's sequence (Sobol 1967; direction numbers of Joe and Kuo 2008, first three
// dimensions), each coordinate scrambled as Owen (1995) does: every bit is flipped or not by a hash of the seed and of
// the bits above it. xi_y and xi_z, whose pairs decide over most of the error, take the first two dimensions, xi_x the
// third. Consecutive blocks of n points go to the pixels in Z order: where n is a power of two, the points of a pixel,
// of each aligned quad of pixels and of the whole pattern are nets, each evenly spread by itself.
//
// Integers throughout: made when a frame needs them, in less time than constants of this size would take to read from
// disk (n = 8: some 20 us), and no n is left without a set.
std::vector<glm::vec3> dealtSamples(int n, uint32_t seed);

// The seed whose set of 16 n points errs least over a 4x4 box: found offline (make_dealt_seed.h). n in 1 ... kMaxSamples.
uint32_t boxSeed(int n);

}  // namespace obscura::post
