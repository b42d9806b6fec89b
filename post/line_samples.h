// In:  depth, normals (and what the occluders send back) of the G-buffer.
// Out: the sums of ambient_transfer.h, by line samples (Estimator::Lines): one look-up decides over all test points of a
//      ray through the eye.
//
// The obscurance with linear membership is an integral over the half ball of radius R around x (long paper, equation 5,
// with d(mu) = dr / R and the containment test I for the visibility):
//     O = int I(p) w(p) dp,   w(p) = N . (p - x) / (pi R |p - x|^3).
// A ray through the eye has one texel, so I is known all along it: inside from z* + bias to z* + R. And w has an integral
// along a ray in closed form. After Szirmay-Kalos, Umenhoffer, Toth, Szecsi, Sbert, "Volumetric ambient occlusion for
// real-time rendering and games" (2010). Differs: they integrate 1 over the tangent sphere, which is another quantity
// (a sixth of the weight at half the distance, and cos^3 instead of cos: 0.03 to 0.05 from O on real scenes); w over the
// ball is O itself, the one that rays estimate.
//
// In units of R: the ray i meets the plane through x across the view axis x / |x| at x + a, a = xi (cos, sin) there, xi in
// [0, 1) uniform; so each ray stands for an area proportional to |a|. With d = (x + a) / z, its direction with z = 1, and
// p - x = a + t d:
//     |p - x|^2 = Q(t) = c t^2 + 2 g t + h,   c = d . d,  g = a . d,  h = a . a,      N . (p - x) = A + B t,
//     int (A + B t) / Q^(3/2) dt = (A (c t + g) - B (g t + h)) / (D sqrt Q),   D = c h - g^2 = h (|x| / z)^2.
// The limits: Q = 1, and A + B t = 0 where N . (p - x) changes its sign. |x| is the same for all rays of a pixel and
// left out, and so is that rays diverge, (1 + t R / z)^2.
//
// With two layers what lies behind the second counts, too, as far as the first has not claimed it.
//
// With total = sum of all integrals and inner = sum of what is inside of them, num = n - n inner / total: exactly n if
// nothing is inside, 0 if all is. den = n - n sum(inner a) / total with a of the ray's texel; W follows as from rays.
// Rays that leave before the near plane count for nothing; if none is left, the pixel is open. steps play no part, all
// points of a ray are tested; the membership is taken to be linear.
#pragma once

#include "obscura/post/ambient_transfer.h"

namespace obscura::post {

// As ambientTransfer, which calls it. offsets: (xi cos, xi sin, 1 / xi), 16 n of them. Samples all that is seen.
TransferStatistics lineSamples(const TransferInput& in, int y0, int y1, TransferSums& out, raster::Target target);
void lineSamplesRef(const TransferInput& in, int y0, int y1, TransferSums& out);  // the scalar twin

}  // namespace obscura::post
