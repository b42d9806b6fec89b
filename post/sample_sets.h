// The quasi-random constants of the ambient transfer pass: sample sets and interleaving rotations.
// Made offline (post/make_sample_set.h says how) and compiled in; nothing is computed at start-up.
#pragma once

#include <array>
#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "obscura/raster/span.h"

namespace obscura::post {

constexpr int kMaxSamples = 64;

// Set of n points (xi_x, xi_y, xi_z), each in [0, 1): a relaxed Poisson-disc set in the toroidal unit cube whose xi_y,
// and whose xi_z, are the numbers (k + 1/2) / n, k = 0 ... n-1, each once; ascending in xi_z. xi_x is the azimuth
// in turns, 1 - xi_y the squared cosine to the normal, xi_z the membership at the distance to test.
// n outside 1 ... kMaxSamples: empty.
raster::Span<const glm::vec3> sampleSet(int n);

// The pixel (x, y) turns the set by the angle 2 pi j / 16, j = rotationOrder()[(x mod 4) + 4 (y mod 4)]. Each j
// appears once, hence once in every 4x4 window; pixels that share an edge differ by 90 degrees or more.
const std::array<uint8_t, 16>& rotationOrder();

// (cos, sin) of these angles, in the same order.
const std::array<glm::vec2, 16>& rotations();

}  // namespace obscura::post
