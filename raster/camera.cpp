#include "obscura/raster/camera.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "obscura/raster/exact_math.h"

namespace obscura::raster {

Camera perspective(double yFov, double aspect, double zNear, double zFar) {
  Camera c;
  const double yScale = 1.0 / exactTan(yFov * 0.5);
  c.xScale = float(yScale / aspect);
  c.yScale = float(yScale);
  c.zNear = float(zNear);
  c.zFar = float(zFar);
  return c;
}

Camera orthographic(double xMag, double yMag, double zNear, double zFar) {
  Camera c;
  c.projection = Projection::Orthographic;
  c.xScale = float(1.0 / xMag);
  c.yScale = float(1.0 / yMag);
  c.zNear = float(zNear);
  c.zFar = float(zFar);
  return c;
}

glm::dmat4 lookAt(glm::dvec3 eye, glm::dvec3 target, glm::dvec3 up) {
  auto unit = [](glm::dvec3 v, glm::dvec3 otherwise) {
    const double l = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    return l > 0 ? v / l : otherwise;
  };
  const glm::dvec3 back = unit(eye - target, {0, 0, 1});
  const glm::dvec3 spare = std::fabs(back.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, -1);
  glm::dvec3 right = glm::cross(unit(up, spare), back);
  const double length = std::sqrt(glm::dot(right, right));
  right = length > 1e-9 ? right / length : unit(glm::cross(spare, back), {1, 0, 0});
  const glm::dvec3 trueUp = glm::cross(back, right);
  // Rows of the rotation are the axes; GLM's matrices are indexed column first.
  glm::dmat4 m(1.0);
  const glm::dvec3 axes[3] = {right, trueUp, back};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) m[c][r] = axes[r][c];
    m[3][r] = -(axes[r].x * eye.x + axes[r].y * eye.y + axes[r].z * eye.z);
  }
  return m;
}

}  // namespace obscura::raster
