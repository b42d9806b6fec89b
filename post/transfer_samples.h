// In: settings.  Out: the constant array of the shader, (X, Y, Z)_i = w_i r_i times R (long paper, equation 8), or the 16
//     arrays of its 4x4 pattern.
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "obscura/post/settings.h"

namespace obscura::post {

// Offsets in the frame (T, B, N), scene units: with (xi_x, xi_y, xi_z) of the sample set,
//   w = T cos(2 pi xi_x) sqrt(xi_y) + B sin(2 pi xi_x) sqrt(xi_y) + N sqrt(1 - xi_y),   r = mu^-1(xi_z) in [0, R].
// Estimator::Paper: n, for all pixels. Otherwise 16 n: those of the pixel (x, y) are [p n, p n + n), p = (x mod 4) +
// 4 (y mod 4); without interleaving all pixels have those of p = 0. Estimator::Lines: see lineSamples.
std::vector<glm::vec3> transferSamples(const AmbientSettings& settings);

// mu^-1(xi) / R, xi in [0, 1): the distance that importance sampling draws.
double inverseMembership(Membership membership, double xi);

// mu(d) for d in units of R.
double membershipOf(Membership membership, double d);

}  // namespace obscura::post
