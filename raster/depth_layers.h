// In:  the keys of a tile's first layer.
// Out: the limits of the layers behind it, and of each layer's keys the plane of depths.
#pragma once

#include "obscura/raster/plane.h"
#include "obscura/raster/target.h"
#include "obscura/raster/tile.h"
#include "obscura/raster/view.h"

namespace obscura::raster {

// The separation of GBuffer::depth2 is never less than this part of the depth: 16 times what the roundings from key to
// depth and back can add up to, so that a limit is always farther than the key that it comes from.
constexpr float kLeastSeparation = 1.0f / (1 << 20);

enum class LayerBehind { Second, Back };  // GBuffer::depth2, GBuffer::depthBack

// Fills out.limit, for rasterTile with Keep::KeyWithinLimit. `covered` false: the first layer of the tile is empty, and
// `first` only tells where it is. separation: of LayerBehind::Second, scene units.
void limitTile(const View& view, const TileBuffers& first, bool covered, LayerBehind layer, float separation,
               TileBuffers& out, Target target);

// zView of the tile's keys, infinity where there is none (`covered` false: nowhere).
void storeTileDepth(const View& view, const TileBuffers& tile, bool covered, Plane<float>& out, Target target);

}  // namespace obscura::raster
