// In:  planes of sub-pixels, s x s of them to a pixel.
// Out: planes of pixels: the mean of each pixel's sub-pixels, or the values of the nearest one.
#pragma once

#include "obscura/raster/plane.h"
#include "obscura/raster/target.h"

namespace obscura::post {

// Throughout: s is 2 or 4; `in` has s times the width and height of `out`, which is allocated; rows y0 ... y1 - 1 of
// `out` are written. Sub-pixels count row by row: k = row * s + column.

// Box filter, for what can be averaged: light, reflectance, O and W. The sum is a tree, halves to halves, within the
// rows of sub-pixels and then over them, so it is the same everywhere and s x s equal values give that value again,
// bit for bit. Values beyond FLT_MAX / s^2 may become infinite.
void meanOfSubpixels(const raster::Plane<float>& in, int s, int y0, int y1, raster::Plane<float>& out,
                     raster::Target target);
void meanOfSubpixelsRef(const raster::Plane<float>& in, int s, int y0, int y1, raster::Plane<float>& out);

// Which sub-pixel has the smallest depth, k = 0 ... s^2 - 1: the first of equals; 0 where all are empty (infinite).
void nearestSubpixel(const raster::Plane<float>& depth, int s, int y0, int y1, raster::Plane<uint32_t>& nearest,
                     raster::Target target);
void nearestSubpixelRef(const raster::Plane<float>& depth, int s, int y0, int y1, raster::Plane<uint32_t>& nearest);

// The sub-pixel `nearest` says, for what has no mean or belongs together: depth, normal, position, ids. Every bit kept.
void takeSubpixel(const raster::Plane<float>& in, const raster::Plane<uint32_t>& nearest, int s, int y0, int y1,
                  raster::Plane<float>& out, raster::Target target);
void takeSubpixel(const raster::Plane<uint32_t>& in, const raster::Plane<uint32_t>& nearest, int s, int y0, int y1,
                  raster::Plane<uint32_t>& out, raster::Target target);
void takeSubpixelRef(const raster::Plane<float>& in, const raster::Plane<uint32_t>& nearest, int s, int y0, int y1,
                     raster::Plane<float>& out);
void takeSubpixelRef(const raster::Plane<uint32_t>& in, const raster::Plane<uint32_t>& nearest, int s, int y0, int y1,
                     raster::Plane<uint32_t>& out);

}  // namespace obscura::post
