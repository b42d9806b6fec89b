// In: a block of pixels, a light.  Out: false where the light certainly adds nothing to any of them.
#pragma once

#include <glm/vec3.hpp>

#include "obscura/post/punctual_light.h"

namespace obscura::post {

struct ReachedBall {
  glm::dvec3 center{0};  // camera space
  double radius = 0;
};

// Around what is seen at depths nearest ... farthest in the pixels x0 ... x1 - 1, y0 ... y1 - 1.
ReachedBall ballAround(const Projector& projector, int x0, int x1, int y0, int y1, float nearest, float farthest);

// By range and cone; generous by more than directLight() rounds.
bool mayReach(const PunctualLight& light, const ReachedBall& ball);

}  // namespace obscura::post
