// In:  the bins of one tile.
// Out: depth key and triangle id per pixel of the tile (the visibility buffer), or the key alone.
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
  uint32_t* id = nullptr;                   // kNoTriangle where nothing was drawn; of Keep::Visibility
  float* limit = nullptr;                   // of Keep::KeyWithinLimit, see depth_layers.h
  int x = 0, y = 0, width = 0, height = 0;  // of the tile, inside the image
  int columns = 0;                          // blocks in a row

  // Of the rows of blocks that reach into the image.
  size_t pixels() const { return size_t(columns * ((height + kBlock - 1) >> kBlockBits)) << (2 * kBlockBits); }
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
  float* key(size_t place) { return keys_.row(0) + (place << (2 * tileBits_)); }
  uint32_t* id(size_t place) { return ids_.row(0) + (place << (2 * tileBits_)); }

 private:
  Plane<float> keys_;
  Plane<uint32_t> ids_;
  int tileBits_ = 0;
};

// A tile of the image, kept at a place of the memory.
TileBuffers placeTile(const TileGrid& grid, int tile, TileMemory& memory, size_t place);

// What is kept of a pixel's winner: key and id (the visibility buffer); the key alone, for frames of nothing but depth;
// or the key alone, and only up to TileBuffers::limit, for the layers behind the first. Alpha is tested in all three.
enum class Keep { Visibility, Key, KeyWithinLimit };

// Nothing is drawn yet.
void clearTile(Keep keep, TileBuffers& tile, Target target);

// The winner of a pixel is the triangle with the larger key, on equal keys the one with the smaller id, so the order
// in which triangles and bins come, at once or in several calls, does not matter.
void rasterTile(const SurfaceContext& context, int tile, Span<const Bins> bins, Keep keep, TileBuffers& out, Target target);

}  // namespace obscura::raster
