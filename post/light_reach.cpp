#include "obscura/post/light_reach.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace obscura::post {

ReachedBall ballAround(const Projector& p, int x0, int x1, int y0, int y1, float nearest, float farthest) {
  const double x[] = {(double(p.xFirst + x0) - double(p.xCenter)) * double(p.xInverse), (double(p.xFirst + x1) - double(p.xCenter)) * double(p.xInverse)};
  const double y[] = {(double(p.yFirst + y0) - double(p.yCenter)) * double(p.yInverse), (double(p.yFirst + y1) - double(p.yCenter)) * double(p.yInverse)};
  glm::dvec3 lo(1e300), hi(-1e300);
  for (int corner = 0; corner < 8; ++corner) {
    const double z = double(corner & 4 ? farthest : nearest), w = p.perspective ? z : 1;
    const glm::dvec3 at(x[corner & 1] * w, y[corner >> 1 & 1] * w, -z);
    for (int c = 0; c < 3; ++c) lo[c] = std::min(lo[c], at[c]), hi[c] = std::max(hi[c], at[c]);
  }
  const glm::dvec3 half = (hi - lo) * 0.5;
  return {lo + half, std::sqrt(glm::dot(half, half))};
}

bool mayReach(const PunctualLight& light, const ReachedBall& ball) {
  if (light.kind == LightKind::Directional) return true;
  const double scale = double(light.worldFromView);
  glm::dvec3 q(light.origin);
  double size = std::fabs(q.x) + std::fabs(q.y) + std::fabs(q.z) + scale * ball.radius;
  for (int c = 0; c < 3; ++c) {
    q += glm::dvec3(light.lightFromView[c]) * ball.center[c];
    size += scale * std::fabs(ball.center[c]);
  }
  // Lengths in light space are those of the view times the scale, at most; 1e-5 of them is far more than rounding.
  const double radius = scale * ball.radius + 1e-5 * size, square = glm::dot(q, q);
  if (light.range > 0 && std::sqrt(square) - radius > double(light.range) * (1 + 1e-5)) return false;
  if (light.kind == LightKind::Point) return true;
  // Outside of the cone by more than the radius, seen in the plane through the axis and the centre.
  const double cosine = -double(light.coneOffset) / double(light.coneScale), sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  const double along = glm::dot(q, glm::dvec3(light.axis)), across = std::sqrt(std::max(0.0, square - along * along));
  return across * cosine - along * sine <= radius + 1e-5 * std::sqrt(square);
}

}  // namespace obscura::post
