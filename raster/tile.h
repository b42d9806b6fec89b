// In:  the bins of one tile.
// Out: depth key and triangle id per pixel of the tile (the visibility buffer).
#pragma once

#include "obscura/raster/bins.h"
#include "obscura/raster/plane.h"
#include "obscura/raster/surface.h"
#include "obscura/raster/target.h"

namespace obscura::raster {

constexpr int kMinTileBits = 4, kMaxTileBits = 6;  // 16, 32 or 64 pixels
// Edge functions in a tile fit in 32 bits: |A|, |B| <= 2 kGuardSub, and the first value is clamped to +-kEdgeLimit. That
// keeps its sign in all of the tile, and the steps across the tile stay below 2^31.
constexpr int64_t kEdgeLimit = int64_t(1) << 30;
static_assert(2ll * ((1 << kMaxTileBits) - 1) * 2 * kGuardSub <= kEdgeLimit);
static_assert(kEdgeLimit + 2ll * ((1 << kMaxTileBits) - 1) * 2 * kGuardSub < (int64_t(1) << 31));

// The pixels of one tile: row after row of blocks, each of kBlock x kBlock pixels, row by row. Whole vectors, aligned and
// always the same ones, are loaded and stored, so that a load can take what the store before it has just written.
struct TileBuffers {
  float* key = nullptr;                     // -infinity where nothing was drawn
  uint32_t* id = nullptr;                   // kNoTriangle where nothing was drawn
  int x = 0, y = 0, width = 0, height = 0;  // of the tile, inside the image
  int columns = 0;                          // blocks in a row

  // Element of a pixel of the tile.
  int at(int column, int row) const {
    return (((row >> kBlockBits) * columns + (column >> kBlockBits)) << (2 * kBlockBits)) + ((row & (kBlock - 1)) << kBlockBits) +
           (column & (kBlock - 1));
  }
};

// Memory for the keys and ids of any number of tiles; grows, and never shrinks.
class TileMemory {
 public:
  void reserve(size_t tiles, int tileBits);  // throws std::bad_alloc
  float* key(size_t tile) { return keys_.row(0) + (tile << (2 * tileBits_)); }
  uint32_t* id(size_t tile) { return ids_.row(0) + (tile << (2 * tileBits_)); }

 private:
  Plane<float> keys_;
  Plane<uint32_t> ids_;
  int tileBits_ = 0;
};

// Where a tile lies in the image.
TileBuffers placeTile(const TileGrid& grid, int tile, float* key, uint32_t* id);

// Nothing is drawn yet.
void clearTile(TileBuffers& tile);

// The winner of a pixel is the triangle with the larger key, on equal keys the one with the smaller id, so the order
// in which triangles and bins come, at once or in several calls, does not matter.
void rasterTile(const SurfaceContext& context, int tile, Span<const Bins> bins, TileBuffers& out, Target target);

}  // namespace obscura::raster
