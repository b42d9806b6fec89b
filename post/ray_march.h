// In:  the rays of a frame.
// Out: how each is followed through the depth map (Estimator::March).
//
// The papers test one point of a ray, or m, each by itself: inside exactly when bias < z - z* < R. Two things are wrong with
// several of them. Near points lie behind the stairs that the nearest texels make of a slanted surface, their own. And all that
// is seen is taken to be R deep for each of them, though a ray that comes from the free side needs no such depth to be stopped:
// only as much as it goes from one point to the next. So here a point is inside exactly when
//   0 < z - z* < t                  it lies behind what is seen there, in a shell of thickness t, and
//   N . (q - x) > bias              q, the point seen at the texel's centre, stands above the tangent plane of the pixel's x.
// With r the length of the ray, r / m from one test point to the next and u a number in [0, 1) that is another for each ray,
//   t = (kShell R + kShellOfGap r / m) (1 + kShellSpread (2 u - 1)).
// The spread makes the shell's edge soft: what lies t0 behind counts for as large a part of the rays as it is likely to stop
// them. The test points x + o (k - kEarly (1 - u)) / m, k = 1 ... m, o the ray's end, are out of step with one another, which
// turns bands into noise that the filter takes away. Behind the second layer the shell is kShell R (1 + kShellSpread (2 u - 1))
// thick. Without the silhouettes' bound both are endless. Constants: docs/accuracy.md.
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "obscura/post/settings.h"

namespace obscura::post {

constexpr float kShell = 0.4f, kShellOfGap = 2, kShellSpread = 0.8f, kEarly = 0.5f;

struct RayMarch {
  float early;          // kEarly (1 - u)
  float shell, shell2;  // t, and that behind the second layer; infinite without the silhouettes' bound
};

// offsets: transferSamples(settings), 16 n; one for each. u = i (sqrt(5) - 1) / 2 mod 1, i the offset's index.
std::vector<RayMarch> rayMarches(const AmbientSettings& settings, const std::vector<glm::vec3>& offsets);

}  // namespace obscura::post
