// In:  the visibility of a tile.
// Out: the planes of the G-buffer that were asked for, in the tile's pixels.
#pragma once

#include "obscura/raster/gbuffer.h"
#include "obscura/raster/surface.h"
#include "obscura/raster/target.h"
#include "obscura/raster/tile.h"

namespace obscura::raster {

// Attributes are evaluated once per visible pixel. `covered` false: the whole tile is empty and `tile` only tells where.
void resolveTile(const SurfaceContext& context, const TileBuffers& tile, bool covered, GBuffer& out, Target target);

}  // namespace obscura::raster
