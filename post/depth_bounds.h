// In:  depth of the G-buffer.
// Out: per cell of pixels a plane behind which all of its depths lie. With these planes the ambient transfer knows of
//      open ground that it is open, and does not sample it.
#pragma once

#include "obscura/post/projector.h"
#include "obscura/raster/gbuffer.h"
#include "obscura/raster/target.h"

namespace obscura::post {

// Inverse depth of a plane in space is linear in pixel coordinates (u, v), and so is the depth itself if the projection
// is orthographic. For the texels of a cell, (u, v) their centres,
//   perspective   1 / z <= a u + b v + c,          orthographic   -z <= a u + b v + c.
// Empty texels and NaN, which no test finds anything in, do not count: c is -infinity where there are no others.
// c is infinity, and says nothing, where some depth is not positive. a and b are finite.
struct DepthBounds {
  static constexpr int kCellWidth = 16, kCellHeight = 8;  // pixels
  raster::Plane<float> a, b, c;    // one element a cell
  raster::Plane<float> nearest;    // smallest depth of the cell that counts; infinity if there is none
};

DepthBounds makeDepthBounds(int width, int height, DepthBounds used = {});  // pixels

// Rows row0 ... row1 - 1 of cells. Perspective or not is all that it needs of the projector.
void boundDepth(const raster::GBuffer& g, const Projector& projector, int row0, int row1, DepthBounds& out,
                raster::Target target);

}  // namespace obscura::post
