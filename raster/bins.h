// The lists between setup and the tiles: which triangles each tile has to look at.
#pragma once

#include <cstdint>
#include <vector>

#include "obscura/raster/triangle.h"

namespace obscura::raster {

struct TileGrid {
  int width = 0, height = 0;  // of the image, pixels
  int tileBits = 6;           // a tile is 1 << tileBits pixels square
  int columns = 0, rows = 0;

  TileGrid() = default;
  TileGrid(int w, int h, int bits)
      : width(w), height(h), tileBits(bits), columns(((w - 1) >> bits) + 1), rows(((h - 1) >> bits) + 1) {}
  int count() const { return columns * rows; }
};

// What one worker found. Each worker fills its own; a tile reads them all. Capacity survives clear(), so that a
// renderer that is used again allocates nothing.
class Bins {
 public:
  void reset(const TileGrid& grid) {
    grid_ = grid;
    small_.resize(size_t(grid.count()));
    large_.resize(size_t(grid.count()));
    for (auto& list : small_) list.clear();
    for (auto& list : large_) list.clear();
    triangles_.clear();
  }

  void add(const SmallTriangle& t) {
    const int bits = grid_.tileBits - kBlockBits;
    const int c0 = t.x >> bits, c1 = (t.x + t.columns - 1) >> bits, r0 = t.y >> bits, r1 = (t.y + t.rows - 1) >> bits;
    for (int r = r0; r <= r1; ++r)
      for (int c = c0; c <= c1; ++c) small_[size_t(r) * size_t(grid_.columns) + size_t(c)].push_back(t);
  }

  void add(const LargeTriangle& t) {
    const int bits = grid_.tileBits;
    const uint32_t index = uint32_t(triangles_.size());
    triangles_.push_back(t);
    for (int r = t.y0 >> bits; r <= t.y1 >> bits; ++r)
      for (int c = t.x0 >> bits; c <= t.x1 >> bits; ++c)
        if (mayCover(t, c, r)) large_[size_t(r) * size_t(grid_.columns) + size_t(c)].push_back(index);
  }

  const std::vector<SmallTriangle>& small(int tile) const { return small_[size_t(tile)]; }
  const std::vector<uint32_t>& large(int tile) const { return large_[size_t(tile)]; }
  const LargeTriangle& triangle(uint32_t index) const { return triangles_[index]; }

 private:
  // False if an edge function is negative at all four corner centres of the tile, hence in all of it.
  bool mayCover(const LargeTriangle& t, int column, int row) const {
    const int64_t size = (int64_t(1) << grid_.tileBits) - 1, x = int64_t(column) << grid_.tileBits, y = int64_t(row) << grid_.tileBits;
    for (int i = 0; i < 3; ++i) {
      const int64_t a = int64_t(t.a[i]) * kSub, b = int64_t(t.b[i]) * kSub;
      if (t.e[i] + a * (a > 0 ? x + size : x) + b * (b > 0 ? y + size : y) < 0) return false;
    }
    return true;
  }

  TileGrid grid_;
  std::vector<std::vector<SmallTriangle>> small_;
  std::vector<std::vector<uint32_t>> large_;  // into triangles_
  std::vector<LargeTriangle> triangles_;
};

}  // namespace obscura::raster
