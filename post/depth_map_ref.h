// What the scalar twins share: the texel of the depth map that a point is compared with.
#pragma once

#include <cmath>

#include <glm/vec3.hpp>

#include "obscura/post/projector.h"

namespace obscura::post {

struct Texel {
  int x, y;
};

// scPos -> ssPos: the nearest texel of the depth map, clamped at its edges.
inline Texel project(const Projector& p, const glm::vec3& point) {
  const float inverse = p.perspective ? 1 / point.z : 1;
  const float u = std::floor(point.x * inverse * p.xScale + p.xCenter), v = std::floor(point.y * inverse * p.yScale + p.yCenter);
  auto clamp = [](float c, int first, int size) {
    const int end = first + size;
    return (c > float(first) ? (c < float(end) ? int(c) : end - 1) : first) - first;
  };
  return {clamp(u, p.xFirst, p.width), clamp(v, p.yFirst, p.height)};
}

}  // namespace obscura::post
