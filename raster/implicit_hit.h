// Where a ray meets an implicit surface, and how the pixel takes it. Private to implicit.cpp.
#pragma once

#include "obscura/raster/implicit.h"

namespace obscura::raster {

struct ImplicitHit {
  double zView;
  glm::vec3 normal;  // unit, view space
};

inline float keyOf(const View& view, double zView) { return float(view.perspective ? 1 / zView : 0 - zView); }

template <class V>
void store3(const V& v, int x, int y, Plane<float> planes[3]) {
  for (int c = 0; c < 3 && !planes[0].empty(); ++c) planes[c].at(x, y) = v[c];
}

inline void storeId(uint32_t id, int x, int y, Plane<uint32_t>& plane) {
  if (!plane.empty()) plane.at(x, y) = id;
}

// Into the visibility of the tile, at pixel (column, row) of it, and into the planes, where it is nearer than what is there:
// on equal keys the triangles and the surfaces before have the smaller id.
inline void storeHit(const View& view, const ImplicitDraw& s, const TileBuffers& tile, int column, int row, const ImplicitHit& hit,
                     GBuffer& out) {
  if (column >= tile.width || row >= tile.height) return;
  const int at = tile.at(column, row), x = tile.x + column, y = tile.y + row;
  const float key = keyOf(view, hit.zView);
  if (!(key > tile.key[at])) return;
  tile.key[at] = key;
  if (!tile.id) return;
  tile.id[at] = s.id;
  const float zView = view.perspective ? 1 / key : 0 - key;
  if (!out.depth.empty()) out.depth.at(x, y) = zView;
  float px = (float(view.xCenterSub(x)) - view.xShiftSub) / view.xScaleSub, py = (float(view.yCenterSub(y)) - view.yShiftSub) / view.yScaleSub;
  if (view.perspective) px *= zView, py *= zView;
  store3(glm::vec3(px, py, 0 - zView), x, y, out.position);
  store3(hit.normal, x, y, out.normal);
  store3(hit.normal, x, y, out.facet);
  store3(s.albedo, x, y, out.albedo);
  store3(s.emissive, x, y, out.emissive);
  if (!out.metallic.empty()) out.metallic.at(x, y) = s.metallic;
  if (!out.roughness.empty()) out.roughness.at(x, y) = s.roughness;
  storeId(s.id, x, y, out.triangle);
  storeId(s.instance, x, y, out.instance);
  storeId(s.materialIndex, x, y, out.material);
  storeId(kNoTriangle, x, y, out.heightMap);
  for (Plane<float>& plane : out.relief)
    if (!plane.empty()) plane.at(x, y) = 0;
}

// Into a layer behind the first.
inline void storeKey(const View& view, const TileBuffers& tile, int at, double zView) {
  const float key = keyOf(view, zView);
  if (key > tile.key[at] && key <= tile.limit[at]) tile.key[at] = key;
}

}  // namespace obscura::raster
