// In:  the depth keys of the tiles drawn so far.
// Out: what is certainly hidden behind them (hierarchical depth, after Greene, Kass and Miller).
#pragma once

#include "obscura/raster/plane.h"
#include "obscura/raster/target.h"
#include "obscura/raster/tile.h"

namespace obscura::raster {

// Pixels, inclusive, inside the image (empty if x0 > x1 or y0 > y1), and a key that no point of the thing exceeds.
struct ScreenBound {
  int x0 = 0, y0 = 0, x1 = -1, y1 = -1;
  float nearestKey = 0;
};

// The farthest key of every block of pixels. Keys only grow while a frame is drawn, so what is hidden stays hidden:
// hides() tells nothing but the truth about the finished frame, whatever has been drawn by then. A key that equals the
// farthest one is not hidden, since the smaller id wins.
class OcclusionMap {
 public:
  void reset(int width, int height);           // of the image; nothing is hidden
  void update(const TileBuffers& tile, Target target);
  bool hides(const ScreenBound& bound) const;

  const float* farthest() const { return farthest_.data(); }  // of block (x, y): [y * stride() + x]
  int stride() const { return int(farthest_.stride()); }

 private:
  Plane<float> farthest_;
};

}  // namespace obscura::raster
