// Between camera space and pixels, for the passes that look back into the depth map.
#pragma once

#include "obscura/raster/camera.h"

namespace obscura::post {

// The papers' camera space: x right, y up, z away from the eye. Pixel of a point (floor of these coordinates):
//   perspective   u = (x / z) xScale + xCenter,   v = (y / z) yScale + yCenter       (yScale < 0: v points down)
//   orthographic  the same without the division
struct Projector {
  bool perspective = true;
  int width = 0, height = 0;
  float xScale = 1, yScale = -1, xCenter = 0, yCenter = 0;  // pixels
  float xInverse = 1, yInverse = -1;                        // 1 / scale
  float zNear = 0;
};

inline Projector makeProjector(const raster::Camera& c, int width, int height) {
  Projector p;
  p.perspective = c.projection == raster::Projection::Perspective;
  p.width = width;
  p.height = height;
  const float xHalf = float(width) * 0.5f, yHalf = float(height) * 0.5f;
  p.xScale = c.xScale * xHalf;
  p.yScale = -(c.yScale * yHalf);
  p.xCenter = xHalf + c.xShift * xHalf;
  p.yCenter = yHalf - c.yShift * yHalf;
  p.xInverse = 1.0f / p.xScale;
  p.yInverse = 1.0f / p.yScale;
  p.zNear = c.zNear;
  return p;
}

}  // namespace obscura::post
