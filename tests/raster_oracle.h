// What the rasterizer must draw, in exact arithmetic and by another method than its own.
//
// A row of pixel centres meets a polygon in intervals between rational crossings. The top-left rule says no more than
// "half open in y, then half open in x": an edge crosses the row at y if upper.y <= y < lower.y, and the centre at x is
// inside the interval [from, to) if from <= x < to. No edge functions, no bias, no winding, no rounding.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "obscura/raster/view.h"

// A million triangles take a few seconds in an optimised build; elsewhere a sample has to do.
#if defined(__has_feature)
#define OBSCURA_HAS_FEATURE(x) __has_feature(x)
#else
#define OBSCURA_HAS_FEATURE(x) 0
#endif
#if defined(__OPTIMIZE__) && !defined(__SANITIZE_ADDRESS__) && !OBSCURA_HAS_FEATURE(address_sanitizer)
#define OBSCURA_FAST_BUILD 1
#else
#define OBSCURA_FAST_BUILD 0
#endif

namespace obscura::tests {

constexpr bool kFastBuild = OBSCURA_FAST_BUILD;
__extension__ typedef __int128 Int128;

// 1/256 pixel from the centre of the image, y downwards; |x|, |y| <= 2^30.
struct SubPoint {
  int64_t x = 0, y = 0;
};

struct OracleTriangle {
  SubPoint at[3];
  float key[3] = {0, 0, 0};
};

// The centres of an image's pixels.
struct OracleImage {
  int width = 0, height = 0;
  int64_t xCenter(int x) const {
    return int64_t(x) * raster::kSub + raster::kSub / 2 - int64_t(width) * raster::kSub / 2;
  }
  int64_t yCenter(int y) const {
    return int64_t(y) * raster::kSub + raster::kSub / 2 - int64_t(height) * raster::kSub / 2;
  }
};

struct Columns {
  int begin = 0, end = 0;  // half open; empty where begin == end
};

// The pixels of a row, 0 <= row < height, that the triangle covers. Either winding; without area it covers nothing.
Columns coveredColumns(const OracleTriangle& t, const OracleImage& image, int row);

// The same question about any closed polygon: the centre is inside if an odd number of crossings lie at or left of it.
bool insidePolygon(const std::vector<SubPoint>& polygon, SubPoint center);

// An edge, as a segment, is nearer to `center` than `distance` sub-pixels. In double: for margins only.
bool nearAnEdge(const OracleTriangle& t, SubPoint center, double distance);

// Keys are integers, 1 <= |key| < 2^24, and coordinates within the guard band, so that everything is an integer below
// 2^127. `found` is what was computed for the key at `center`, |found| >= 1.
struct KeyError {
  double error = 0;  // |found - the exact value of the plane through the three keys|
  double terms = 0;  // |key0| + |x gradient| |dx| + |y gradient| |dy|: what rounding is relative to
};
KeyError keyError(const OracleTriangle& t, SubPoint center, float found);

// What is drawn of a triangle by definition: itself, snapped, or the fan of the polygon that clipping leaves of it.
// Facing is left to the caller. The vertices come from the engine's own clipping and snapping.
std::vector<OracleTriangle> snappedPieces(const raster::View& view, const raster::Draw& draw, uint32_t triangle);

// "(-12, 40) key -7, ..." in sub-pixels.
std::string textOf(const OracleTriangle& t);

}  // namespace obscura::tests
