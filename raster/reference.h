// The scalar twins of the rasterizer's stages, put together.
#pragma once

#include "obscura/raster/gbuffer.h"
#include "obscura/raster/plane.h"
#include "obscura/raster/surface_ref.h"

namespace obscura::raster::ref {

struct Visibility {
  int width = 0, height = 0;
  Plane<float> key;          // depth key, -infinity where empty
  Plane<uint32_t> triangle;  // kNoTriangle where empty
};

Visibility visibility(const SurfaceContext& context);
// The layers behind it: all triangles once more for each that `out` has a plane for.
void layersBehind(const SurfaceContext& context, const Visibility& first, float separation, GBuffer& out);
void resolvePixel(const SurfaceContext& context, uint32_t id, float key, int x, int y, GBuffer& out);

}  // namespace obscura::raster::ref
