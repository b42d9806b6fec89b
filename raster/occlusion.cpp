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

void FarthestKeys(const TileBuffers& tile, Plane<float>& out) {
  const DF d;
  const int columns = (tile.width + kBlock - 1) >> kBlockBits, rows = (tile.height + kBlock - 1) >> kBlockBits;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const float* keys = tile.key + tile.at(x * kBlock, y * kBlock);
      VF least = hn::Load(d, keys);  // no key is NaN, so the order does not matter
      for (int i = int(hn::Lanes(d)); i < kBlock * kBlock; i += int(hn::Lanes(d))) least = hn::Min(least, hn::Load(d, keys + i));
      out.at((tile.x >> kBlockBits) + x, (tile.y >> kBlockBits) + y) = hn::GetLane(hn::MinOfLanes(d, least));
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
  farthest_.resize((width + kBlock - 1) >> kBlockBits, (height + kBlock - 1) >> kBlockBits);
  for (int y = 0; y < farthest_.height(); ++y)
    std::fill_n(farthest_.row(y), farthest_.width(), -std::numeric_limits<float>::infinity());
}

void OcclusionMap::update(const TileBuffers& tile, Target target) { OBSCURA_DISPATCH(FarthestKeys, target)(tile, farthest_); }

bool OcclusionMap::hides(const ScreenBound& b) const {
  for (int y = b.y0 >> kBlockBits; y <= b.y1 >> kBlockBits; ++y)
    for (int x = b.x0 >> kBlockBits; x <= b.x1 >> kBlockBits; ++x)
      if (!(farthest_.at(x, y) > b.nearestKey)) return false;
  return true;
}

}  // namespace obscura::raster
#endif
