#include "obscura/raster/occlusion.h"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "obscura/raster/occlusion.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "obscura/raster/transform-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::raster {
namespace HWY_NAMESPACE {

// The least of a block's keys so far and another block's. No key is NaN, so the order does not matter.
HWY_INLINE void least(const float* keys, float out[16]) {
  const DF d;
  for (int i = 0; i < kBlock * kBlock; i += int(hn::Lanes(d))) hn::Store(hn::Min(hn::Load(d, keys + i), hn::Load(d, out + i)), d, out + i);
}

void FarthestKeys(const TileBuffers& tile, Plane<float>& out) {
  constexpr int kBlocks = kRegion / kBlock;
  const int columns = (tile.width + kBlock - 1) >> kBlockBits, rows = (tile.height + kBlock - 1) >> kBlockBits;
  for (int y = 0; y < rows; y += kBlocks)
    for (int x = 0; x < columns; x += kBlocks) {
      HWY_ALIGN float keys[kBlock * kBlock];
      std::fill_n(keys, kBlock * kBlock, std::numeric_limits<float>::infinity());
      for (int j = y; j < std::min(y + kBlocks, rows); ++j)
        for (int i = x; i < std::min(x + kBlocks, columns); ++i) least(tile.key + tile.at(i * kBlock, j * kBlock), keys);
      out.at((tile.x >> kRegionBits) + x / kBlocks, (tile.y >> kRegionBits) + y / kBlocks) = *std::min_element(keys, keys + kBlock * kBlock);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "obscura/raster/dispatch.h"

namespace obscura::raster {

HWY_EXPORT(FarthestKeys);

void OcclusionMap::reset(int width, int height) {
  farthest_.resize((width + kRegion - 1) >> kRegionBits, (height + kRegion - 1) >> kRegionBits);
  for (int y = 0; y < farthest_.height(); ++y)
    std::fill_n(farthest_.row(y), farthest_.width(), -std::numeric_limits<float>::infinity());
}

void OcclusionMap::update(const TileBuffers& tile, Target target) { OBSCURA_DISPATCH(FarthestKeys, target)(tile, farthest_); }

bool OcclusionMap::hides(const ScreenBound& b) const {
  for (int y = b.y0 >> kRegionBits; y <= b.y1 >> kRegionBits; ++y)
    for (int x = b.x0 >> kRegionBits; x <= b.x1 >> kRegionBits; ++x)
      if (!(farthest_.at(x, y) > b.nearestKey)) return false;
  return true;
}

}  // namespace obscura::raster
#endif
