// The lists between setup and the tiles: which triangles each tile has to look at.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "obscura/raster/span.h"
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

// Grows like a vector, but what it appends is not initialised: records are written once, in their place.
class RecordList {
 public:
  SmallTriangle& append() {
    if (size_ == capacity_) grow();
    return data_.get()[size_++];
  }
  void clear() { size_ = 0; }
  Span<const SmallTriangle> view() const { return {data_.get(), size_}; }

 private:
  struct Free {
    void operator()(SmallTriangle* p) const { std::free(p); }
  };
  void grow() {
    const size_t capacity = capacity_ ? capacity_ * 2 : 32;
    std::unique_ptr<SmallTriangle, Free> data(
        static_cast<SmallTriangle*>(std::aligned_alloc(alignof(SmallTriangle), capacity * sizeof(SmallTriangle))));
    if (!data) throw std::bad_alloc();
    std::copy_n(data_.get(), size_, data.get());
    data_ = std::move(data);
    capacity_ = capacity;
  }
  std::unique_ptr<SmallTriangle, Free> data_;
  size_t size_ = 0, capacity_ = 0;
};

// What one worker found. Each worker fills its own; a tile reads them all. Capacity survives clear(), so that a
// renderer that is used again allocates nothing.
class Bins {
 public:
  void reset(const TileGrid& grid) {
    grid_ = grid;
    for (auto& lists : small_) {
      lists.resize(size_t(grid.count()));
      for (auto& list : lists) list.clear();
    }
    large_.resize(size_t(grid.count()));
    for (auto& list : large_) list.clear();
    triangles_.clear();
  }

  // Small triangles by the blocks that they touch: one, two side by side, two on top of each other, two by two, all in this
  // tile; then the others. Lists of their own, since the number of blocks, were it looked at triangle by triangle, is what a
  // processor cannot foretell.
  enum Kind { kOne, kTwoAcross, kTwoDown, kTwoByTwo, kAnySize, kKinds };
  Kind kindOf(int32_t block, int32_t blocks) const {
    const int last = (1 << (grid_.tileBits - kBlockBits)) - 1, columns = blocks & (SmallTriangle::kMaskedBit - 1), rows = blocks >> 16;
    const bool inTile = (lowerHalf(block) & last) + columns <= last && (upperHalf(block) & last) + rows <= last;
    return inTile && (columns | rows) <= 1 ? Kind(columns + 2 * rows) : kAnySize;
  }

  // A place for a small triangle, in a list of its first tile; to be filled, and then
  // handed to spread() if it is of any size.
  SmallTriangle& add(Kind kind, int32_t block) {
    const int bits = grid_.tileBits - kBlockBits;
    const size_t tile = size_t(upperHalf(block) >> bits) * size_t(grid_.columns) + size_t(lowerHalf(block) >> bits);
    return small_[kind][tile].append();
  }

  // Copies it to the other tiles that it touches, if any.
  void spread(const SmallTriangle& t) {
    const int bits = grid_.tileBits - kBlockBits, x = lowerHalf(t.block), y = upperHalf(t.block);
    const int c0 = x >> bits, c1 = (x + t.columns() - 1) >> bits, r0 = y >> bits, r1 = (y + t.rows() - 1) >> bits;
    if (c0 == c1 && r0 == r1) return;
    const SmallTriangle copy = t;
    for (int r = r0; r <= r1; ++r)
      for (int c = c0; c <= c1; ++c)
        if (r != r0 || c != c0) small_[kAnySize][size_t(r) * size_t(grid_.columns) + size_t(c)].append() = copy;
  }

  void add(const LargeTriangle& t) {
    const int bits = grid_.tileBits;
    const uint32_t index = uint32_t(triangles_.size());
    triangles_.push_back(t);
    for (int r = t.y0 >> bits; r <= t.y1 >> bits; ++r)
      for (int c = t.x0 >> bits; c <= t.x1 >> bits; ++c)
        if (mayCover(t, c, r)) large_[size_t(r) * size_t(grid_.columns) + size_t(c)].push_back(index);
  }

  Span<const SmallTriangle> small(Kind kind, int tile) const { return small_[kind][size_t(tile)].view(); }
  bool empty(int tile) const {
    const auto none = [&](const auto& lists) { return lists[size_t(tile)].view().empty(); };
    return large(tile).empty() && std::all_of(small_, small_ + kKinds, none);
  }
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
  std::vector<RecordList> small_[kKinds];
  std::vector<std::vector<uint32_t>> large_;  // into triangles_
  std::vector<LargeTriangle> triangles_;
};

}  // namespace obscura::raster
