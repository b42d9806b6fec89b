// Between camera space and pixels, for the passes that look back into the depth map.
#pragma once

#include <optional>

#include "obscura/raster/camera.h"

namespace obscura::post {

// The papers' camera space: x right, y up, z away from the eye. Pixel of a point in the camera's image (floor of these
// coordinates):
//   perspective   u = (x / z) xScale + xCenter,   v = (y / z) yScale + yCenter       (yScale < 0: v points down)
//   orthographic  the same without the division
struct Projector {
  bool perspective = true;
  int xFirst = 0, yFirst = 0;  // where the G-buffer's pixel (0, 0) lies in the image
  int width = 0, height = 0;   // of the G-buffer
  float xScale = 1, yScale = -1, xCenter = 0, yCenter = 0;  // pixels
  float xInverse = 1, yInverse = -1;                        // 1 / scale
  float zNear = 0;
};

// width, height: of the camera's image; the G-buffer is the window of it, without one the whole.
inline Projector makeProjector(const raster::Camera& c, int width, int height, const std::optional<raster::Window>& window = {}) {
  const raster::Window w = window.value_or(raster::Window{0, 0, width, height});
  Projector p;
  p.perspective = c.projection == raster::Projection::Perspective;
  p.xFirst = w.x;
  p.yFirst = w.y;
  p.width = w.width;
  p.height = w.height;
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
